#include "dem/hertz.hpp"

#include <gtest/gtest.h>

#include "core/field_transfer.hpp"

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

std::vector<Body> two_bodies() {
  std::vector<Body> bodies(2);
  for (std::size_t n = 0; n < 2; ++n) {
    bodies[n].inverse_mass = 1.0 / static_cast<Real>(1 + n);
    bodies[n].inverse_inertia = {2, 2, 2};
  }
  return bodies;
}

/// hertz_load where kernels run.
SoftLoad load_of(const Contact& c, const std::vector<Body>& pair, const SoftMotion& motion, Vec3 n,
                 ContactSpring& spring) {
  const Bodies bodies = copy_from_host("bodies", pair);
  const Array<ContactSpring> springs = copy_from_host("springs", &spring, 1);
  const Array<SoftLoad> loads("loads", 1);
  const ElasticPair elastic(steel, steel);
  for_each(
      "hertz_load", 1,
      KOKKOS_LAMBDA(Index k) { loads(k) = hertz_load(c, elastic, bodies, motion, n, springs(k)); });
  spring = copy_to_host(springs)[0];
  return copy_to_host(loads)[0];
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
  const std::vector<Body> bodies = two_bodies();
  ContactSpring spring;
  const Real one = load_of(c, bodies, pressed_by(c, 1e-5), {1, 0, 0}, spring).force.x;
  const Real four = load_of(c, bodies, pressed_by(c, 4e-5), {1, 0, 0}, spring).force.x;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(four / one, 8, 1e-6);
}

TEST(Hertz, OpenContactsCarryNothingAndForget) {
  const Contact c = pair_of(0.5, 0.25);
  ContactSpring spring{1, {1, 0, 0}, {0, 1, 0}, {}};
  const SoftLoad load = load_of(c, two_bodies(), pressed_by(c, -1e-6), {1, 0, 0}, spring);
  EXPECT_EQ(norm(load.force), 0);
  EXPECT_EQ(spring.circle, 0);
  EXPECT_EQ(norm(spring.force), 0);
}

TEST(Hertz, ADashpotNeverPulls) {
  Contact c = pair_of(0.5, 0.25);
  c.material.damping_ratio = 0.5;
  ContactSpring spring;
  const SoftLoad load = load_of(c, two_bodies(), pressed_by(c, 1e-9, {1000, 0, 0}), {1, 0, 0}, spring);
  EXPECT_EQ(load.force.x, 0);
}

TEST(Hertz, FrictionAndRollingMomentStayWithinTheirLimits) {
  const Contact c = pair_of(0.5, 0.25);
  std::vector<Body> bodies = two_bodies();
  bodies[0].angular_velocity = {0, 1e6, 1e6};
  ContactSpring spring;
  const SoftLoad load = load_of(c, bodies, pressed_by(c, 1e-5, {0, 1e6, 0}), {1, 0, 0}, spring);
  EXPECT_NEAR(norm(Vec3{0, load.force.y, load.force.z}), 0.2 * load.force.x, 1e-9 * load.force.x);
  EXPECT_NEAR(norm(spring.moment), 0.1 * c.effective_radius() * load.force.x, 1e-9 * load.force.x);
}

TEST(Hertz, LoadsOfAPairKeepItsAngularMomentum) {
  Contact c = pair_of(0.5, 0.25);
  c.material.damping_ratio = 0.1;
  std::vector<Body> bodies = two_bodies();
  bodies[0].angular_velocity = {3, 5, 7};
  const SoftMotion motion{{0.6, 0.3, -0.2}, {-1, 2, 3}, {0, 0, -10}, 1e-9};
  const Vec3 n = normalized(motion.distance);
  ContactSpring spring;
  const SoftLoad load = load_of(c, bodies, motion, n, spring);
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
