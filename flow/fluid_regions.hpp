#pragma once
// Connected regions of fluid: cells that can be reached from each other through open faces.
//
// The faces of a row of cells are kept as bit masks. A run of linked cells is the unit of the search; runs
// are merged into trees whose root has the smallest place, whatever the order of the work
// [HeChaoSuzuki2008].
#include <cstdint>
#include <vector>

#include "core/box_list.hpp"
#include "flow/poisson_operator.hpp"

namespace peclet::flow {

/// The masks of one level. In x, y, z, bit i of a row tells whether the low face of cell i is open; in open,
/// whether the cell has any open face.
struct RowMasks {
  using Word = std::uint64_t;
  static constexpr int bits = 64;

  LevelShape shape;
  int words;  ///< per row
  Word *x, *y, *z, *open;
  int* parent;  ///< by places of runs

  KOKKOS_INLINE_FUNCTION Index number_of_rows() const {
    return static_cast<Index>(shape.cells[1]) * shape.cells[2];
  }
  /// Place of a run: those that are first in their rows come first, because most rows have only one.
  KOKKOS_INLINE_FUNCTION int place(Index row, int run) const {
    return static_cast<int>(run * number_of_rows() + row);
  }

  KOKKOS_INLINE_FUNCTION Index row(int j, int k) const { return j + static_cast<Index>(k) * shape.cells[1]; }
  /// Cells that begin a run.
  KOKKOS_INLINE_FUNCTION Word starts(Index row, int word) const {
    const Word linked_inside = word == 0 ? x[row * words] & ~Word(1) : x[row * words + word];
    return open[row * words + word] & ~linked_inside;
  }
  /// Place of the run of cell i.
  KOKKOS_INLINE_FUNCTION int run_of(Index row, int i) const {
    int word = i / bits;
    int run = Kokkos::popcount(starts(row, word) & (~Word(0) >> (bits - 1 - i % bits))) - 1;
    while (word > 0) run += Kokkos::popcount(starts(row, --word));
    return place(row, run);
  }
  /// End of the run that begins at cell i.
  KOKKOS_INLINE_FUNCTION int run_end(Index row, int i) const {
    int word = (i + 1) / bits;
    if (word == words) return shape.cells[0];
    Word ends = ~(x[row * words + word] & open[row * words + word]) & (~Word(0) << ((i + 1) % bits));
    while (ends == 0) {
      if (++word == words) return shape.cells[0];
      ends = ~(x[row * words + word] & open[row * words + word]);
    }
    const int end = word * bits + Kokkos::countr_zero(ends);
    return end < shape.cells[0] ? end : shape.cells[0];
  }
  KOKKOS_INLINE_FUNCTION int root_of(int run) const {
    while (parent[run] != run) run = parent[run];
    return run;
  }
  /// The root with the larger place is hung below the other one.
  KOKKOS_INLINE_FUNCTION void unite(int a, int b) const {
    for (;;) {
      a = root_of(a);
      b = root_of(b);
      if (a == b) return;
      const int high = a > b ? a : b, low = a > b ? b : a;
      if (Kokkos::atomic_compare_exchange(&parent[high], high, low) == high) return;
    }
  }
  /// Region of a run, once the regions are numbered.
  KOKKOS_INLINE_FUNCTION int region_of(int run) const {
    while (parent[run] >= 0) run = parent[run];
    return -parent[run] - 1;
  }
};

class FluidRegions {
 public:
  FluidRegions() = default;
  explicit FluidRegions(const LevelShape& shape);

  /// Reads the faces of all cells and finds the regions.
  void find(const LevelOperator<OpenFraction>& op);
  /// The same after changes on the faces of cells in the boxes.
  void update(const LevelOperator<OpenFraction>& op, const std::vector<Box>& changed);

  Index number_of_regions() const { return number_; }
  Index number_of_open_cells() const { return open_cells_; }
  /// Whether a Fixed side touches the first region.
  bool first_is_fixed() const { return first_is_fixed_ != 0; }
  /// Large regions are parted into groups, at most most_groups: the largest ones are alone in theirs. 1
  /// unless there are several large regions; small ones follow the largest one.
  int number_of_groups() const { return groups_; }
  /// Writes the group of every cell with an open face; returns the box around each group.
  std::vector<Box> write_groups(const Field<unsigned char>& group) const;
  /// Subtracts from a field its mean over each region that no Fixed side touches.
  void remove_means(const Field<Real>& field) const;
  std::size_t bytes() const;

 private:
  static constexpr int most_groups = 4, fewest_cells = 512;  // of a large region

  RowMasks masks() const;
  void form_groups();
  void reserve(Index number);
  void merge_runs(const LevelOperator<OpenFraction>& op);

  void read_faces(const LevelOperator<OpenFraction>& op, const std::vector<Box>& changed);

  LevelShape shape_;
  BoxList words_;  // to be read
  Array<std::uint64_t> links_x_, links_y_, links_z_, open_;
  Array<int> parent_;
  Array<Index> row_offset_;
  Array<Index> cells_;  ///< per region, like fixed_ and mean_
  Array<int> fixed_;
  Array<Real> mean_;
  Array<unsigned char> group_of_region_;
  Array<Box> group_boxes_;
  Index number_ = 0, open_cells_ = 0;
  int groups_ = 1;
  int first_is_fixed_ = 0;
};

}  // namespace peclet::flow
