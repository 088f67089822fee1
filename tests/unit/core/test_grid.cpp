#include "core/grid.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace peclet;

const Grid grid{{5, 3, 4}, {0.5, 0.25, 2.0}, {1, -2, 3}};

TEST(Grid, CentersLieHalfwayBetweenCornersOfACell) {
  const Vec3 middle = 0.5 * (grid.corner(2, 1, 3) + grid.corner(3, 2, 4));
  const Vec3 center = grid.cell_center(2, 1, 3);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(center[a], middle[a], 1e-15);
}

TEST(Grid, LowFaceLiesHalfwayBetweenTwoCenters) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 face = grid.face_center(axis, 2, 1, 3);
    const Vec3 low = grid.cell_center(2 - (axis == 0), 1 - (axis == 1), 3 - (axis == 2));
    const Vec3 middle = 0.5 * (low + grid.cell_center(2, 1, 3));
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(face[a], middle[a], 1e-15);
  }
}

TEST(Grid, CellsFillTheBox) {
  EXPECT_NEAR(grid.cell_volume() * static_cast<Real>(grid.number_of_cells()),
              grid.extent(0) * grid.extent(1) * grid.extent(2), 1e-14);
}

TEST(Layout, EveryCellAndGhostHasAnIndexOfItsOwn) {
  const Layout layout(grid.cells);
  std::set<Index> seen;
  constexpr int g = Layout::ghost_width;
  for (int k = -g; k < grid.cells[2] + g; ++k)
    for (int j = -g; j < grid.cells[1] + g; ++j)
      for (int i = -g; i < grid.cells[0] + g; ++i) {
        const Index n = layout(i, j, k);
        EXPECT_GE(n, 0);
        EXPECT_LT(n, layout.size);
        EXPECT_TRUE(seen.insert(n).second);
      }
}

TEST(Layout, RowsStartOnTheAlignment) {
  const Layout layout(grid.cells);
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j) EXPECT_EQ(layout(0, j, k) % Layout::alignment, 0);
}

TEST(Layout, StridesLeadToTheNextCell) {
  const Layout layout(grid.cells);
  EXPECT_EQ(layout(1, 1, 1) + layout.stride(0), layout(2, 1, 1));
  EXPECT_EQ(layout(1, 1, 1) + layout.stride(1), layout(1, 2, 1));
  EXPECT_EQ(layout(1, 1, 1) + layout.stride(2), layout(1, 1, 2));
}

}  // namespace
