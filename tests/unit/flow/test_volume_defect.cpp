#include "flow/volume_defect.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "viscous_cases.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;
using namespace peclet::flow::testing;

/// Volume of the fluid as the points of component c and their defect have it.
Real fluid_volume(const Flow& flow, int c) {
  VolumeDefects defects;
  Real points = 0;
  for_fluid_points(flow, c,
                   [&](int i, int j, int k) { points += is_fluid(flow.boundary.open()[c](i, j, k)); });
  return points * flow.grid.cell_volume() + defects.find(flow.boundary, flow.sides, 0).back().volume[c];
}

TEST(VolumeDefect, SmoothStepIsExactForPlanes) {
  EXPECT_EQ(smooth_fluid_part(-2, 1), 0);
  EXPECT_EQ(smooth_fluid_part(2, 1), 1);
  for (const Real distance : {0.0, 0.1, 0.37, 0.5, 0.91}) {
    Real fluid = 0;
    for (int cell = -4; cell < 4; ++cell) fluid += smooth_fluid_part(cell + 0.5 + distance, 1);
    EXPECT_NEAR(fluid, 4 + distance, 1e-14);
  }
}

TEST(VolumeDefect, FluidAroundASphereHasItsVolume) {
  const Int3 n{14, 15, 13};
  const Real radius = 4.3, sphere = 4 * std::numbers::pi / 3 * radius * radius * radius;
  const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, radius));
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(static_cast<Real>(flow.grid.number_of_cells()) - fluid_volume(flow, c), sphere,
                1e-3 * sphere);
}

TEST(VolumeDefect, PlanesAlongTheGridAreExact) {
  const Int3 n{12, 9, 10};
  for (const Real low : {2.0, 2.25, 2.5, 2.81}) {
    const Flow flow(n, {0.5, 0.5, 0.5}, [low](Vec3 x) { return std::max(low - x.x, x.x - 7.0); });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fluid_volume(flow, c), (12 - 7.0 + low) * 9 * 10 * 0.125, 1e-11);
  }
}

TEST(VolumeDefect, NoSolidHasNone) {
  const Flow flow({6, 5, 4}, {1, 1, 1}, no_solid());
  VolumeDefects defects;
  for (int c = 0; c < 3; ++c) EXPECT_EQ(defects.find(flow.boundary, flow.sides, 0).back().volume[c], 0);
}

}  // namespace
