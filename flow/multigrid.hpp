#pragma once
// Geometric multigrid V-cycle in single precision for the operator on open fractions.
//
// Cells are merged in pairs along the axes of small spacing until a direct solver takes over; restriction
// sums, prolongation copies, and the coarse operator is discretised anew on the coarse distances: half the
// sum of the merged coefficients on regular cells [Braess1995].
#include <vector>

#include "flow/coarse_solver.hpp"
#include "flow/smoothers.hpp"

namespace peclet::flow {

class Multigrid {
 public:
  Multigrid() = default;
  Multigrid(const Int3& cells, const Real3& spacing, const PressureSides& sides);

  /// Cells outside rows are solid for good. Shares the fractions and derives all levels from them.
  void set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows);
  /// Derives the coarse faces anew that depend on the faces of cells in the boxes.
  void update(const std::vector<Box>& changed) const;

  /// Right-hand side and result of the V-cycle; zero in cells without an open face.
  const Field<float>& residual() const { return levels_[0].fields.rhs; }
  const Field<float>& correction() const { return levels_[0].fields.solution; }
  /// correction = V-cycle applied to residual, symmetric and positive; returns correction . residual.
  Real apply() const;

  /// The operator of the levels times this is the one in physical units: 1 over the smallest spacing squared.
  Real stiffness() const { return stiffness_; }
  const LevelOperator<OpenFraction>& finest_operator() const { return finest_; }
  const RowRanges& rows() const { return levels_[0].rows; }
  const SweepPlan& plan() const { return levels_[0].plan; }
  int number_of_levels() const { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const;

 private:
  struct Level {
    LevelShape shape;
    LevelFields fields;
    FaceVector<float> coefficients;  ///< not on the finest level
    LevelOperator<float> op;         ///< not on the finest level
    RowRanges rows;
    SweepPlan plan;
    Transfer transfer;  ///< to the next coarser level
  };

  Real3 weights_{1, 1, 1};
  Real stiffness_ = 1;
  LevelOperator<OpenFraction> finest_;
  FaceVector<OpenFraction> open_;
  std::vector<Level> levels_;
  CoarseSolver coarse_solver_;
};

}  // namespace peclet::flow
