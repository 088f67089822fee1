#include "dem/integrator.hpp"

#include <gtest/gtest.h>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

using testing::flat;
using testing::on_host;

TEST(Integrator, IsExactForConstantForceFarFromTheOrigin) {
  Simulation simulation = testing::spheres({{300, 300, 300}}, 1);
  simulation.particles().set_inverse_masses(std::vector<Real>{0.25});
  simulation.particles().set_forces(flat({{2, 0, -4}}));
  simulation.particles().set_velocities(flat({{0, 1, 0}}));
  for (int k = 0; k < 64; ++k) simulation.step(1.0 / 64);
  const Vec3 x = testing::positions(simulation)[0];
  EXPECT_NEAR(x.x, 300.25, 1e-12);
  EXPECT_NEAR(x.y, 301, 1e-12);
  EXPECT_NEAR(x.z, 299.5, 1e-12);
}

TEST(Integrator, AFixedBodyKeepsItsVelocity) {
  Simulation simulation = testing::spheres({{0, 0, 0}}, 1);
  simulation.particles().set_inverse_masses(std::vector<Real>{0});
  simulation.particles().set_velocities(flat({{0, 1, 0}}));
  simulation.set_gravity({0, 0, -10});
  simulation.step(0.5);
  EXPECT_EQ(testing::positions(simulation)[0].y, 0.5);
  EXPECT_EQ(testing::positions(simulation)[0].z, 0);
}

TEST(Integrator, AFreeTopKeepsItsAngularMomentumAndItsEnergyToSecondOrder) {
  const Vec3 inverse_inertia{1, 0.5, 2};
  const auto energy_drift = [&](int steps) {
    Simulation simulation = testing::spheres({{0, 0, 0}}, 1);
    simulation.particles().set_inverse_inertias(flat({inverse_inertia}));
    simulation.particles().set_angular_velocities(flat({{1, 0.1, 3}}));
    for (int k = 0; k < steps; ++k) simulation.step(2.0 / steps);
    const Vec3 spin = on_host(simulation.particles().arrays().angular_velocity, 1)[0];
    const Quaternion q = on_host(simulation.particles().arrays().orientation, 1)[0];
    const Vec3 local = rotate_back(q, spin);
    const Vec3 momentum =
        rotate(q, {local.x / inverse_inertia.x, local.y / inverse_inertia.y, local.z / inverse_inertia.z});
    EXPECT_NEAR(momentum.x, 1, 1e-13);
    EXPECT_NEAR(momentum.y, 0.2, 1e-13);
    EXPECT_NEAR(momentum.z, 1.5, 1e-13);
    return std::abs(dot(spin, momentum) - (1 + 0.02 + 4.5));
  };
  const Real coarse = energy_drift(50), fine = energy_drift(100);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_GT(coarse / fine, 3.5);  // second order: 4
}

TEST(Integrator, AConstantTorqueTurnsASphereByHalfItsAngularAccelerationTimesTimeSquared) {
  Simulation simulation = testing::spheres({{0, 0, 0}}, 1);
  simulation.particles().set_torques(flat({{0, 0, 0.4}}));  // angular acceleration 1
  for (int k = 0; k < 10; ++k) simulation.step(0.1);
  const Quaternion q = on_host(simulation.particles().arrays().orientation, 1)[0];
  EXPECT_NEAR(2 * std::atan2(q.z, q.w), 0.5, 1e-14);
}

TEST(Integrator, PositionsWrapIntoTheBox) {
  Simulation simulation = testing::spheres({{9.9, 0, 0}}, 0.1);
  simulation.set_domain({0, 0, 0}, {10, 10, 10});
  simulation.set_periodic(true, false, true);
  simulation.particles().set_velocities(flat({{1, -1, -1}}));
  simulation.step(0.5);
  const Vec3 x = testing::positions(simulation)[0];
  EXPECT_NEAR(x.x, 0.4, 1e-14);
  EXPECT_EQ(x.y, -0.5);
  EXPECT_EQ(x.z, 9.5);
}

}  // namespace
}  // namespace peclet::dem
