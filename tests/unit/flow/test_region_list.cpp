#include "flow/region_list.hpp"

#include <gtest/gtest.h>

#include "core/field_transfer.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Int3 cells{9, 6, 7};

/// How often the cells that count as unique are visited.
std::vector<int> unique_visits(const RegionList& list) {
  const Field<int> count("count", Layout(cells));
  const RegionView view = list.view();
  for_each(
      "count_unique", list.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = view.at(n);
        if (cell.unique) Kokkos::atomic_add(&count(cell.i, cell.j, cell.k), 1);
      });
  std::vector<int> host(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  copy_to_host(count, host.data());
  return host;
}

/// Same for the boxes cut at the periodic edges.
std::vector<int> visits_inside(const RegionList& list) {
  const Field<int> count("count", Layout(cells));
  for (const Box& box : cut_inside(list.boxes(), cells))
    for_each_cell("count_inside", box, KOKKOS_LAMBDA(int i, int j, int k) { count(i, j, k) = 1; });
  std::vector<int> host(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  copy_to_host(count, host.data());
  return host;
}

bool covers(const Box& box, int i, int j, int k) {
  for (int x = i; x < box.high[0]; x += cells[0])
    for (int y = j; y < box.high[1]; y += cells[1])
      for (int z = k; z < box.high[2]; z += cells[2])
        if (box.contains(x, y, z)) return true;
  return false;
}

/// Places of a list where advance leads to another cell than at.
Index stray_places(const RegionList& list) {
  const RegionView view = list.view();
  return static_cast<Index>(sum_each(
      "stray_places", list.number_of_cells() - 1, KOKKOS_LAMBDA(Index n) {
        RegionCell cell = view.at(n);
        const RegionCell next = view.at(n + 1);
        view.advance(cell);
        const bool is_same = cell.i == next.i && cell.j == next.j && cell.k == next.k &&
                             cell.region == next.region && cell.unique == next.unique;
        return is_same ? 0.0 : 1.0;
      }));
}

void expect_every_cell_once(const std::vector<Box>& boxes) {
  RegionList list(cells);
  std::vector<int> bodies;
  for (std::size_t b = 0; b < boxes.size(); ++b) bodies.push_back(static_cast<int>(b));
  list.assign(boxes, bodies);
  EXPECT_EQ(stray_places(list), 0);
  const std::vector<int> unique = unique_visits(list), inside = visits_inside(list);
  std::size_t n = 0;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i, ++n) {
        bool covered = false;
        for (const Box& box : boxes) covered = covered || covers(box, i, j, k);
        EXPECT_EQ(unique[n], covered ? 1 : 0) << i << ' ' << j << ' ' << k;
        EXPECT_EQ(inside[n], covered ? 1 : 0) << i << ' ' << j << ' ' << k;
      }
}

TEST(RegionList, VisitsASingleBox) { expect_every_cell_once({{{1, 2, 0}, {4, 5, 6}}}); }

TEST(RegionList, WrapsAroundTheEdges) { expect_every_cell_once({{{7, 4, 5}, {12, 8, 9}}}); }

TEST(RegionList, VisitsCellsOfOverlappingBoxesOnce) {
  expect_every_cell_once({{{1, 1, 1}, {6, 5, 5}}, {{4, 0, 2}, {8, 3, 7}}, {{5, 2, 2}, {7, 6, 4}}});
}

TEST(RegionList, VisitsCellsOfBoxesThatOverlapAcrossTheEdgeOnce) {
  expect_every_cell_once({{{7, 4, 5}, {12, 8, 9}}, {{0, 0, 0}, {4, 3, 3}}, {{0, 0, 0}, {9, 6, 7}}});
}

TEST(RegionList, CountsCellsBoxByBox) {
  RegionList list(cells);
  list.assign({{{1, 1, 1}, {3, 3, 3}}, {{1, 1, 1}, {3, 3, 4}}}, {0, 1});
  EXPECT_EQ(list.number_of_cells(), 8 + 12);
  list.clear();
  EXPECT_TRUE(list.empty());
  EXPECT_TRUE(cut_inside(list.boxes(), cells).empty());
}

TEST(Joined, TakesTheHullOfBoxesThatHardlyMoved) {
  const std::vector<Box> both = joined({{{1, 1, 1}, {5, 5, 5}}}, {{{2, 1, 1}, {6, 5, 5}}});
  ASSERT_EQ(both.size(), 1u);
  EXPECT_EQ(both[0].size(), 5 * 4 * 4);
  EXPECT_TRUE(both[0].contains(1, 1, 1) && both[0].contains(5, 4, 4));
}

TEST(Joined, KeepsBoxesThatAreFarApart) {
  EXPECT_EQ(joined({{{0, 0, 0}, {2, 2, 2}}}, {{{5, 3, 3}, {7, 5, 5}}}).size(), 2u);
  EXPECT_EQ(joined({{{0, 0, 0}, {2, 2, 2}}}, {}).size(), 1u);
}

}  // namespace
