#include "flow/near_cells.hpp"

namespace peclet::flow {
namespace {

/// Whether a wall touches one of the faces that the stencils of the low faces of cell (i, j, k) and its
/// balance of volume see; they are the low faces of the cell, of its six neighbours, and of those across the
/// edges between a high and a low neighbour. Cells beside sides always count.
KOKKOS_INLINE_FUNCTION bool is_near(const Field<int>& marks, const DomainSides& sides, int i, int j, int k) {
  const Layout& layout = marks.layout();
  const Index p = layout(i, j, k);
  const int at[3] = {i, j, k};
  Index low[3], high[3];
  int found = marks[p];
  for (int a = 0; a < 3; ++a) {
    const int last = layout.cells[a] - 1;
    if (!sides.is_periodic(a) && (at[a] == 0 || at[a] == last)) return true;
    const Index step = layout.stride(a);
    low[a] = at[a] > 0 ? p - step : p + last * step;
    high[a] = at[a] < last ? step : -last * step;
    found |= marks[low[a]] | marks[p + high[a]];
  }
  for (int a = 0; a < 3; ++a) found |= marks[low[(a + 1) % 3] + high[a]] | marks[low[(a + 2) % 3] + high[a]];
  return found & cell_mark::touched;
}

}  // namespace

void find_near_cells(const Field<int>& marks, const DomainSides& sides, const CellList& cells,
                     const Array<Index>& scratch, CellList& near) {
  const CellList candidates = cells;
  const Field<int> mark = marks;
  const DomainSides box = sides;
  near.count = list_where(
      "flow::list_near_cells", cells.count, scratch, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = candidates.cell(n);
        return is_near(mark, box, cell[0], cell[1], cell[2]);
      });
  near.reserve(near.count);
  const CellList target = near;
  for_each(
      "flow::find_near_cells", near.count,
      KOKKOS_LAMBDA(Index n) { target.listed(n) = candidates.cell(scratch(n)); });
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
