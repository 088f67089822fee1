#include "flow/multigrid.hpp"

#include <algorithm>
#include <limits>
#include <string>

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

template <class T>
std::size_t bytes_of(const Field<T>& field) {
  return field.array().span() * sizeof(T);
}

std::size_t bytes_of(const RowRanges& rows) { return (rows.first.span() + rows.last.span()) * sizeof(int); }

}  // namespace

template <bool reactive>
BasicMultigrid<reactive>::BasicMultigrid(const Int3& cells, const Real3& spacing,
                                         const PressureSides& sides) {
  Real smallest = std::numeric_limits<Real>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    if (cells[axis] > 1) smallest = std::min(smallest, spacing[axis]);
  if (!(smallest < std::numeric_limits<Real>::infinity())) smallest = spacing[0];
  for (int axis = 0; axis < 3; ++axis)
    weights_[axis] = open_fraction_unit * (smallest / spacing[axis]) * (smallest / spacing[axis]);

  stiffness_ = 1 / (smallest * smallest);

  LevelShape shape(cells, sides);
  for (;;) {
    Level level;
    level.shape = shape;
    const std::string name = "multigrid_" + std::to_string(levels_.size());
    level.fields.rhs = Field<float>(name + ".rhs", level.shape.layout);
    level.fields.solution = Field<float>(name + ".solution", level.shape.layout);
    level.fields.scratch = Field<float>(name + ".scratch", level.shape.layout);
    if (!levels_.empty()) {
      level.coefficients = FaceVector<float>(name + ".coefficients", level.shape.layout);
      if constexpr (reactive) {
        level.reaction.total = Field<float>(name + ".reaction", level.shape.layout);
        level.reaction.volume = Field<float>(name + ".volume", level.shape.layout);
        level.op =
            ReactiveOperator<float>(level.shape, level.coefficients, Real3{1, 1, 1}, level.reaction.total);
      } else {
        level.op = LevelOperator<float>(level.shape, level.coefficients, Real3{1, 1, 1});
      }
    }
    levels_.push_back(level);
    if (level.shape.number_of_cells() <= (reactive ? 32 : CoarseSolver::largest_size)) break;
    levels_.back().transfer.merging = next_merging(shape, spacing);
    shape = LevelShape(shape, levels_.back().transfer.merging);
  }
  coarse_solver_ = CoarseSolver(levels_.back().shape);
}

template <bool reactive>
void BasicMultigrid<reactive>::set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows,
                                                  const Field<float>& reaction) {
  open_ = open;
  levels_[0].reaction.total = reaction;
  if constexpr (reactive)
    finest_ = ReactiveOperator<OpenFraction>(levels_[0].shape, open, weights_, reaction);
  else
    finest_ = LevelOperator<OpenFraction>(levels_[0].shape, open, weights_);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const PressureSides& sides = level.shape.sides;
    level.rows = l == 0 ? aligned_rows(rows, level.shape)
                        : coarse_rows(levels_[l - 1].rows, level.shape, levels_[l - 1].transfer.merging);
    level.plan = SweepPlan(level.shape.cells, level.rows.box,
                           {sides.is_periodic(0), sides.is_periodic(1), sides.is_periodic(2)},
                           level.transfer.merging.shift);
    level.fields.rhs.fill(0);
    level.fields.solution.fill(0);
    level.fields.scratch.fill(0);
    if (l == 0) continue;
    Transfer& transfer = levels_[l - 1].transfer;
    transfer.coarse_shape = level.shape;
    transfer.coarse_rows = level.rows;
    transfer.prolongation_rows = prolongation_rows(levels_[l - 1].rows, transfer.merging);
  }
  update({Box{{0, 0, 0}, levels_[0].shape.cells}});
}

template <bool reactive>
void BasicMultigrid<reactive>::update(const std::vector<Box>& changed) {
  const std::vector<Box> pieces = pieces_inside(levels_[0].shape, changed);
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const LevelShape& shape = levels_[l].shape;
    const Merging& merging = levels_[l - 1].transfer.merging;
    std::vector<Box> boxes;
    for (const Box& piece : pieces) boxes.push_back(covering_cells(shape, piece));
    changed_.assign(boxes);
    if (l == 1)
      derive_coefficients<OpenFraction>(finest_, shape, merging, changed_, levels_[l].coefficients);
    else
      derive_coefficients<float>(levels_[l - 1].op, shape, merging, changed_, levels_[l].coefficients);
    if constexpr (reactive)
      derive_reaction(levels_[l - 1].shape, levels_[l - 1].reaction, merging, changed_, levels_[l].reaction);
  }
  set_coarse_operator();
}

template <bool reactive>
void BasicMultigrid<reactive>::set_coarse_operator() const {
  const float* reaction = nullptr;
  if constexpr (reactive) reaction = levels_.back().reaction.total.data();
  if (levels_.size() == 1)
    coarse_solver_.set_operator<OpenFraction>(finest_, reaction);
  else
    coarse_solver_.set_operator<float>(levels_.back().op, reaction);
}

template <bool reactive>
Real BasicMultigrid<reactive>::apply() const {
  const std::size_t last = levels_.size() - 1;
  for (std::size_t l = 0; l < last; ++l) {
    const Level& level = levels_[l];
    const Field<float>& coarse_rhs = levels_[l + 1].fields.rhs;
    if (l == 0)
      smooth_and_restrict(finest_, level.plan, level.rows, level.transfer, level.fields, coarse_rhs);
    else
      smooth_and_restrict(level.op, level.plan, level.rows, level.transfer, level.fields, coarse_rhs);
  }
  coarse_solver_.solve(levels_[last].fields.rhs, levels_[last].fields.solution);
  for (std::size_t l = last; l-- > 1;) {
    const Level& level = levels_[l];
    prolong_and_smooth(level.op, level.plan, level.rows, level.transfer, level.fields,
                       levels_[l + 1].fields.solution);
  }
  const Level& finest = levels_[0];
  if (last == 0) return dot(finest.fields.solution, finest.fields.rhs, finest.rows, finest.plan);
  return prolong_and_smooth(finest_, finest.plan, finest.rows, finest.transfer, finest.fields,
                            levels_[1].fields.solution);
}

template <bool reactive>
std::size_t BasicMultigrid<reactive>::bytes() const {
  std::size_t total = coarse_solver_.bytes();
  for (const Level& level : levels_) {
    total += bytes_of(level.fields.rhs) + bytes_of(level.fields.solution) + bytes_of(level.fields.scratch);
    for (int axis = 0; axis < 3; ++axis)
      if (level.coefficients[axis].is_allocated()) total += bytes_of(level.coefficients[axis]);
    if (level.reaction.volume.is_allocated()) total += 2 * bytes_of(level.reaction.volume);
    total += bytes_of(level.rows) + bytes_of(level.transfer.prolongation_rows);
  }
  return total;
}

template class BasicMultigrid<false>;
template class BasicMultigrid<true>;

}  // namespace peclet::flow
