#pragma once
// The cells of many boxes, visited by one kernel.
#include <string>
#include <vector>

#include "core/field_transfer.hpp"
#include "core/loop.hpp"

namespace peclet {

/// The one of count boxes that entry n lies in, firsts(b) being the first entry of box b.
KOKKOS_INLINE_FUNCTION int box_of_entry(const Array<Index>& firsts, int count, Index n) {
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (firsts(middle) <= n)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

/// Device side of BoxList.
struct BoxListView {
  Array<Box> boxes;
  Array<Index> first_row, first_cell;
  int count = 0;
};

/// Keeps its arrays when boxes are assigned anew.
class BoxList {
 public:
  void assign(const std::vector<Box>& boxes) {
    std::vector<Index> first_row, first_cell;
    rows_ = cells_ = 0;
    for (const Box& box : boxes) {
      first_row.push_back(rows_);
      first_cell.push_back(cells_);
      rows_ += static_cast<Index>(box.extent(1)) * box.extent(2);
      cells_ += box.size();
    }
    view_.count = static_cast<int>(boxes.size());
    upload("core::boxes", boxes, view_.boxes);
    upload("core::first_row", first_row, view_.first_row);
    upload("core::first_cell", first_cell, view_.first_cell);
  }
  const BoxListView& view() const { return view_; }
  Index number_of_rows() const { return rows_; }
  Index number_of_cells() const { return cells_; }

 private:
  BoxListView view_;
  Index rows_ = 0, cells_ = 0;
};

/// body(i, j, k) on every cell of every box. Where boxes overlap, a cell is visited by several threads: what
/// they write must be the same.
template <class Body>
void for_each_cell(const std::string& label, const BoxList& list, const Body& body) {
  const BoxListView view = list.view();
  if constexpr (runs_on_host) {
    for_each(label, list.number_of_rows(), [=](Index n) {
      const int b = box_of_entry(view.first_row, view.count, n);
      const Box& box = view.boxes(b);
      const int row = static_cast<int>(n - view.first_row(b)), ny = box.extent(1);
      const int j = box.low[1] + row % ny, k = box.low[2] + row / ny;
      for (int i = box.low[0]; i < box.high[0]; ++i) body(i, j, k);
    });
  } else {
    for_each(
        label, list.number_of_cells(), KOKKOS_LAMBDA(Index n) {
          const int b = box_of_entry(view.first_cell, view.count, n);
          const Box& box = view.boxes(b);
          const int place = static_cast<int>(n - view.first_cell(b)), nx = box.extent(0), ny = box.extent(1);
          const int row = place / nx;
          body(box.low[0] + place % nx, box.low[1] + row % ny, box.low[2] + row / ny);
        });
  }
}

}  // namespace peclet
