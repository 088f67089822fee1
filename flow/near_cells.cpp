#include "flow/near_cells.hpp"

namespace peclet::flow {
namespace {

/// Whether a wall touches one of the faces that the stencils of the low faces of cell (i, j, k) and its
/// balance of volume see; they are the low faces of the cell, of its six neighbours, and of those across the
/// edges between a high and a low neighbour. Cells beside sides always count.
KOKKOS_INLINE_FUNCTION bool is_near(const Field<std::uint8_t>& marks, const DomainSides& sides, int i, int j,
                                    int k) {
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

void find_near_cells(const Field<std::uint8_t>& marks, const DomainSides& sides, const RegionList& regions,
                     const Array<Index>& scratch, NearCells& near) {
  const RegionView region = regions.view();
  const Field<std::uint8_t> mark = marks;
  const DomainSides box = sides;
  near.count = list_where(
      "flow::list_near_cells", regions.number_of_cells(), scratch, KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(n);
        return cell.unique && is_near(mark, box, cell.i, cell.j, cell.k);
      });
  const auto size = static_cast<std::size_t>(near.count);
  if (near.cell.extent(0) < size) near.cell = Array<Int3>("flow::near_cells", size + size / 4);
  const NearCells target = near;
  for_each(
      "flow::find_near_cells", near.count, KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(scratch(n));
        target.cell(n) = Int3{cell.i, cell.j, cell.k};
      });
}

}  // namespace peclet::flow
