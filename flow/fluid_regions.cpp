#include "flow/fluid_regions.hpp"

#include <algorithm>

namespace peclet::flow {
namespace {

using Word = RowMasks::Word;
constexpr int bits = RowMasks::bits;

/// action(first cell of a run in the row, place of the run)
template <class Action>
KOKKOS_INLINE_FUNCTION void for_each_run(const RowMasks& masks, Index row, const Action& action) {
  int run = 0;
  for (int word = 0; word < masks.words; ++word)
    for (Word starts = masks.starts(row, word); starts != 0; starts &= starts - 1)
      action(word * bits + Kokkos::countr_zero(starts), masks.place(row, run++));
}

KOKKOS_INLINE_FUNCTION void read_word(const RowMasks& masks, const LevelOperator<OpenFraction>& op, Index row,
                                      int word) {
  const LevelShape& shape = masks.shape;
  const int j = static_cast<int>(row % shape.cells[1]), k = static_cast<int>(row / shape.cells[1]);
  const Index n = shape.layout(0, j, k);
  const OpenFraction *x = op.x + n, *y = op.y + n, *z = op.z + n;
  const Index pitch_y = shape.layout.pitch_y, pitch_z = shape.layout.pitch_z;
  const OpenFraction used_x = op.used(0), used_y = op.used(1), used_z = op.used(2);
  Word links_x = 0, links_y = 0, links_z = 0, open = 0;
  const int begin = word * bits, end = begin + bits < shape.cells[0] ? begin + bits : shape.cells[0];
  for (int i = begin; i < end; ++i) {
    const OpenFraction low_x = x[i] & used_x, low_y = y[i] & used_y, low_z = z[i] & used_z;
    const OpenFraction high = (x[i + 1] & used_x) | (y[i + pitch_y] & used_y) | (z[i + pitch_z] & used_z);
    const OpenFraction any = low_x | low_y | low_z | high;
    links_x |= Word(low_x != 0) << (i - begin);
    links_y |= Word(low_y != 0) << (i - begin);
    links_z |= Word(low_z != 0) << (i - begin);
    open |= Word(any != 0) << (i - begin);
  }
  const Index m = row * masks.words + word;
  masks.x[m] = links_x;
  masks.y[m] = links_y;
  masks.z[m] = links_z;
  masks.open[m] = open;
}

/// Unites the runs of two rows, once for every stretch of cells that are linked in both rows and to each
/// other.
KOKKOS_INLINE_FUNCTION void link_rows(const RowMasks& masks, const Word* links, Index row, Index other) {
  Word carry = 0;
  for (int word = 0; word < masks.words; ++word) {
    const Index m = row * masks.words + word, o = other * masks.words + word;
    const Word link = links[m];
    Word needed = link & ~(((link << 1) | carry) & masks.x[m] & masks.x[o]);
    carry = link >> (bits - 1);
    for (; needed != 0; needed &= needed - 1) {
      const int i = word * bits + Kokkos::countr_zero(needed);
      masks.unite(masks.run_of(row, i), masks.run_of(other, i));
    }
  }
}

KOKKOS_INLINE_FUNCTION void link_row(const RowMasks& masks, Index row) {
  const Int3& n = masks.shape.cells;
  const PressureSides& sides = masks.shape.sides;
  const int j = static_cast<int>(row % n[1]), k = static_cast<int>(row / n[1]);
  if (j > 0 || sides.is_periodic(1)) link_rows(masks, masks.y, row, masks.row(j > 0 ? j - 1 : n[1] - 1, k));
  if (k > 0 || sides.is_periodic(2)) link_rows(masks, masks.z, row, masks.row(j, k > 0 ? k - 1 : n[2] - 1));
  if (sides.is_periodic(0) && (masks.x[row * masks.words] & 1))
    masks.unite(masks.run_of(row, 0), masks.run_of(row, n[0] - 1));
}

/// Whether the cell has an open face on a Fixed side.
KOKKOS_INLINE_FUNCTION bool touches_fixed_side(const LevelOperator<OpenFraction>& op, const Int3& cell) {
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      if (cell[axis] != (high ? op.shape.cells[axis] - 1 : 0)) continue;
      if (op.shape.sides.side[axis][high] != PressureSide::Fixed) continue;
      Int3 face = cell;
      face[axis] += high;
      if (op.face(axis, face[0], face[1], face[2]) > 0) return true;
    }
  return false;
}

void start_runs(const RowMasks& masks, Index rows) {
  for_each(
      "flow::runs", rows,
      KOKKOS_LAMBDA(Index row) { for_each_run(masks, row, [&](int, int run) { masks.parent[run] = run; }); });
}

void link_runs(const RowMasks& masks, Index rows) {
  for_each("flow::link", rows, KOKKOS_LAMBDA(Index row) { link_row(masks, row); });
}

void flatten_trees(const RowMasks& masks, Index rows) {
  for_each(
      "flow::flatten", rows, KOKKOS_LAMBDA(Index row) {
        for_each_run(masks, row, [&](int, int run) { masks.parent[run] = masks.root_of(run); });
      });
}

/// Roots become minus region minus one, numbered in the order of the rows; returns their number.
Index number_regions(const RowMasks& masks, Index rows, const Array<Index>& offsets) {
  const Index number = exclusive_sum(
      "flow::count", rows, offsets, KOKKOS_LAMBDA(Index row) {
        Index roots = 0;
        for_each_run(masks, row, [&](int, int run) { roots += masks.parent[run] == run; });
        return roots;
      });
  for_each(
      "flow::number", rows, KOKKOS_LAMBDA(Index row) {
        int region = static_cast<int>(offsets(row));
        for_each_run(masks, row, [&](int, int run) {
          if (masks.parent[run] == run) masks.parent[run] = -(region++) - 1;
        });
      });
  return number;
}

void count_cells(const RowMasks& masks, Index rows, const Array<Index>& cells) {
  for_each(
      "flow::region_size", rows, KOKKOS_LAMBDA(Index row) {
        for_each_run(masks, row, [&](int i, int run) {
          Kokkos::atomic_add(&cells(masks.region_of(run)), Index(masks.run_end(row, i) - i));
        });
      });
}

void mark_fixed(const RowMasks& masks, const LevelOperator<OpenFraction>& op, const Array<int>& fixed) {
  const Int3 n = op.shape.cells;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      if (op.shape.sides.side[axis][high] != PressureSide::Fixed) continue;
      Box layer{{0, 0, 0}, n};
      layer.low[axis] = high ? n[axis] - 1 : 0;
      layer.high[axis] = layer.low[axis] + 1;
      for_each_cell(
          "flow::fixed", layer, KOKKOS_LAMBDA(int i, int j, int k) {
            if (touches_fixed_side(op, Int3{i, j, k}))
              Kokkos::atomic_store(&fixed(masks.region_of(masks.run_of(masks.row(j, k), i))), 1);
          });
    }
}

void sum_over_regions(const RowMasks& masks, Index rows, const Field<Real>& rhs, const Array<Real>& sums) {
  for_each_ordered_on_host(
      "flow::region_sums", rows, KOKKOS_LAMBDA(Index row) {
        const int ny = masks.shape.cells[1];
        const Real* const values =
            &rhs[rhs.layout()(0, static_cast<int>(row % ny), static_cast<int>(row / ny))];
        for_each_run(masks, row, [&](int i, int run) {
          const int end = masks.run_end(row, i);
          Real sum = 0;
          for (int m = i; m < end; ++m) sum += values[m];
          Kokkos::atomic_add(&sums(masks.region_of(run)), sum);
        });
      });
}

void subtract_means(const RowMasks& masks, Index rows, const Array<Real>& means, const Field<Real>& rhs) {
  for_each(
      "flow::subtract", rows, KOKKOS_LAMBDA(Index row) {
        const int ny = masks.shape.cells[1];
        Real* const values = &rhs[rhs.layout()(0, static_cast<int>(row % ny), static_cast<int>(row / ny))];
        for_each_run(masks, row, [&](int i, int run) {
          const int end = masks.run_end(row, i);
          const Real mean = means(masks.region_of(run));
          for (int m = i; m < end; ++m) values[m] -= mean;
        });
      });
}

void copy_groups(const RowMasks& masks, Index rows, const Array<unsigned char>& group_of_region,
                 const Field<unsigned char>& group, const Array<Box>& boxes) {
  for_each(
      "flow::groups", rows, KOKKOS_LAMBDA(Index row) {
        const int ny = masks.shape.cells[1];
        const int j = static_cast<int>(row % ny), k = static_cast<int>(row / ny);
        unsigned char* const groups = &group[group.layout()(0, j, k)];
        for_each_run(masks, row, [&](int i, int run) {
          const Int3 begin{i, j, k}, end{masks.run_end(row, i), j + 1, k + 1};
          const unsigned char own = group_of_region(masks.region_of(run));
          for (int m = begin[0]; m < end[0]; ++m) groups[m] = own;
          for (int axis = 0; axis < 3; ++axis) {
            Kokkos::atomic_min(&boxes(own).low[axis], begin[axis]);
            Kokkos::atomic_max(&boxes(own).high[axis], end[axis]);
          }
        });
      });
}

void divide_sums(Index number, const Array<Index>& cells, const Array<int>& fixed, const Array<Real>& means) {
  for_each(
      "flow::means", number,
      KOKKOS_LAMBDA(Index n) { means(n) = fixed(n) ? 0 : means(n) / static_cast<Real>(cells(n)); });
}

Index count_open_cells(const RowMasks& masks, Index rows) {
  return static_cast<Index>(sum_each(
      "flow::open_cells", rows * masks.words,
      KOKKOS_LAMBDA(Index n) { return static_cast<Real>(Kokkos::popcount(masks.open[n])); }));
}

/// Cells whose faces may change with those of the cells in the box; the high end may lie beyond the box.
Box affected_cells(const LevelShape& shape, const Box& changed) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const int n = shape.cells[axis];
    int low = changed.low[axis] - 1, high = changed.high[axis] + 1;
    if (!shape.sides.is_periodic(axis)) {
      low = std::max(low, 0);
      high = std::max(low, std::min(high, n));
    } else if (high - low >= n || (axis == 0 && (low < 0 || high > n))) {
      low = 0;
      high = n;
    } else {
      const int shifted = (low % n + n) % n;
      high += shifted - low;
      low = shifted;
    }
    box.low[axis] = low;
    box.high[axis] = high;
  }
  return box;
}

/// Boxes count words along x; along y and z they may reach beyond the box by less than its size.
void read_words(const RowMasks& masks, const LevelOperator<OpenFraction>& op, const BoxList& boxes) {
  const int ny = masks.shape.cells[1], nz = masks.shape.cells[2];
  for_each_cell(
      "flow::read_faces", boxes,
      KOKKOS_LAMBDA(int word, int j, int k) { read_word(masks, op, masks.row(j % ny, k % nz), word); });
}

}  // namespace

FluidRegions::FluidRegions(const LevelShape& shape) : shape_(shape) {
  const Index rows = static_cast<Index>(shape.cells[1]) * shape.cells[2];
  const Index words = (shape.cells[0] + bits - 1) / bits;
  links_x_ = Array<Word>("region_links_x", rows * words);
  links_y_ = Array<Word>("region_links_y", rows * words);
  links_z_ = Array<Word>("region_links_z", rows * words);
  open_ = Array<Word>("region_open", rows * words);
  parent_ = Array<int>("region_parent", shape.number_of_cells());
  row_offset_ = Array<Index>("region_offset", rows + 1);
  group_boxes_ = Array<Box>("region_group_boxes", most_groups);
  reserve(64);
}

RowMasks FluidRegions::masks() const {
  const int words = static_cast<int>(open_.extent(0) / (row_offset_.extent(0) - 1));
  return {shape_, words, links_x_.data(), links_y_.data(), links_z_.data(), open_.data(), parent_.data()};
}

void FluidRegions::reserve(Index number) {
  cells_ = Array<Index>("region_cells", number);
  fixed_ = Array<int>("region_fixed", number);
  mean_ = Array<Real>("region_mean", number);
}

void FluidRegions::find(const LevelOperator<OpenFraction>& op) {
  read_faces(op, {Box{{0, 0, 0}, shape_.cells}});
  merge_runs(op);
}

void FluidRegions::update(const LevelOperator<OpenFraction>& op, const std::vector<Box>& changed) {
  read_faces(op, changed);
  merge_runs(op);
}

void FluidRegions::read_faces(const LevelOperator<OpenFraction>& op, const std::vector<Box>& changed) {
  std::vector<Box> boxes;
  for (const Box& box : changed) {
    Box words = affected_cells(shape_, box);
    if (words.size() == 0) continue;
    words.low[0] /= bits;
    words.high[0] = (words.high[0] - 1) / bits + 1;
    boxes.push_back(words);
  }
  words_.assign(boxes);
  read_words(masks(), op, words_);
}

void FluidRegions::merge_runs(const LevelOperator<OpenFraction>& op) {
  const Index rows = row_offset_.extent(0) - 1;
  const RowMasks m = masks();
  start_runs(m, rows);
  link_runs(m, rows);
  flatten_trees(m, rows);
  number_ = number_regions(m, rows, row_offset_);
  if (number_ > static_cast<Index>(cells_.extent(0))) reserve(2 * number_);
  open_cells_ = count_open_cells(m, rows);
  Kokkos::deep_copy(fixed_, 0);
  mark_fixed(m, op, fixed_);
  Kokkos::deep_copy(first_is_fixed_, Kokkos::subview(fixed_, 0));
  groups_ = 1;
  if (number_ < 2) return;
  Kokkos::deep_copy(cells_, 0);
  count_cells(m, rows, cells_);
  form_groups();
}

void FluidRegions::form_groups() {
  const std::vector<Index> cells = copy_to_host(cells_);
  std::vector<Index> large;
  for (Index region = 0; region < number_; ++region)
    if (cells[region] >= fewest_cells) large.push_back(region);
  if (large.size() < 2) return;
  std::stable_sort(large.begin(), large.end(), [&](Index a, Index b) { return cells[a] > cells[b]; });
  std::vector<unsigned char> groups(cells.size(), 0);
  groups_ = 0;
  for (const Index region : large) {
    groups_ = std::min(groups_ + 1, most_groups);
    groups[region] = static_cast<unsigned char>(groups_ - 1);
  }
  upload("region_group", groups, group_of_region_);
}

std::vector<Box> FluidRegions::write_groups(const Field<unsigned char>& group) const {
  Kokkos::deep_copy(group_boxes_, Box{shape_.cells, {0, 0, 0}});
  copy_groups(masks(), row_offset_.extent(0) - 1, group_of_region_, group, group_boxes_);
  std::vector<Box> boxes = copy_to_host(group_boxes_);
  boxes.resize(static_cast<std::size_t>(groups_));
  return boxes;
}

void FluidRegions::remove_means(const Field<Real>& field) const {
  const Index rows = row_offset_.extent(0) - 1;
  Kokkos::deep_copy(mean_, 0);
  sum_over_regions(masks(), rows, field, mean_);
  divide_sums(number_, cells_, fixed_, mean_);
  subtract_means(masks(), rows, mean_, field);
}

std::size_t FluidRegions::bytes() const {
  return 4 * open_.span() * sizeof(Word) + parent_.span() * sizeof(int) + row_offset_.span() * sizeof(Index) +
         cells_.span() * (sizeof(Index) + sizeof(int) + sizeof(Real)) + group_of_region_.span();
}

}  // namespace peclet::flow
