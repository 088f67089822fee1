#pragma once
// Geometric multigrid V-cycle in single precision for the operator on open fractions.
//
// Cells are merged in pairs along the axes of small spacing until a direct solver takes over; restriction
// sums, prolongation copies, and the coarse operator is discretised anew on the coarse distances: half the
// sum of the merged coefficients on regular cells [Braess1995].
#include <type_traits>
#include <vector>

#include "flow/coarse_solver.hpp"
#include "flow/smoothers.hpp"

namespace peclet::flow {

/// reactive: with a reaction term, see ReactiveOperator.
template <bool reactive>
class BasicMultigrid {
  template <class Coefficient>
  using Operator = std::conditional_t<reactive, ReactiveOperator<Coefficient>, LevelOperator<Coefficient>>;

 public:
  BasicMultigrid() = default;
  BasicMultigrid(const Int3& cells, const Real3& spacing, const PressureSides& sides);

  /// Cells outside rows are solid for good. Shares the fractions and derives all levels from them. The same
  /// with the reaction, if any, in units in which an open face along the smallest spacing has coefficient 1.
  void set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows,
                          const Field<float>& reaction = {});
  /// The part of the reaction that is in proportion to the volume, for a finest cell.
  void set_volume_reaction(Real value) { levels_[0].reaction.finest_volume = value; }
  /// Derives the coarse faces anew that depend on the faces of cells in the boxes.
  void update(const std::vector<Box>& changed);

  /// Right-hand side and result of the V-cycle; zero in cells without an open face.
  const Field<float>& residual() const { return levels_[0].fields.rhs; }
  const Field<float>& correction() const { return levels_[0].fields.solution; }
  /// correction = V-cycle applied to residual, symmetric and positive; returns correction . residual.
  Real apply() const;

  /// The operator of the levels times this is the one in physical units: 1 over the smallest spacing squared.
  Real stiffness() const { return stiffness_; }
  const Operator<OpenFraction>& finest_operator() const { return finest_; }
  const RowRanges& rows() const { return levels_[0].rows; }
  const SweepPlan& plan() const { return levels_[0].plan; }
  int number_of_levels() const { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const;

 private:
  struct Level {
    LevelShape shape;
    LevelFields fields;
    FaceVector<float> coefficients;  ///< not on the finest level
    Operator<float> op;              ///< not on the finest level
    LevelReaction reaction;          ///< where there is one
    RowRanges rows;
    SweepPlan plan;
    Transfer transfer;  ///< to the next coarser level
  };

  void set_coarse_operator() const;

  Real3 weights_{1, 1, 1};
  Real stiffness_ = 1;
  Operator<OpenFraction> finest_;
  FaceVector<OpenFraction> open_;
  std::vector<Level> levels_;
  BoxList changed_;  // of one level
  CoarseSolver coarse_solver_;
};

using Multigrid = BasicMultigrid<false>;

}  // namespace peclet::flow
