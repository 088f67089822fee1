#include "dem/contact_history.hpp"

#include <gtest/gtest.h>

#include "dem/diagnostics.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

TEST(ContactHistory, CarriesTheForceOfARestingSphere) {
  Simulation simulation = testing::spheres({{0, 0, 0.5}}, 0.5);
  simulation.set_gravity({0, 0, -10});
  simulation.walls().add_plane({0, 0, 0}, {0, 0, 1});
  for (int k = 0; k < 2; ++k) simulation.step(0.01);
  const auto contacts = testing::on_host(simulation.solver().contacts(), 1);
  EXPECT_NEAR(contacts[0].carried_force, 10, 1e-9);
}

TEST(ContactHistory, OutlivesTheWayThroughAPeriodicFace) {
  Simulation simulation = testing::spheres({{3.9, 0, 0}, {2.9, 0, 0}}, 0.5);
  simulation.set_domain({0, 0, 0}, {4, 4, 4});
  simulation.set_periodic(true, true, true);
  simulation.particles().set_velocities(testing::flat({{1, 0, 0}, {1, 0, 0}}));
  simulation.particles().set_forces(testing::flat({{-10, 0, 0}, {10, 0, 0}}));
  for (int k = 0; k < 30; ++k) {
    simulation.step(0.01);
    if (k == 0) continue;
    const auto contacts = testing::on_host(simulation.solver().contacts(), 1);
    EXPECT_NEAR(contacts[0].carried_force, 10, 1e-6);
  }
  EXPECT_LT(testing::positions(simulation)[0].x, 1);
}

}  // namespace
}  // namespace peclet::dem
