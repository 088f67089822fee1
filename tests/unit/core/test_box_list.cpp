#include "core/box_list.hpp"

#include <gtest/gtest.h>

namespace {

using namespace peclet;

const Int3 cells{40, 30, 20};

/// Cells of the grid that the list visits.
std::vector<int> visited(const BoxList& list) {
  const Field<int> mark("mark", Layout(cells));
  for_each_cell("visit", list, KOKKOS_LAMBDA(int i, int j, int k) { mark(i, j, k) = 1; });
  std::vector<int> host(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  copy_to_host(mark, host.data());
  return host;
}

void expect_cells_of(const std::vector<Box>& boxes, BoxList& list) {
  list.assign(boxes);
  const std::vector<int> found = visited(list);
  std::size_t n = 0;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i, ++n) {
        bool covered = false;
        for (const Box& box : boxes) covered = covered || box.contains(i, j, k);
        EXPECT_EQ(found[n], covered ? 1 : 0) << i << ' ' << j << ' ' << k;
      }
}

TEST(BoxList, VisitsTheCellsOfEveryBox) {
  BoxList list;
  expect_cells_of({{{3, 4, 5}, {6, 5, 9}}}, list);
  expect_cells_of({{{0, 0, 0}, {40, 30, 20}}}, list);
  expect_cells_of({{{3, 4, 5}, {6, 5, 9}}, {{0, 0, 0}, {1, 1, 1}}, {{10, 2, 0}, {39, 30, 20}}}, list);
  expect_cells_of({}, list);
}

TEST(BoxList, CountsOverlappingBoxesTwice) {
  BoxList list;
  list.assign({{{0, 0, 0}, {4, 3, 2}}, {{1, 1, 1}, {4, 3, 2}}});
  EXPECT_EQ(list.number_of_cells(), 24 + 6);
  EXPECT_EQ(list.number_of_rows(), 6 + 2);
}

}  // namespace
