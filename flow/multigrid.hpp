#pragma once
// Geometric multigrid V-cycle in single precision for the operator on open fractions.
//
// Cells are merged in pairs along the axes of small spacing until a direct solver takes over; restriction
// sums, prolongation copies, and the coarse operator is discretised anew on the coarse distances: half the
// sum of the merged coefficients on regular cells [Braess1995]. Each group of fluid regions that walls part
// has coarse levels of its own.
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
  /// finest_fields: unknowns of the finest level, of another hierarchy that is used in turn; else own ones.
  BasicMultigrid(const Int3& cells, const Real3& spacing, const PressureSides& sides,
                 const LevelFields& finest_fields = {});

  /// Cells outside rows are solid for good. Shares the fractions, to be followed by update() of all cells.
  /// The same with the reaction, if any, in units in which an open face along the smallest spacing has
  /// coefficient 1.
  void share_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows,
                            const Field<float>& reaction = {});
  /// The same, and derives all levels from them.
  void set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows);
  /// Parts the cells below the finest level by groups of fluid regions: group is the number of the group of
  /// each finest cell, boxes lie around the groups. Shares the field and derives all levels.
  void set_groups(const std::vector<Box>& boxes, const Field<unsigned char>& group);
  /// All cells are of one group again.
  void join_groups();
  /// Of the reaction of a finest cell, what it holds at most that is no exchange with walls, and whether that
  /// exchange is the one of the next coarser cells, for those who smooth the finest level themselves.
  void set_mass(float mass, bool from_coarse_centres) {
    mass_ = mass;
    from_coarse_centres_ = from_coarse_centres;
  }
  int number_of_groups() const { return static_cast<int>(groups_.size()); }
  /// Derives the coarse faces anew that depend on the faces of cells in the boxes, and the reaction.
  void update(const std::vector<Box>& changed);
  /// Derives the coarse reaction anew, where the faces are as before.
  void update_reaction();

  /// Right-hand side and result of the V-cycle; zero in cells without an open face.
  const Field<float>& residual() const { return finest_level().fields.rhs; }
  const Field<float>& correction() const { return finest_level().fields.solution; }
  /// For those who smooth the finest of several levels themselves, with one group: its fields, and
  /// coarse_correction = two V-cycles of the levels below, applied to coarse_residual.
  const LevelFields& finest_fields() const { return finest_level().fields; }
  const Transfer& finest_transfer() const { return finest_level().transfer; }
  const Field<float>& coarse_residual() const { return groups_[0].levels[1].fields.rhs; }
  const Field<float>& coarse_correction() const { return groups_[0].levels[1].fields.solution; }
  void apply_below() const;
  /// correction = V-cycle applied to residual, symmetric and positive; returns correction . residual.
  Real apply() const;

  /// The operator of the levels times this is the one in physical units: 1 over the smallest spacing squared.
  Real stiffness() const { return stiffness_; }
  const Operator<OpenFraction>& finest_operator() const { return finest_; }
  const RowRanges& rows() const { return finest_level().rows; }
  const SweepPlan& plan() const { return finest_level().plan; }
  const LevelShape& finest_shape() const { return finest_level().shape; }
  int number_of_levels() const { return static_cast<int>(groups_[0].levels.size()); }
  std::size_t bytes() const;

 private:
  struct Level {
    LevelShape shape;
    LevelFields fields;
    FaceVector<float> coefficients;  ///< not on the finest level
    Operator<float> op;              ///< not on the finest level
    Field<float> reaction;           ///< where there is one
    Field<float> mass;               ///< its part that is no exchange with walls; not on the finest level
    RowRanges rows;
    SweepPlan plan;
    Transfer transfer;  ///< to the next coarser level
  };

  /// The levels of one group. The finest one is shared by all groups.
  struct Group {
    std::vector<Level> levels;
    CoarseSolver coarse_solver;
    RowRanges rows;  ///< finest cells
  };

  const Level& finest_level() const { return groups_[0].levels[0]; }
  Level& finest_level() { return groups_[0].levels[0]; }
  static Level make_level(const LevelShape& shape, int number, const LevelFields& finest_fields = {});
  void add_group();
  static void set_rows(Group& group, const RowRanges& rows);
  void derive_coefficients_of(int group, const std::vector<Box>& pieces);
  void set_coarse_operator(const Group& group) const;
  /// V-cycle from the level below the finest, which begins with zero or with the solution there.
  void apply_below(const Group& group, bool from_zero = true) const;
  Real apply_by_groups() const;

  Real3 weights_{1, 1, 1};
  Real stiffness_ = 1;
  float mass_ = 0;
  bool from_coarse_centres_ = false;
  Operator<OpenFraction> finest_;
  FaceVector<OpenFraction> open_;
  Array<unsigned char> open_vectors_;  // on the host, without a reaction
  std::vector<Group> groups_;
  Field<unsigned char> group_;  // of each finest cell
  BoxList changed_;             // of one level
};

using Multigrid = BasicMultigrid<false>;

}  // namespace peclet::flow
