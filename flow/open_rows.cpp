#include "flow/open_rows.hpp"

namespace peclet::flow {

RowRanges open_row_ranges(const FaceVector<OpenFraction>& open_fractions, const Int3& n) {
  RowRanges rows(n);
  const auto count = static_cast<std::size_t>(rows.number_of_rows());
  rows.first = Array<int>("flow::rows.first", count);
  rows.last = Array<int>("flow::rows.last", count);
  const FaceVector<OpenFraction> open = open_fractions;
  const Array<int> first = rows.first, last = rows.last;
  const Layout layout = open.x.layout();
  for_each(
      "flow::open_row_ranges", rows.number_of_rows(), KOKKOS_LAMBDA(Index row) {
        const int j = static_cast<int>(row % n[1]), k = static_cast<int>(row / n[1]);
        int begin = n[0], end = 0;
        for (int i = 0; i < n[0]; ++i) {
          if (!is_open_cell(open, layout(i, j, k))) continue;
          begin = i < begin ? i : begin;
          end = i + 1;
        }
        first(row) = end > begin ? begin / Layout::alignment * Layout::alignment : 0;
        last(row) = end > begin ? end : 0;
      });
  return rows;
}

Box box_of_open_cells(const FaceVector<OpenFraction>& open_fractions, const RowRanges& rows) {
  const FaceVector<OpenFraction> open = open_fractions;
  const Int3 n = open.x.layout().cells;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const Real high = max_cells(
        "flow::box_of_open_cells", rows, KOKKOS_LAMBDA(int i, int j, int k)->Real {
          const int cell[3] = {i, j, k};
          return is_open_cell(open, open.x.layout()(i, j, k)) ? cell[axis] + 1 : 0;
        });
    const Real low = max_cells(
        "flow::box_of_open_cells", rows, KOKKOS_LAMBDA(int i, int j, int k)->Real {
          const int cell[3] = {i, j, k};
          return is_open_cell(open, open.x.layout()(i, j, k)) ? n[axis] - cell[axis] : 0;  // at least 1
        });
    box.high[axis] = static_cast<int>(high);
    box.low[axis] = high > 0 ? n[axis] - static_cast<int>(low) : 0;
  }
  return box;
}

}  // namespace peclet::flow
