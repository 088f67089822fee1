#pragma once
// The cells that walls concern. What lies beside walls is listed from them, so that the boxes around moving
// bodies are searched once, and the grid around fixed ones.
#include "core/field.hpp"
#include "core/loop.hpp"
#include "flow/domain_sides.hpp"

namespace peclet::flow {

/// Cells of the grid: those listed, or all of them.
struct CellList {
  Index count = 0;
  Array<Int3> listed;
  Int3 all{0, 0, 0};

  static CellList of_grid(const Int3& cells) {
    CellList list;
    list.count = static_cast<Index>(cells[0]) * cells[1] * cells[2];
    list.all = cells;
    return list;
  }
  void reserve(Index capacity) {
    const auto n = static_cast<std::size_t>(capacity);
    if (listed.extent(0) < n) listed = Array<Int3>("flow::cell_list", n + n / 4);
  }
  KOKKOS_INLINE_FUNCTION Int3 cell(Index n) const {
    if (all[0] == 0) return listed(n);
    const Index row = n / all[0];
    return {static_cast<int>(n % all[0]), static_cast<int>(row % all[1]), static_cast<int>(row / all[1])};
  }
};

/// What is known of a cell, as bits of its mark; the bits above count near cells from 1.
namespace cell_mark {
inline constexpr int in_band = 1;           // around a moving body
inline constexpr int touched = 2;           // the cell is solid, or one of its low faces not fully open
inline constexpr int touched_by_fixed = 4;  // the same with the fixed solid alone
inline constexpr int first_number = 8;
}  // namespace cell_mark

/// Place of a cell in the list of near cells; -1 if it is not among them.
KOKKOS_INLINE_FUNCTION int near_index(int mark) { return mark / cell_mark::first_number - 1; }

/// Lists those of the cells that walls concern: every cell with a face or a stencil that a wall touches is
/// among them. marks: ghosts need not be filled. scratch has room for all the cells.
void find_near_cells(const Field<int>& marks, const DomainSides& sides, const CellList& cells,
                     const Array<Index>& scratch, CellList& near);

/// Writes the places of near cells into their marks.
void number_near_cells(const CellList& near, const Field<int>& marks);

}  // namespace peclet::flow
