#include "flow/near_cells.hpp"

#include <gtest/gtest.h>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75
const SphereInTest crossing_the_edge{{5.6, 3.1, 6.9}, 1.9}, beside_it{{3.1, 5.3, 4.4}, 1.1};

/// 1 at every fluid face of component c whose stencil touches a wall.
std::vector<int> faces_at_walls(const ImmersedBoundary& boundary, int c) {
  const Field<int> found("found", Layout(grid.cells));
  const FaceVector<OpenFraction> open = boundary.open();
  const Field<Real> sdf = boundary.solid().sdf;
  const DomainSides sides;
  for_each_cell(
      "faces_at_walls", Box{{0, 0, 0}, grid.cells}, KOKKOS_LAMBDA(int i, int j, int k) {
        found(i, j, k) = is_fluid(open[c](i, j, k)) && touches_wall(open, sdf, sides, c, i, j, k);
      });
  return host_values(found);
}

void count_rows(const WallRows& rows, const Field<int>& count) {
  const WallRows w = rows;
  for_each(
      "count_rows", rows.count,
      KOKKOS_LAMBDA(Index row) { Kokkos::atomic_add(&count[w.face(row)], w.superseded(row) ? 0 : 1); });
}

std::vector<int> rows_in_force(const ImmersedBoundary& boundary, int c) {
  const Field<int> count("count", Layout(grid.cells));
  count_rows(boundary.fixed_rows(c), count);
  count_rows(boundary.moving_rows(c), count);
  return host_values(count);
}

void expect_one_row_per_face_at_a_wall(const ImmersedBoundary& boundary) {
  for (int c = 0; c < 3; ++c) EXPECT_EQ(rows_in_force(boundary, c), faces_at_walls(boundary, c)) << c;
}

TEST(NearCells, HoldEveryFaceThatTouchesAWall) {
  expect_one_row_per_face_at_a_wall(BoundaryInTest({crossing_the_edge, beside_it}).boundary);
  expect_one_row_per_face_at_a_wall(
      BoundaryInTest({moving(crossing_the_edge, {0.1, 0, 0}), beside_it}).boundary);
  expect_one_row_per_face_at_a_wall(
      BoundaryInTest({moving(crossing_the_edge, {0.1, 0, 0}), moving(beside_it, {0, 0.1, 0})}).boundary);
}

TEST(NearCells, FollowABodyPastAFixedOne) {
  BoundaryInTest moved({moving(crossing_the_edge, {0.1, 0, 0}), beside_it});
  const Field<Real> pressure("pressure", Layout(grid.cells));
  for (const Vec3 place : {Vec3{5.1, 3.6, 6.4}, Vec3{1.2, 7.9, 5.2}, Vec3{-0.4, 2.3, 1.1}}) {
    moved.bodies.set_pose(0, place, {});
    moved.boundary.update(moved.bodies, pressure, {0.1, 1e-2});
    expect_one_row_per_face_at_a_wall(moved.boundary);
  }
}

TEST(CellList, OfAGridHoldsItsCellsInOrder) {
  const CellList all = CellList::of_grid({3, 2, 2});
  ASSERT_EQ(all.count, 12);
  Index n = 0;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i, ++n) {
        const Int3 cell = all.cell(n);
        EXPECT_TRUE(cell[0] == i && cell[1] == j && cell[2] == k) << n;
      }
}

}  // namespace
