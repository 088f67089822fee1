#include "dem/diagnostics.hpp"

#include <gtest/gtest.h>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

TEST(Diagnostics, ContactRecordsNameBodiesNormalsAndImpulses) {
  Simulation simulation = testing::spheres({{0, 0, 0.5}, {0, 0, 3}}, 0.5);
  simulation.walls().add_plane({7, 7, 0}, {0, 0, 2});
  simulation.set_gravity({0, 0, -10});
  simulation.step(0.01);
  const auto records = contact_records(simulation);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].a, 0);
  EXPECT_EQ(records[0].b, -1);
  EXPECT_EQ(records[0].normal.z, 1);
  EXPECT_NEAR(records[0].impulse.z, 0.1, 1e-15);
  EXPECT_EQ(records[0].gap, 0);
}

}  // namespace
}  // namespace peclet::dem
