#pragma once
// The boxes of cells around moving bodies, flattened so that one kernel visits every cell of every box
// exactly once, although boxes overlap and wrap around periodic edges.
#include <vector>

#include "core/box_list.hpp"

namespace peclet::flow {

/// One visited cell: indices inside the domain.
struct RegionCell {
  int i, j, k;
  int region;    // which box
  bool unique;   // false where an earlier box visits the same cell
  int place[3];  // the cell in the box, unwrapped
};

/// Device side of RegionList. Its places are the cells of the boxes, one box after the other.
struct RegionView {
  Array<Box> boxes;           // unwrapped: low in [0, n), high may exceed n
  Array<Index> first_cell;    // per box, plus the total
  Array<int> body;            // per box
  Array<int> first_neighbor;  // per box, plus the total
  Array<int> neighbors;       // boxes that share cells with a box, itself included, ascending
  Int3 cells;
  int count = 0;

  KOKKOS_INLINE_FUNCTION static int wrap(int i, int n) { return i >= n ? i - n : i; }

  KOKKOS_INLINE_FUNCTION bool contains(int box, int i, int j, int k) const {
    const Box& b = boxes(box);
    const int p[3] = {i, j, k};
    for (int a = 0; a < 3; ++a) {
      const bool direct = p[a] >= b.low[a] && p[a] < b.high[a];
      const bool wrapped = p[a] + cells[a] >= b.low[a] && p[a] + cells[a] < b.high[a];
      if (!direct && !wrapped) return false;
    }
    return true;
  }

  KOKKOS_INLINE_FUNCTION RegionCell at(Index n) const {
    const int own = box_of_entry(first_cell, count, n);
    const Box& box = boxes(own);
    const int place = static_cast<int>(n - first_cell(own));
    const int nx = box.extent(0), ny = box.extent(1), row = place / nx;
    return cell_of(own, box.low[0] + place - row * nx, box.low[1] + row % ny, box.low[2] + row / ny);
  }
  KOKKOS_INLINE_FUNCTION void advance(RegionCell& cell) const {
    const Box& box = boxes(cell.region);
    int region = cell.region, x = cell.place[0] + 1, y = cell.place[1], z = cell.place[2];
    if (x == box.high[0]) {
      x = box.low[0];
      if (++y == box.high[1]) {
        y = box.low[1];
        ++z;
      }
      if (z == box.high[2] && region + 1 < count) {
        const Box& next = boxes(++region);
        x = next.low[0];
        y = next.low[1];
        z = next.low[2];
      }
    }
    cell = cell_of(region, x, y, z);
  }

 private:
  KOKKOS_INLINE_FUNCTION RegionCell cell_of(int region, int x, int y, int z) const {
    RegionCell cell{wrap(x, cells[0]), wrap(y, cells[1]), wrap(z, cells[2]), region, true, {x, y, z}};
    for (int m = first_neighbor(region); m < first_neighbor(region + 1) && neighbors(m) < region; ++m)
      if (contains(neighbors(m), cell.i, cell.j, cell.k)) cell.unique = false;
    return cell;
  }
};

/// Boxes cut at the periodic edges: all inside the domain.
std::vector<Box> cut_inside(const std::vector<Box>& boxes, const Int3& cells);
/// Boxes that cover those of both lists, one by one with a common hull where that is smaller than the two.
std::vector<Box> joined(const std::vector<Box>& first, const std::vector<Box>& second);

/// Host side: built from one box per body, reuses its device arrays.
class RegionList {
 public:
  RegionList() = default;
  explicit RegionList(const Int3& cells) { view_.cells = cells; }

  void assign(const std::vector<Box>& boxes, const std::vector<int>& bodies);
  void clear() { assign({}, {}); }

  const RegionView& view() const { return view_; }
  Index number_of_cells() const { return total_; }
  bool empty() const { return total_ == 0; }
  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  RegionView view_;
  std::vector<Box> boxes_;
  Index total_ = 0;
};

}  // namespace peclet::flow
