#include "flow/multigrid.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "flow/group_transfer.hpp"

namespace peclet::flow {
namespace {

/// Cells are merged along the axes whose spacing is close to the smallest. Of an odd number of cells the
/// wider one of the two at the ends stays alone, so that neither becomes much smaller than the others.
Merging next_merging(const LevelShape& shape, const Real3& spacing) {
  constexpr Real close = 1.42;  // square root of 2: keeps the ratio of the spacings below 2
  Real smallest = std::numeric_limits<Real>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (shape.cells[axis] > 1) smallest = std::min(smallest, spacing[axis] * shape.factor[axis]);
  Merging merging;
  for (int axis = 0; axis < 3; ++axis) {
    const int n = shape.cells[axis];
    if (n == 1 || spacing[axis] * shape.factor[axis] > close * smallest) continue;
    merging.ratio[axis] = 2;
    merging.shift[axis] = n % 2 == 1 && shape.width(axis, 0) > shape.width(axis, n - 1);
  }
  return merging;
}

/// Range of cells along one axis.
struct Range {
  int low, high;
};

/// The cells whose faces may have changed, and one more where a periodic side repeats a face: in one piece,
/// or in two that are parted by a periodic side.
std::vector<Range> changed_cells(const LevelShape& finest, const Box& box, int axis) {
  const int n = finest.cells[axis];
  int low = box.low[axis] - 1, high = box.high[axis] + 1;
  if (!finest.sides.is_periodic(axis)) return {{std::max(low, 0), std::min(high, n)}};
  if (high - low >= n) return {{0, n}};
  const int shift = low >= 0 ? -(low / n) * n : (n - 1 - low) / n * n;
  low += shift;
  high += shift;
  if (high <= n) return {{low, high}};
  return {{low, n}, {0, high - n}};
}

/// The changed finest cells as boxes inside the grid.
std::vector<Box> pieces_inside(const LevelShape& finest, const std::vector<Box>& changed) {
  std::vector<Box> pieces;
  for (const Box& box : changed)
    for (const Range& x : changed_cells(finest, box, 0))
      for (const Range& y : changed_cells(finest, box, 1))
        for (const Range& z : changed_cells(finest, box, 2))
          if (x.low < x.high && y.low < y.high && z.low < z.high)
            pieces.push_back({{x.low, y.low, z.low}, {x.high, y.high, z.high}});
  return pieces;
}

/// Cells of a coarser level that cover finest cells.
Box covering_cells(const LevelShape& coarse, const Box& cells) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = (cells.low[axis] + coarse.offset[axis]) / coarse.factor[axis];
    box.high[axis] = (cells.high[axis] - 1 + coarse.offset[axis]) / coarse.factor[axis] + 1;
  }
  return box;
}

RowRanges prolongation_rows(const RowRanges& rows, const Merging& merging) {
  RowRanges result = rows;
  if (merging.ratio[0] == 1) return result;
  result.box.low[0] = merging.parent(0, rows.box.low[0]);
  result.box.high[0] = merging.end_of_parents(0, rows.box.high[0]);
  if (!rows.first.data()) return result;
  const Index count = rows.number_of_rows();
  const Array<int> first("row_begin", count), last("row_end", count);
  for_each(
      "flow::rows", count, KOKKOS_LAMBDA(Index row) {
        first(row) = merging.parent(0, rows.first(row));
        last(row) = merging.end_of_parents(0, rows.last(row));
      });
  result.first = first;
  result.last = last;
  return result;
}

SweepPlan plan_of(const LevelShape& shape, const RowRanges& rows, const Transfer& transfer) {
  const PressureSides& sides = shape.sides;
  return SweepPlan(shape.cells, rows.box, {sides.is_periodic(0), sides.is_periodic(1), sides.is_periodic(2)},
                   transfer.merging.shift);
}

void clear(const LevelFields& fields) {
  fields.rhs.fill(0);
  fields.solution.fill(0);
  fields.scratch.fill(0);
}

bool same_box(const Box& a, const Box& b) { return a.low == b.low && a.high == b.high; }

template <class T>
std::size_t bytes_of(const Field<T>& field) {
  return field.array().span() * sizeof(T);
}

std::size_t bytes_of(const RowRanges& rows) { return (rows.first.span() + rows.last.span()) * sizeof(int); }

}  // namespace

template <bool reactive>
BasicMultigrid<reactive>::BasicMultigrid(const Int3& cells, const Real3& spacing, const PressureSides& sides,
                                         const LevelFields& finest_fields)
    : groups_(1) {
  Real smallest = std::numeric_limits<Real>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (cells[axis] > 1) smallest = std::min(smallest, spacing[axis]);
  if (!(smallest < std::numeric_limits<Real>::infinity())) smallest = spacing[0];
  for (int axis = 0; axis < 3; ++axis)
    weights_[axis] = open_fraction_unit * (smallest / spacing[axis]) * (smallest / spacing[axis]);

  stiffness_ = 1 / (smallest * smallest);

  std::vector<Level>& levels = groups_[0].levels;
  LevelShape shape(cells, sides);
  for (;;) {
    levels.push_back(make_level(shape, static_cast<int>(levels.size()), finest_fields));
    if (shape.number_of_cells() <= (reactive ? 32 : CoarseSolver::largest_size)) break;
    levels.back().transfer.merging = next_merging(shape, spacing);
    shape = LevelShape(shape, levels.back().transfer.merging);
  }
  groups_[0].coarse_solver = CoarseSolver(shape);
}

template <bool reactive>
typename BasicMultigrid<reactive>::Level BasicMultigrid<reactive>::make_level(
    const LevelShape& shape, int number, const LevelFields& finest_fields) {
  Level level;
  level.shape = shape;
  if (number == 0 && finest_fields.rhs.is_allocated()) {
    level.fields = finest_fields;
    return level;
  }
  const std::string name = "multigrid_" + std::to_string(number);
  level.fields.rhs = Field<float>(name + ".rhs", shape.layout);
  level.fields.solution = Field<float>(name + ".solution", shape.layout);
  level.fields.scratch = Field<float>(name + ".scratch", shape.layout);
  if (number == 0) return level;
  level.coefficients = FaceVector<float>(name + ".coefficients", shape.layout);
  if constexpr (reactive) {
    level.reaction = Field<float>(name + ".reaction", shape.layout);
    level.mass = Field<float>(name + ".mass", shape.layout);
    level.op = ReactiveOperator<float>(shape, level.coefficients, Real3{1, 1, 1}, level.reaction);
  } else {
    level.op = LevelOperator<float>(shape, level.coefficients, Real3{1, 1, 1});
  }
  return level;
}

template <bool reactive>
void BasicMultigrid<reactive>::share_open_fractions(const FaceVector<OpenFraction>& open,
                                                    const RowRanges& rows, const Field<float>& reaction) {
  groups_.resize(1);
  std::vector<Level>& levels = groups_[0].levels;
  open_ = open;
  levels[0].reaction = reaction;
  if constexpr (reactive)
    finest_ = ReactiveOperator<OpenFraction>(levels[0].shape, open, weights_, reaction);
  else
    finest_ = LevelOperator<OpenFraction>(levels[0].shape, open, weights_);
  if constexpr (runs_on_host && !reactive) {
    if (!open_vectors_.data())
      open_vectors_ = Array<unsigned char>("open_vectors", levels[0].shape.layout.size / Layout::alignment);
    finest_.open_vectors = open_vectors_.data();
  }
  levels[0].rows = aligned_rows(rows, levels[0].shape);
  levels[0].plan = plan_of(levels[0].shape, levels[0].rows, levels[0].transfer);
  clear(levels[0].fields);
  set_rows(groups_[0], levels[0].rows);
}

template <bool reactive>
void BasicMultigrid<reactive>::set_open_fractions(const FaceVector<OpenFraction>& open,
                                                  const RowRanges& rows) {
  share_open_fractions(open, rows);
  update({Box{{0, 0, 0}, finest_level().shape.cells}});
}

template <bool reactive>
void BasicMultigrid<reactive>::set_rows(Group& group, const RowRanges& rows) {
  group.rows = rows;
  for (std::size_t l = 1; l < group.levels.size(); ++l) {
    Level& level = group.levels[l];
    Transfer& transfer = group.levels[l - 1].transfer;
    const RowRanges& finer = l == 1 ? rows : group.levels[l - 1].rows;
    level.rows = coarse_rows(finer, level.shape, transfer.merging);
    level.plan = plan_of(level.shape, level.rows, level.transfer);
    clear(level.fields);
    for (int axis = 0; axis < 3; ++axis) level.coefficients[axis].fill(0);
    transfer.coarse_shape = level.shape;
    transfer.coarse_rows = level.rows;
    transfer.prolongation_rows = prolongation_rows(finer, transfer.merging);
  }
}

template <bool reactive>
void BasicMultigrid<reactive>::set_groups(const std::vector<Box>& boxes, const Field<unsigned char>& group) {
  if (number_of_levels() == 1) return;
  group_ = group;
  while (groups_.size() < boxes.size()) add_group();
  groups_.resize(boxes.size());
  for (std::size_t g = 0; g < boxes.size(); ++g)
    if (!same_box(groups_[g].rows.box, boxes[g])) set_rows(groups_[g], RowRanges(boxes[g]));
  update({Box{{0, 0, 0}, finest_level().shape.cells}});
}

template <bool reactive>
void BasicMultigrid<reactive>::join_groups() {
  if (number_of_groups() == 1) return;
  groups_.resize(1);
  set_rows(groups_[0], finest_level().rows);
  update({Box{{0, 0, 0}, finest_level().shape.cells}});
}

template <bool reactive>
void BasicMultigrid<reactive>::add_group() {
  Group group;
  for (const Level& level : groups_[0].levels) {
    const int number = static_cast<int>(group.levels.size());
    group.levels.push_back(number == 0 ? level : make_level(level.shape, number));
    group.levels.back().transfer.merging = level.transfer.merging;
  }
  group.coarse_solver = CoarseSolver(group.levels.back().shape);
  groups_.push_back(group);
}

template <bool reactive>
void BasicMultigrid<reactive>::update(const std::vector<Box>& changed) {
  const std::vector<Box> pieces = pieces_inside(finest_level().shape, changed);
  if (finest_.open_vectors) {
    std::vector<Box> vectors = pieces;
    for (Box& box : vectors) {
      box.low[0] = box.low[0] / Layout::alignment;
      box.high[0] = (box.high[0] - 1) / Layout::alignment + 1;
    }
    changed_.assign(vectors);
    mark_open_vectors(finest_, changed_, open_vectors_);
  }
  for (int g = 0; g < number_of_groups(); ++g) {
    derive_coefficients_of(g, number_of_groups() == 1 ? pieces : std::vector<Box>{groups_[g].rows.box});
    if constexpr (!reactive) set_coarse_operator(groups_[g]);
  }
  if constexpr (reactive) update_reaction();
}

template <bool reactive>
void BasicMultigrid<reactive>::update_reaction() {
  const std::vector<Level>& levels = groups_[0].levels;
  if constexpr (reactive)
    for (std::size_t l = 1; l < levels.size(); ++l) {
      const Level& finer = levels[l - 1];
      const std::vector<Box> all{{{0, 0, 0}, levels[l].shape.cells}};
      changed_.assign(all);
      derive_reaction({finer.shape, finer.reaction, finer.mass, mass_, l == 1 && from_coarse_centres_},
                      finer.transfer.merging, changed_, levels[l].reaction, levels[l].mass);
    }
  set_coarse_operator(groups_[0]);
}

template <bool reactive>
void BasicMultigrid<reactive>::derive_coefficients_of(int group, const std::vector<Box>& pieces) {
  const std::vector<Level>& levels = groups_[group].levels;
  for (std::size_t l = 1; l < levels.size(); ++l) {
    const LevelShape& shape = levels[l].shape;
    const Merging& merging = levels[l - 1].transfer.merging;
    const FaceVector<float>& coefficients = levels[l].coefficients;
    std::vector<Box> boxes;
    for (const Box& piece : pieces) boxes.push_back(covering_cells(shape, piece));
    changed_.assign(boxes);
    if (l > 1)
      derive_coefficients<LevelOperator<float>>(levels[l - 1].op, shape, merging, changed_, coefficients);
    else if (number_of_groups() > 1)
      derive_coefficients(GroupOperator{finest_, group_.data(), static_cast<unsigned char>(group)}, shape,
                          merging, changed_, coefficients);
    else
      derive_coefficients<LevelOperator<OpenFraction>>(finest_, shape, merging, changed_, coefficients);
  }
}

template <bool reactive>
void BasicMultigrid<reactive>::set_coarse_operator(const Group& group) const {
  const float* reaction = nullptr;
  if constexpr (reactive) reaction = group.levels.back().reaction.data();
  if (group.levels.size() == 1)
    group.coarse_solver.template set_operator<OpenFraction>(finest_, reaction);
  else
    group.coarse_solver.template set_operator<float>(group.levels.back().op, reaction);
}

template <bool reactive>
void BasicMultigrid<reactive>::apply_below(const Group& group, bool from_zero) const {
  const std::vector<Level>& levels = group.levels;
  const std::size_t last = levels.size() - 1;
  for (std::size_t l = 1; l < last; ++l) {
    const Level& level = levels[l];
    smooth_and_restrict(level.op, level.plan, level.rows, level.transfer, level.fields,
                        levels[l + 1].fields.rhs, from_zero || l > 1);
  }
  group.coarse_solver.solve(levels[last].fields.rhs, levels[last].fields.solution);
  for (std::size_t l = last; l-- > 1;) {
    const Level& level = levels[l];
    prolong_and_smooth(level.op, level.plan, level.rows, level.transfer, level.fields,
                       levels[l + 1].fields.solution);
  }
}

template <bool reactive>
void BasicMultigrid<reactive>::apply_below() const {
  apply_below(groups_[0]);
  if (number_of_levels() > 2) apply_below(groups_[0], false);
}

template <bool reactive>
Real BasicMultigrid<reactive>::apply() const {
  const Level& finest = finest_level();
  if (number_of_levels() == 1) {
    apply_below(groups_[0]);
    return dot(finest.fields.solution, finest.fields.rhs, finest.rows, finest.plan);
  }
  if constexpr (!reactive)
    if (number_of_groups() > 1) return apply_by_groups();
  const LevelFields& below = groups_[0].levels[1].fields;
  smooth_and_restrict(finest_, finest.plan, finest.rows, finest.transfer, finest.fields, below.rhs);
  apply_below(groups_[0]);
  return prolong_and_smooth(finest_, finest.plan, finest.rows, finest.transfer, finest.fields,
                            below.solution);
}

/// The same with several groups.
template <bool reactive>
Real BasicMultigrid<reactive>::apply_by_groups() const {
  const Level& finest = finest_level();
  const Merging& merging = finest.transfer.merging;
  smooth_from_zero<LevelOperator<OpenFraction>>(finest_, finest.plan, finest.rows, finest.fields);
  for (int g = 0; g < number_of_groups(); ++g) {
    const Level& below = groups_[g].levels[1];
    restrict_group(group_, g, merging, finest.fields.scratch, below.rows, below.fields.rhs);
    apply_below(groups_[g]);
    prolong_group(group_, g, merging, below.fields.solution, groups_[g].rows, finest.fields.solution);
  }
  return smooth<LevelOperator<OpenFraction>>(finest_, finest.plan, finest.rows, finest.fields);
}

template <bool reactive>
std::size_t BasicMultigrid<reactive>::bytes() const {
  std::size_t total = open_vectors_.span();
  for (int g = 0; g < number_of_groups(); ++g) {
    total += groups_[g].coarse_solver.bytes();
    for (std::size_t l = g == 0 ? 0 : 1; l < groups_[g].levels.size(); ++l) {
      const Level& level = groups_[g].levels[l];
      total += bytes_of(level.fields.rhs) + bytes_of(level.fields.solution) + bytes_of(level.fields.scratch);
      for (int axis = 0; axis < 3; ++axis)
        if (level.coefficients[axis].is_allocated()) total += bytes_of(level.coefficients[axis]);
      if (l > 0 && level.reaction.is_allocated()) total += bytes_of(level.reaction) + bytes_of(level.mass);
      total += bytes_of(level.rows) + bytes_of(level.transfer.prolongation_rows);
    }
  }
  return total;
}

template class BasicMultigrid<false>;
template class BasicMultigrid<true>;

}  // namespace peclet::flow
