#pragma once
// The cells that walls concern. What lies beside walls is listed from them, so that the boxes around moving
// bodies are searched once, and the grid around fixed ones; what each of them has is found in one pass.
#include "core/field.hpp"
#include "core/loop.hpp"
#include "flow/domain_sides.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// What a cell has, as bits; those of faces are shifted by the axis of its low face.
namespace cell_part {
inline constexpr int wall_row = 1 << 0;     // fluid face whose stencil touches a wall
inline constexpr int slit = 1 << 3;         // face
inline constexpr int closed = 1 << 6;       // face, not on a side
inline constexpr int swept = 1 << 9;        // face closed in part or whole, beside a cut cell
inline constexpr int fixed_wall = 1 << 12;  // face that is no fluid one in the fixed geometry, not on a side
inline constexpr int cut_cell = 1 << 15;    // with open and closed faces
}  // namespace cell_part

/// Cells of the grid: those listed, or all of them.
struct CellList {
  Index count = 0;
  Array<Int3> listed;
  Array<std::uint16_t> parts;  // where sort_near_cells has been called
  Int3 all{0, 0, 0};

  static CellList of_grid(const Int3& cells) {
    CellList list;
    list.count = static_cast<Index>(cells[0]) * cells[1] * cells[2];
    list.all = cells;
    return list;
  }
  /// What was listed is lost.
  void reserve(Index capacity) {
    const auto n = static_cast<std::size_t>(capacity);
    if (listed.extent(0) < n) listed = Array<Int3>("flow::cell_list", n + n / 4);
  }
  /// Whether the cell, or its low face along axis, is one of these parts.
  KOKKOS_INLINE_FUNCTION bool has(Index n, int part, int axis = 0) const { return parts(n) >> axis & part; }
  KOKKOS_INLINE_FUNCTION Int3 cell(Index n) const {
    if (all[0] == 0) return listed(n);
    const Index row = n / all[0];
    return {static_cast<int>(n % all[0]), static_cast<int>(row % all[1]), static_cast<int>(row / all[1])};
  }
};

/// What is known of a cell, as bits of its mark; the bits above count near cells from 1.
namespace cell_mark {
inline constexpr int touched = 1;           // the cell is solid, or one of its low faces not fully open
inline constexpr int touched_by_fixed = 2;  // the same with the fixed solid alone
inline constexpr int between_bodies = 4;  // one of its low faces can be in a narrow gap beside a moving body
inline constexpr int in_even_band = 8;    // around a moving body, for every other update
inline constexpr int in_odd_band = 16;
inline constexpr int in_band = in_even_band | in_odd_band;
inline constexpr int first_number = 32;
}  // namespace cell_mark

/// Place of a cell in the list of near cells; -1 if it is not among them.
KOKKOS_INLINE_FUNCTION int near_index(int mark) { return mark / cell_mark::first_number - 1; }

/// Lists those of the cells that walls concern: every cell with a face or a stencil that a wall touches is
/// among them. marks: ghosts need not be filled.
void find_near_cells(const Field<int>& marks, const DomainSides& sides, const CellList& cells,
                     CellList& near);

/// Writes down what the near cells have. fixed: open fractions of the fixed geometry.
void sort_near_cells(const FaceVector<OpenFraction>& open, const FaceVector<OpenFraction>& fixed,
                     const Field<Real>& sdf, const Field<int>& marks, const DomainSides& sides,
                     CellList& near);

/// Writes the places of near cells into their marks.
void number_near_cells(const CellList& near, const Field<int>& marks);

}  // namespace peclet::flow
