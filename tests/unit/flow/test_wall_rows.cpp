#include "flow/wall_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75

/// Distance from the centre of every wall point that a row of component c sees.
std::vector<Real> wall_radii(const WallRows& rows, int c, Vec3 center) {
  const Array<Real> radii("radii", static_cast<std::size_t>(rows.count * WallRows::directions));
  const Layout layout(grid.cells);
  const Grid box = grid;
  const WallRows w = rows;
  for_each(
      "wall_radii", rows.count, KOKKOS_LAMBDA(Index row) {
        const Int3 cell = cell_of(layout, w.face(row));
        for (int d = 0; d < WallRows::directions; ++d) {
          Vec3 x = box.face_center(c, cell[0], cell[1], cell[2]);
          x[d / 2] += (d % 2 ? 1 : -1) * box.spacing[d / 2] * w.distance(row, d);
          const bool counts = w.is_wall(row, d) && w.distance(row, d) > 1.01 * smallest_wall_distance;
          radii(row * WallRows::directions + d) = counts ? norm(x - center) : 0;
        }
      });
  return copy_to_host(radii);
}

TEST(WallRows, SeeTheWallWhereItIs) {
  const Vec3 center{2.6, 5.2, 3.6};
  const BoundaryInTest fixed({{center, 1.9}});
  for (int c = 0; c < 3; ++c) {
    int walls = 0;
    for (const Real radius : wall_radii(fixed.boundary.fixed_rows(c), c, center)) {
      if (radius == 0) continue;
      ++walls;
      EXPECT_NEAR(radius, 1.9, 1e-5);  // weights are kept in single precision
    }
    EXPECT_GT(walls, 50);
  }
}

/// For every row: sum over directions of weight (q(x_d) - q(x)) for q = r . r in spacings, which is 2 per
/// axis.
std::vector<Real> second_derivatives(const WallRows& rows) {
  const Array<Real> sums("sums", static_cast<std::size_t>(rows.count));
  const WallRows w = rows;
  for_each(
      "second_derivatives", rows.count, KOKKOS_LAMBDA(Index row) {
        for (int d = 0; d < WallRows::directions; ++d) {
          const Real step = Kokkos::fmax(static_cast<Real>(w.distance(row, d)), smallest_wall_distance);
          sums(row) += w.weight(row, d) * step * step;
        }
      });
  return copy_to_host(sums);
}

TEST(WallRows, AreExactForQuadraticProfiles) {
  const BoundaryInTest fixed({{{2.6, 5.2, 3.6}, 1.9}});
  for (int c = 0; c < 3; ++c)
    for (const Real sum : second_derivatives(fixed.boundary.fixed_rows(c))) EXPECT_NEAR(sum, 6, 1e-4);
}

/// Largest magnitude of the viscous term of a row of component c in a uniform stream.
Real largest_term(const WallRows& rows, Real speed) {
  const WallRows w = rows;
  const Grid box = grid;
  return max_each(
      "largest_term", rows.count, KOKKOS_LAMBDA(Index row) {
        Real sum = w.wall_sum(row);
        for (int d = 0; d < WallRows::directions; ++d)
          if (w.is_wall(row, d)) sum -= w.weight(row, d) * speed / (box.spacing[d / 2] * box.spacing[d / 2]);
        return Kokkos::abs(sum);
      });
}

TEST(WallRows, AStreamThatMovesWithTheBodyHasNoFriction) {
  const Vec3 velocity{0.3, -0.2, 0.1};
  const BoundaryInTest moves({moving({{2.6, 5.2, 3.6}, 1.9}, velocity)});
  // weights reach 2 / 0.01^2 at the smallest wall distance
  for (int c = 0; c < 3; ++c) EXPECT_LT(largest_term(moves.boundary.moving_rows(c), velocity[c]), 1e-10);
}

/// Largest weight of a row, at the smallest distance to a wall.
Real largest_weight(const WallRows& rows) {
  const WallRows w = rows;
  return max_each(
      "largest_weight", rows.count, KOKKOS_LAMBDA(Index row) {
        Real largest = 0;
        for (int d = 0; d < WallRows::directions; ++d)
          largest = Kokkos::fmax(largest, static_cast<Real>(w.weight(row, d)));
        return largest;
      });
}

Real largest_weight(Vec3 velocity, Vec3 spin, Real viscosity) {
  const BoundaryInTest flow({moving({{2.6, 5.2, 3.6}, 1.9}, velocity, spin)}, {viscosity, 1e-2});
  Real largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, largest_weight(flow.boundary.moving_rows(c)));
  return largest;
}

TEST(WallRows, AreBoundedMoreWhereAWallArrivesBeforeFrictionActs) {
  const Real creeping = largest_weight({1e-9, 0, 0}, {}, 1);
  EXPECT_GT(creeping, 10 / smallest_sliding_distance);  // some points are close to the wall
  Real weight = creeping;
  for (const Real viscosity : {1.0, 0.1, 0.01}) {
    const Real smaller = largest_weight({0.5, 0.3, 0.4}, {}, viscosity);
    EXPECT_LT(smaller, weight);
    weight = smaller;
  }
  // a sphere that spins covers no points
  EXPECT_GT(largest_weight({}, {0, 0, 5}, 10), 0.5 * creeping);
  EXPECT_LT(largest_weight({5 * 1.9, 0, 0}, {}, 10), 0.5 * creeping);
  EXPECT_LE(largest_weight({5, 3, 4}, {}, 1e-6), 2.2 / smallest_sliding_distance);
}

/// Largest weight of the rows of component c near the axis through center along x.
Real largest_weight_ahead(const WallRows& rows, int c, Vec3 center) {
  const WallRows w = rows;
  const Layout layout(grid.cells);
  const Grid box = grid;
  return max_each(
      "largest_weight_ahead", rows.count, KOKKOS_LAMBDA(Index row) {
        const Int3 cell = cell_of(layout, w.face(row));
        const Vec3 arm = box.face_center(c, cell[0], cell[1], cell[2]) - center;
        Real largest = 0;
        for (int d = 0; d < 2; ++d)
          if (arm.y * arm.y + arm.z * arm.z < 0.5 * 0.5 && w.is_wall(row, d))
            largest = Kokkos::fmax(largest, static_cast<Real>(w.weight(row, d)));
        return largest;
      });
}

TEST(WallRows, AreBoundedMoreAlongTheNormalOfAWallThatApproaches) {
  Real across = 0;
  for (int n = 0; n < 8; ++n) {
    const Vec3 center{2.6 + 0.07 * n, 5.2, 3.6};
    const BoundaryInTest flow({moving({center, 1.9}, {5, 0, 0})}, {1e-6, 1e-2});
    const Real along = largest_weight_ahead(flow.boundary.moving_rows(0), 0, center);
    EXPECT_GT(along, 0);
    EXPECT_LT(along, 1.1 * 2 / (smallest_approach_distance * (1 + smallest_approach_distance)));
    across = std::max(across, largest_weight_ahead(flow.boundary.moving_rows(1), 1, center));
  }
  EXPECT_GT(across, 1 / smallest_sliding_distance);
}

}  // namespace
