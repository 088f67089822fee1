#include "dem/particles.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

using testing::flat;
using testing::on_host;

Particles two_spheres() {
  Particles particles(1);
  particles.set_shape_radius(2);
  particles.set_positions(flat({{1, 2, 3}, {4, 5, 6}}), 3);
  return particles;
}

TEST(Particles, GrowBeyondTheirCapacity) {
  const Particles particles = two_spheres();
  EXPECT_EQ(particles.count(), 2);
  EXPECT_GE(particles.capacity(), 2);
  EXPECT_EQ(on_host(particles.arrays().position, 2)[1].z, 6);
}

TEST(Particles, HaveTheInertiaOfSolidSpheresUntilToldOtherwise) {
  Particles particles = two_spheres();
  EXPECT_DOUBLE_EQ(on_host(particles.arrays().inverse_inertia, 2)[0].x, 2.5 / 4);
  particles.set_inverse_masses(std::vector<Real>{2, 0});
  EXPECT_DOUBLE_EQ(on_host(particles.arrays().inverse_inertia, 2)[0].y, 5.0 / 4);
  EXPECT_EQ(on_host(particles.arrays().inverse_inertia, 2)[1].y, 0);
  particles.set_inverse_inertias(flat({{1, 2, 3}, {1, 2, 3}}));
  particles.set_inverse_masses(std::vector<Real>{1, 1});
  EXPECT_EQ(on_host(particles.arrays().inverse_inertia, 2)[1].z, 3);
}

TEST(Particles, ForgetTheirMotionWithNewPositionsButKeepTheirLoads) {
  Particles particles = two_spheres();
  particles.set_velocities(flat({{1, 1, 1}, {1, 1, 1}}));
  particles.set_forces(flat({{7, 0, 0}, {0, 0, 0}}));
  particles.set_positions(flat({{0, 0, 0}, {9, 9, 9}}), 3);
  EXPECT_EQ(on_host(particles.arrays().velocity, 2)[0].x, 0);
  EXPECT_EQ(on_host(particles.arrays().force, 2)[0].x, 7);
  particles.set_positions(flat({{0, 0, 0}}), 3);
  EXPECT_EQ(on_host(particles.arrays().force, 1)[0].x, 0);
}

TEST(Particles, RefuseWhatMakesNoSenseAndStayAsTheyWere) {
  Particles particles = two_spheres();
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_THROW(particles.set_positions(flat({{0, nan, 0}}), 3), std::invalid_argument);
  EXPECT_THROW(particles.set_velocities(flat({{0, 0, 0}})), std::invalid_argument);
  EXPECT_THROW(particles.set_inverse_masses(std::vector<Real>{1, -1}), std::invalid_argument);
  EXPECT_THROW(particles.set_scales(std::vector<Real>{1, 0}), std::invalid_argument);
  EXPECT_THROW(particles.set_orientations(std::vector<Real>(8, 0)), std::invalid_argument);
  EXPECT_THROW(particles.set_shape_radius(0), std::invalid_argument);
  EXPECT_EQ(particles.count(), 2);
  EXPECT_EQ(on_host(particles.arrays().position, 2)[0].y, 2);
  EXPECT_EQ(on_host(particles.arrays().inverse_mass, 2)[0], 1);
  EXPECT_THROW(Particles(0), std::invalid_argument);
  EXPECT_THROW(Particles(3).set_positions(flat({{0, 0, 0}}), 3), std::runtime_error);
}

}  // namespace
}  // namespace peclet::dem
