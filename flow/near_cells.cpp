#include "flow/near_cells.hpp"

#include "flow/wall_rows.hpp"

namespace peclet::flow {
namespace {

/// Whether a wall touches one of the faces that the stencils of the low faces of cell (i, j, k) and its
/// balance of volume see; they are the low faces of the cell, of its six neighbours, and of those across the
/// edges between a high and a low neighbour. Cells beside sides always count.
KOKKOS_INLINE_FUNCTION bool is_near(const Field<int>& marks, const DomainSides& sides, int i, int j, int k) {
  const Layout& layout = marks.layout();
  const Index p = layout(i, j, k);
  if (marks[p] & cell_mark::touched) return true;
  const int at[3] = {i, j, k};
  Index low[3], high[3];  // steps to the neighbours
  for (int a = 0; a < 3; ++a) {
    const int last = layout.cells[a] - 1;
    const bool is_first = at[a] == 0, is_last = at[a] == last;
    if ((is_first || is_last) && !sides.is_periodic(a)) return true;
    const Index step = layout.stride(a);
    low[a] = is_first ? last * step : -step;
    high[a] = is_last ? -last * step : step;
  }
  int found = 0;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    found |=
        marks[p + low[a]] | marks[p + high[a]] | marks[p + low[b] + high[a]] | marks[p + low[c] + high[a]];
  }
  return found & cell_mark::touched;
}

KOKKOS_INLINE_FUNCTION bool is_cut(const FaceVector<OpenFraction>& open, Index p) {
  bool any_open = false, any_closed = false;
  for (int a = 0; a < 3; ++a) {
    const OpenFraction low = open[a][p], high = open[a][p + open.x.layout().stride(a)];
    any_open = any_open | (low > 0) | (high > 0);
    any_closed = any_closed | (low < fully_open) | (high < fully_open);
  }
  return any_open & any_closed;
}

/// Parts of the low face along axis, not yet shifted.
KOKKOS_INLINE_FUNCTION int parts_of_face(const FaceVector<OpenFraction>& open, const Field<Real>& sdf,
                                         const DomainSides& sides, bool is_cut_cell, int axis,
                                         const Int3& cell) {
  const Layout& layout = open.x.layout();
  const Index p = layout(cell[0], cell[1], cell[2]);
  const OpenFraction fraction = open[axis][p];
  const bool is_row = is_fluid(fraction) && touches_wall(open, sdf, sides, axis, cell[0], cell[1], cell[2]);
  int parts = is_row ? cell_part::wall_row : 0;
  if (fraction == fully_open || sides.is_side(axis, cell[axis], layout.cells)) return parts;
  if (is_cut_cell || is_cut(open, p - layout.stride(axis))) parts |= cell_part::swept;
  if (!is_fluid(fraction)) parts |= is_slit(fraction) ? cell_part::slit : cell_part::closed;
  return parts;
}

}  // namespace

void find_near_cells(const Field<int>& marks, const DomainSides& sides, const CellList& cells,
                     CellList& near) {
  const CellList candidates = cells;
  const Field<int> mark = marks;
  const DomainSides box = sides;
  near.reserve(cells.count);
  near.count = list_selected(
      "flow::find_near_cells", cells.count, Numbers(), near.listed, KOKKOS_LAMBDA(Index n, Int3 & listed) {
        listed = candidates.cell(n);
        return is_near(mark, box, listed[0], listed[1], listed[2]);
      });
}

void sort_near_cells(const FaceVector<OpenFraction>& open, const FaceVector<OpenFraction>& fixed,
                     const Field<Real>& sdf, const Field<int>& marks, const DomainSides& sides,
                     CellList& near) {
  const auto count = static_cast<std::size_t>(near.count);
  if (near.parts.extent(0) < count)
    near.parts = Array<std::uint16_t>("flow::cell_parts", near.listed.extent(0));
  const CellList target = near;
  const FaceVector<OpenFraction> now = open, before = fixed;
  const Field<Real> distance = sdf;
  const Field<int> mark = marks;
  const DomainSides box = sides;
  for_each(
      "flow::sort_near_cells", near.count, KOKKOS_LAMBDA(Index n) {
        const Layout& layout = mark.layout();
        const Int3 cell = target.cell(n);
        const Index p = layout(cell[0], cell[1], cell[2]);
        const bool is_cut_cell = is_cut(now, p), is_fixed = mark[p] & cell_mark::touched_by_fixed;
        int parts = is_cut_cell ? cell_part::cut_cell : 0;
        for (int a = 0; a < 3; ++a) {
          parts |= parts_of_face(now, distance, box, is_cut_cell, a, cell) << a;
          if (is_fixed && !is_fluid(before[a][p]) && !box.is_side(a, cell[a], layout.cells))
            parts |= cell_part::fixed_wall << a;
        }
        target.parts(n) = static_cast<std::uint16_t>(parts);
      });
}

void number_near_cells(const CellList& near, const Field<int>& marks) {
  const CellList source = near;
  const Field<int> mark = marks;
  for_each(
      "flow::number_near_cells", near.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = source.cell(n);
        mark(cell[0], cell[1], cell[2]) += cell_mark::first_number * static_cast<int>(n + 1);
      });
}

}  // namespace peclet::flow
