#include "dem/contact_detection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dem/diagnostics.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

TEST(ContactDetection, ContactsBeginWithinTheMarginOfTheMeanRadius) {
  for (const Real gap : {-0.3, 0.0, 0.14, 0.16}) {
    Simulation simulation = testing::spheres({{0, 0, 0}, {3 + gap, 0, 0}}, 1);
    simulation.particles().set_scales(std::vector<Real>{1, 2});
    EXPECT_EQ(simulation.census().number_of_contacts, gap < 0.15);
    EXPECT_NEAR(simulation.census().largest_overlap, std::max(0.0, -gap), 1e-15);
  }
}

TEST(ContactDetection, SeesThroughPeriodicFacesAndCorners) {
  Simulation simulation = testing::spheres({{-0.2, 0.3, 9.9}, {9.8, 9.9, 0.4}, {5, 5, 5}}, 0.5);
  simulation.set_domain({0, 0, 0}, {10, 10, 10});
  simulation.set_periodic(true, true, true);
  const ContactCensus census = simulation.census();
  EXPECT_EQ(census.number_of_contacts, 1);
  EXPECT_NEAR(census.largest_overlap, 1 - std::sqrt(0.16 + 0.25), 1e-14);
}

TEST(ContactDetection, FastSpheresAreSeenFromAfar) {
  Simulation simulation = testing::spheres({{0, 0, 0}, {4, 0, 0}}, 1);
  simulation.particles().set_velocities(testing::flat({{1, 0, 0}, {-1.5, 0, 0}}));
  simulation.step(1);
  EXPECT_EQ(contact_records(simulation).size(), 1u);
}

TEST(ContactDetection, FixedParticlesDoNotTouchEachOtherNorWalls) {
  Simulation simulation = testing::spheres({{0, 0, 0}, {1, 0, 0}}, 1);
  simulation.particles().set_inverse_masses(std::vector<Real>{0, 0});
  simulation.walls().add_plane({0, 0, 0}, {0, 0, 1});
  EXPECT_EQ(simulation.census().number_of_contacts, 0);
}

}  // namespace
}  // namespace peclet::dem
