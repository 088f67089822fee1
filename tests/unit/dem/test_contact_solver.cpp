#include "dem/contact_solver.hpp"

#include <gtest/gtest.h>

#include "dem/diagnostics.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

TEST(ContactSolver, AStackOfSpheresWeighsWhatItsSpheresWeigh) {
  std::vector<Vec3> x;
  for (int k = 0; k < 10; ++k) x.push_back({0, 0, 0.5 + k});
  Simulation simulation = testing::spheres(x, 0.5);
  simulation.set_gravity({0, 0, -10});
  simulation.walls().add_plane({0, 0, 0}, {0, 0, 1});
  for (int k = 0; k < 100; ++k) simulation.step(0.01);
  Vec3 on_wall;
  for (const ContactRecord& record : contact_records(simulation))
    if (record.b < 0) on_wall += record.impulse;
  EXPECT_NEAR(on_wall.z / 0.01, 100, 1e-3 * 100);
  EXPECT_LT(simulation.census().largest_overlap, 1e-4);
}

TEST(ContactSolver, ManyCollisionsKeepMomentumAndElasticOnesEnergy) {
  const int per_side = 5;
  std::vector<Vec3> x;
  for (int k = 0; k < per_side * per_side * per_side; ++k)
    x.push_back({1.2 * (k % per_side), 1.2 * (k / per_side % per_side), 1.2 * (k / per_side / per_side)});
  Simulation simulation = testing::spheres(x, 0.5);
  simulation.set_domain({0, 0, 0}, {6, 6, 6});
  simulation.set_periodic(true, true, true);
  simulation.materials().set_default({1, 0, 0});
  simulation.particles().set_velocities(
      testing::flat(testing::random_vectors(per_side * per_side * per_side, {-1, -1, -1}, {1, 1, 1}, 7)));
  const auto totals = [&] {
    Real energy = 0;
    Vec3 momentum;
    for (const Vec3& v : testing::velocities(simulation)) {
      energy += dot(v, v);
      momentum += v;
    }
    return std::make_pair(energy, momentum);
  };
  const auto [energy, momentum] = totals();
  for (int k = 0; k < 100; ++k) simulation.step(0.02);
  const auto [new_energy, new_momentum] = totals();
  EXPECT_NEAR(new_energy, energy, 1e-12 * energy);  // some hundred impacts, each exact to rounding
  EXPECT_LT(norm(new_momentum - momentum), 1e-12);
  EXPECT_LT(simulation.census().largest_overlap, 1e-6);
}

TEST(ContactSolver, ForgetsWhatItCarried) {
  Simulation simulation = testing::spheres({{0, 0, 0.5}}, 0.5);
  simulation.set_gravity({0, 0, -10});
  simulation.walls().add_plane({0, 0, 0}, {0, 0, 1});
  simulation.step(0.01);
  simulation.set_gravity({0, 0, 0});
  simulation.forget_contacts();
  simulation.step(0.01);
  EXPECT_EQ(contact_records(simulation)[0].impulse.z, 0);
}

}  // namespace
}  // namespace peclet::dem
