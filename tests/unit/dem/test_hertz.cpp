#include "dem/hertz.hpp"

#include <gtest/gtest.h>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

constexpr ElasticMaterial steel{2e11, 0.3};

Contact pair_of(Real radius_a, Real radius_b) {
  Contact c;
  c.a = 0;
  c.b = 1;
  c.reach = radius_a + radius_b;
  c.share = radius_a / c.reach;
  c.material = {1, 0, 0.2, 0.1, 0};
  return c;
}

Bodies two_bodies() {
  Bodies bodies("bodies", 2);
  for (int n = 0; n < 2; ++n) {
    bodies(n).inverse_mass = 1.0 / (1 + n);
    bodies(n).inverse_inertia = {2, 2, 2};
  }
  return bodies;
}

SoftMotion pressed_by(const Contact& c, Real overlap, Vec3 velocity = {}) {
  return {{c.reach - overlap, 0, 0}, velocity, {}, 1e-9};
}

TEST(Hertz, APairIsSofterThanASphereOnARigidWall) {
  const ElasticPair equal(steel, steel), hard_wall(steel, {1e30, 0.3});
  EXPECT_NEAR(hard_wall.young, 2 * equal.young, 1e-9 * equal.young);
  EXPECT_NEAR(hard_wall.shear, 2 * equal.shear, 1e-9 * equal.shear);
  EXPECT_NEAR(equal.young, 2e11 / (2 * (1 - 0.09)), 1);
}

TEST(Hertz, ForceGrowsWithThePowerThreeHalvesOfTheOverlap) {
  const Contact c = pair_of(0.5, 0.25);
  const Bodies bodies = two_bodies();
  const ElasticPair elastic(steel, steel);
  ContactSpring spring;
  const Real one = hertz_load(c, elastic, bodies, pressed_by(c, 1e-5), {1, 0, 0}, spring).force.x;
  const Real four = hertz_load(c, elastic, bodies, pressed_by(c, 4e-5), {1, 0, 0}, spring).force.x;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(four / one, 8, 1e-6);
}

TEST(Hertz, OpenContactsCarryNothingAndForget) {
  const Contact c = pair_of(0.5, 0.25);
  ContactSpring spring{1, {1, 0, 0}, {0, 1, 0}, {}};
  const SoftLoad load =
      hertz_load(c, ElasticPair(steel, steel), two_bodies(), pressed_by(c, -1e-6), {1, 0, 0}, spring);
  EXPECT_EQ(norm(load.force), 0);
  EXPECT_EQ(spring.circle, 0);
  EXPECT_EQ(norm(spring.force), 0);
}

TEST(Hertz, ADashpotNeverPulls) {
  Contact c = pair_of(0.5, 0.25);
  c.material.damping_ratio = 0.5;
  ContactSpring spring;
  const SoftLoad load = hertz_load(c, ElasticPair(steel, steel), two_bodies(),
                                   pressed_by(c, 1e-9, {1000, 0, 0}), {1, 0, 0}, spring);
  EXPECT_EQ(load.force.x, 0);
}

TEST(Hertz, FrictionAndRollingMomentStayWithinTheirLimits) {
  const Contact c = pair_of(0.5, 0.25);
  const Bodies bodies = two_bodies();
  bodies(0).angular_velocity = {0, 1e6, 1e6};
  ContactSpring spring;
  const SoftLoad load =
      hertz_load(c, ElasticPair(steel, steel), bodies, pressed_by(c, 1e-5, {0, 1e6, 0}), {1, 0, 0}, spring);
  EXPECT_NEAR(norm(Vec3{0, load.force.y, load.force.z}), 0.2 * load.force.x, 1e-9 * load.force.x);
  EXPECT_NEAR(norm(spring.moment), 0.1 * c.effective_radius() * load.force.x, 1e-9 * load.force.x);
}

TEST(Hertz, LoadsOfAPairKeepItsAngularMomentum) {
  Contact c = pair_of(0.5, 0.25);
  c.material.damping_ratio = 0.1;
  const Bodies bodies = two_bodies();
  bodies(0).angular_velocity = {3, 5, 7};
  const SoftMotion motion{{0.6, 0.3, -0.2}, {-1, 2, 3}, {0, 0, -10}, 1e-9};
  const Vec3 n = normalized(motion.distance);
  ContactSpring spring;
  const SoftLoad load = hertz_load(c, ElasticPair(steel, steel), bodies, motion, n, spring);
  const Vec3 total = cross(motion.distance, load.force) + load.moment_on_a + load.moment_on_b;
  EXPECT_LT(norm(total), 1e-12 * norm(load.force));
  EXPECT_GT(norm(load.moment_on_a), 0);
}

TEST(Hertz, SpringsTurnWithTheNormalAndSlackenWithTheCircle) {
  ContactSpring spring{2, {1, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  const Vec3 n = normalized(Vec3{1, 1, 0});
  carry_spring(spring, n, 4);
  EXPECT_NEAR(dot(spring.force, n), 0, 1e-15);
  EXPECT_NEAR(norm(spring.force), 3, 1e-15);
  carry_spring(spring, n, 1);
  EXPECT_NEAR(norm(spring.force), 0.75, 1e-15);
  EXPECT_NEAR(norm(spring.moment), 1, 1e-15);
}

}  // namespace
}  // namespace peclet::dem
