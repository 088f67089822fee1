#include "flow/group_transfer.hpp"

namespace peclet::flow {

void restrict_group(const Field<unsigned char>& group, int own, const Merging& merging,
                    const Field<float>& fine, const RowRanges& coarse_rows, const Field<float>& coarse) {
  const unsigned char value = static_cast<unsigned char>(own);
  const Layout layout = fine.layout();
  for_each_cell(
      "flow::restrict_group", coarse_rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Box box = merging.children({i, j, k}, layout.cells);
        float sum = 0;
        for (int c = box.low[2]; c < box.high[2]; ++c)
          for (int b = box.low[1]; b < box.high[1]; ++b)
            for (Index n = layout(box.low[0], b, c); n < layout(box.high[0], b, c); ++n)
              sum += group[n] == value ? fine[n] : 0;
        coarse(i, j, k) = sum;
      });
}

void prolong_group(const Field<unsigned char>& group, int own, const Merging& merging,
                   const Field<float>& coarse, const RowRanges& rows, const Field<float>& fine) {
  const unsigned char value = static_cast<unsigned char>(own);
  for_each_cell(
      "flow::prolong_group", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index n = fine.layout()(i, j, k);
        const float change = coarse(merging.parent(0, i), merging.parent(1, j), merging.parent(2, k));
        fine[n] += group[n] == value ? change : 0;
      });
}

}  // namespace peclet::flow
