#include "dem/soft_contacts.hpp"

#include <gtest/gtest.h>

#include "dem/diagnostics.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

Simulation elastic_lattice(int per_side, Real spacing) {
  std::vector<Vec3> x;
  for (int k = 0; k < per_side * per_side * per_side; ++k)
    x.push_back(
        {spacing * (k % per_side), spacing * (k / per_side % per_side), spacing * (k / per_side / per_side)});
  Simulation simulation = testing::spheres(x, 0.5);
  simulation.materials().set_elastic(0, {1e6, 0.3});
  return simulation;
}

TEST(SoftContacts, AreTheTouchingPairsEachOnce) {
  Simulation simulation = elastic_lattice(4, 0.99);
  simulation.step_hertz(1e-4, 1, 0.3);
  EXPECT_EQ(contact_records(simulation).size(), 3u * 4 * 4 * 3);
  for (const ContactRecord& record : contact_records(simulation)) EXPECT_NEAR(record.gap, -0.01, 1e-6);
}

TEST(SoftContacts, AnIsotropicHeapPushesApartSymmetrically) {
  Simulation simulation = elastic_lattice(3, 0.98);
  simulation.step_hertz(1e-4, 50, 0.3);
  const std::vector<Vec3> v = testing::velocities(simulation);
  for (std::size_t n = 0; n < v.size(); ++n) EXPECT_LT(norm(v[n] + v[v.size() - 1 - n]), 1e-10);
  EXPECT_GT(norm(v[0]), 0.01);
  EXPECT_LT(norm(v[13]), 1e-10);
}

TEST(SoftContacts, KeepTheirListWhileParticlesStayWithinTheSkin) {
  Simulation simulation = elastic_lattice(3, 1.0);
  simulation.particles().set_velocities(testing::flat(std::vector<Vec3>(27, Vec3{1, 0, 0})));
  simulation.step_hertz(1e-4, 1, 0.5);
  const auto* first = simulation.soft_contacts()->keys.keys.data();
  simulation.step_hertz(1e-4, 1000, 0.5);  // 0.1 of the 0.125 that half the skin allows
  EXPECT_EQ(simulation.soft_contacts()->keys.keys.data(), first);
  simulation.step_hertz(1e-4, 500, 0.5);
  EXPECT_NE(simulation.soft_contacts()->keys.keys.data(), first);
}

TEST(SoftContacts, TimeScalesFollowSizeAndStiffness) {
  const auto scales = [](Real radius, Real young, Real speed) {
    Simulation simulation = testing::spheres({{0, 0, 0}}, radius);
    simulation.materials().set_elastic(0, {young, 0.3});
    const Real inverse_mass = 1 / (radius * radius * radius);
    simulation.particles().set_inverse_masses({&inverse_mass, 1});
    simulation.particles().set_velocities(testing::flat({{speed, 0, 0}}));
    return simulation.soft_time_scales();
  };
  const SoftTimeScales one = scales(1, 1e6, 1);
  EXPECT_NEAR(scales(2, 1e6, 1).rayleigh / one.rayleigh, 2, 1e-12);
  EXPECT_NEAR(scales(1, 4e6, 1).rayleigh / one.rayleigh, 0.5, 1e-12);
  EXPECT_NEAR(scales(1, 1e6, 32).impact / one.impact, 0.5, 1e-12);
  EXPECT_NEAR(scales(2, 1e6, 1).impact / one.impact, 2, 1e-12);
}

TEST(SoftContacts, NeedElasticConstants) {
  Simulation simulation = testing::spheres({{0, 0, 0}}, 0.5);
  EXPECT_THROW(simulation.step_hertz(1e-3, 1, 0.3), std::runtime_error);
  simulation.materials().set_elastic(0, {1e6, 0.3});
  EXPECT_NO_THROW(simulation.step_hertz(1e-3, 1, 0.3));
  const int id = 2;
  simulation.particles().set_materials({&id, 1});
  simulation.materials().include(2);
  EXPECT_THROW(simulation.step_hertz(1e-3, 1, 0.3), std::runtime_error);
}

}  // namespace
}  // namespace peclet::dem
