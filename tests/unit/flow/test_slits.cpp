#include "flow/slits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75
const SphereInTest crossing_the_edge{{5.6, 3.1, 6.9}, 1.9};
const Vec3 stream{0.3, -0.2, 0.1};

Index number_of_slits(const BoundaryInTest& flow) {
  return flow.boundary.slits(0).count + flow.boundary.slits(1).count + flow.boundary.slits(2).count;
}

/// Largest deviation of the predicted w from the mean of start * U and U that friction makes.
Real largest_difference(const Slits& slits, Real start) {
  const Slits s = slits;
  return max_each(
      "largest_difference", slits.count, KOKKOS_LAMBDA(Index n) {
        const Real share = s.friction(n) / (1 + s.friction(n));
        return Kokkos::abs(s.predicted(n) - (share + start * (1 - share)) * s.wall_velocity(n));
      });
}

TEST(Slits, AreOpenFacesWithASolidCentre) {
  const BoundaryInTest flow({moving(crossing_the_edge, stream)});
  const std::vector<Real> sdf = host_values(flow.boundary.solid().sdf);
  const Int3 n = grid.cells;
  for (int c = 0; c < 3; ++c) {
    const std::vector<OpenFraction> open = host_values(flow.boundary.open()[c]);
    Index slits = 0;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          int low[3] = {i, j, k};
          low[c] = (low[c] + n[c] - 1) % n[c];
          const auto at = [&](int x, int y, int z) {
            return static_cast<std::size_t>(x + n[0] * (y + n[1] * z));
          };
          const bool fluid = sdf[at(i, j, k)] + sdf[at(low[0], low[1], low[2])] >= 0;
          EXPECT_EQ(is_fluid(open[at(i, j, k)]), fluid);
          EXPECT_FALSE(fluid && is_slit(open[at(i, j, k)]));
          slits += is_slit(open[at(i, j, k)]);
        }
    EXPECT_GT(slits, 0);
    EXPECT_EQ(flow.boundary.slits(c).count, slits);
  }
}

TEST(Slits, TheClosedAreasAddUpToTheVolumeOfTheBody) {
  const BoundaryInTest flow({moving(crossing_the_edge, stream)}, {1e-9, 1});
  const Real exact = 4.0 / 3 * std::numbers::pi * std::pow(crossing_the_edge.radius, 3);
  for (int c = 0; c < 3; ++c) {
    Real closed = 0;
    for (const OpenFraction open : host_values(flow.boundary.open()[c]))
      closed += 1 - static_cast<Real>(open) * open_fraction_unit;
    EXPECT_NEAR(closed * grid.cell_volume(), exact, 0.05 * exact);  // five samples per face: second order
  }
}

TEST(Slits, FixedBodiesAndCreepingFlowsHaveNone) {
  EXPECT_EQ(number_of_slits(BoundaryInTest({crossing_the_edge})), 0);
  EXPECT_EQ(number_of_slits(BoundaryInTest({moving(crossing_the_edge, stream)}, {1e3, 1})), 0);
}

TEST(Slits, FrictionTakesTheFlowTowardsTheWallVelocity) {
  const BoundaryInTest flow({moving(crossing_the_edge, stream)}, {0.05, 1});
  const Slits slits = flow.boundary.slits(1);
  ASSERT_GT(slits.count, 0);
  const Field<Real> velocity("velocity", Layout(grid.cells)), residual("residual", Layout(grid.cells));
  predict_slits(slits, velocity, residual);
  EXPECT_NEAR(largest_difference(slits, 0), 0, 1e-15);
  impose_wall_velocity(slits, velocity);
  predict_slits(slits, velocity, residual);
  EXPECT_NEAR(largest_difference(slits, 1), 0, 1e-15);
}

}  // namespace
