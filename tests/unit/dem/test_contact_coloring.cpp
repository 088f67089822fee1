#include "dem/contact_coloring.hpp"

#include <gtest/gtest.h>

#include "dem/diagnostics.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

Simulation dense_cube(int per_side) {
  std::vector<Vec3> x;
  for (int k = 0; k < per_side * per_side * per_side; ++k)
    x.push_back({1.0 * (k % per_side), 1.0 * (k / per_side % per_side), 1.0 * (k / per_side / per_side)});
  return testing::spheres(x, 0.5);
}

TEST(ContactColoring, NoTwoContactsOfAColorShareAParticle) {
  Simulation simulation = dense_cube(6);
  simulation.step(0.01);
  EXPECT_EQ(contact_records(simulation).size(), 3u * 5 * 36);
  EXPECT_EQ(coloring_conflicts(simulation), std::make_pair(Index{0}, Index{0}));
}

TEST(ContactColoring, AParticleWithMoreContactsThanColorsIsServedInTurn) {
  // small spheres all over a large one
  std::vector<Vec3> x{{0, 0, 0}};
  std::vector<Real> scale{1};
  const int count = 20000;
  for (const Vec3& v : testing::random_vectors(count, {-1, -1, -1}, {1, 1, 1}, 3)) {
    x.push_back(1.001 * normalized(v));
    scale.push_back(0.001);
  }
  Simulation simulation = testing::spheres(x, 1);
  simulation.particles().set_scales(scale);
  simulation.step(0.01);
  const auto [conflicts, uncolored] = coloring_conflicts(simulation);
  EXPECT_EQ(conflicts, 0);
  EXPECT_GE(uncolored, count - ContactOrder::maximum_colors);
}

TEST(ContactColoring, AFixedParticleNeedsNoColorsOfItsOwn) {
  std::vector<Vec3> x{{0, 0, 0}};
  for (const Vec3& v : testing::random_vectors(120, {-1, -1, -1}, {1, 1, 1}, 3))
    x.push_back(1.01 * normalized(v));
  std::vector<Real> scale(x.size(), 1e-3), inverse_mass(x.size(), 1);
  scale[0] = 1;
  inverse_mass[0] = 0;
  Simulation simulation = testing::spheres(x, 1);
  simulation.particles().set_scales(scale);
  simulation.particles().set_inverse_masses(inverse_mass);
  simulation.step(0.01);
  for (const ContactRecord& record : contact_records(simulation)) {
    const bool is_at_fixed = record.a == 0 || record.b == 0;
    EXPECT_TRUE(!is_at_fixed || record.color >= 0);
  }
}

}  // namespace
}  // namespace peclet::dem
