#include "dem/simulation.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

TEST(Simulation, RelaxSharesTheOverlapByInverseMass) {
  Simulation simulation = testing::spheres({{0, 0, 0}, {0.6, 0, 0}}, 0.5);
  simulation.particles().set_inverse_masses(std::vector<Real>{1, 3});
  simulation.relax(1);
  EXPECT_NEAR(testing::positions(simulation)[0].x, -0.1, 1e-15);
  EXPECT_NEAR(testing::positions(simulation)[1].x, 0.9, 1e-15);
  EXPECT_EQ(simulation.time(), 0);
}

TEST(Simulation, ConcentricSpheresPartAlongX) {
  Simulation simulation = testing::spheres({{0, 0, 0}, {0, 0, 0}}, 0.5);
  simulation.relax(1);
  EXPECT_EQ(testing::positions(simulation)[0].x, -0.5);
  EXPECT_EQ(testing::positions(simulation)[1].x, 0.5);
}

TEST(Simulation, AStepThatLeavesTheNumbersLeavesTheStateAlone) {
  Simulation simulation = testing::spheres({{1, 2, 3}}, 0.5);
  simulation.particles().set_velocities(testing::flat({{1e300, 0, 0}}));
  EXPECT_THROW(simulation.step(1e300), std::runtime_error);
  EXPECT_EQ(testing::positions(simulation)[0].x, 1);
  EXPECT_EQ(simulation.time(), 0);
}

TEST(Simulation, RefusesWhatMakesNoSense) {
  Simulation simulation = testing::spheres({{1, 2, 3}}, 0.5);
  EXPECT_THROW(simulation.step(0), std::invalid_argument);
  EXPECT_THROW(simulation.step(std::numeric_limits<Real>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(simulation.relax(-1), std::invalid_argument);
  EXPECT_THROW(simulation.set_domain({0, 0, 0}, {-1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(simulation.set_iterations({-1, 1}), std::invalid_argument);
  simulation.set_periodic(true, false, false);
  EXPECT_THROW(simulation.step(0.1), std::runtime_error);
  simulation.set_domain({0, 0, 0}, {0.9, 1, 1});  // narrower than a sphere
  EXPECT_THROW(simulation.step(0.1), std::runtime_error);
}

TEST(Simulation, WithoutParticlesDoesNothing) {
  Simulation simulation(3);
  simulation.step(0.1);
  simulation.relax(2);
  EXPECT_EQ(simulation.census().number_of_contacts, 0);
}

}  // namespace
}  // namespace peclet::dem
