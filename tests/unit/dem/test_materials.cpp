#include "dem/materials.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace peclet::dem {
namespace {

ContactMaterial entry(const Materials& materials, int first, int second) {
  const auto table = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, materials.table().entries);
  return table(static_cast<std::size_t>(first * materials.table().number_of_ids + second));
}

TEST(Materials, PairsAreSymmetricAndSurviveANewDefault) {
  Materials materials;
  materials.set_pair(2, 1, 0.5, 0.1);
  materials.set_default({0.9, 0.2, 0.3});
  EXPECT_EQ(entry(materials, 1, 2).restitution, 0.5);
  EXPECT_EQ(entry(materials, 2, 1).friction, 0.1);
  EXPECT_EQ(entry(materials, 0, 1).restitution, 0.9);
  EXPECT_EQ(entry(materials, 2, 1).tangential_restitution, 0.2);
}

TEST(Materials, RefuseValuesOutOfRange) {
  Materials materials;
  EXPECT_THROW(materials.set_default({1.1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(materials.set_default({0.5, 0, -1}), std::invalid_argument);
  EXPECT_THROW(materials.set_default({0.5, 2, 0}), std::invalid_argument);
  EXPECT_THROW(materials.set_pair(-1, 0, 0.5, 0), std::invalid_argument);
  EXPECT_EQ(materials.default_material().restitution, 0);
}

TEST(Materials, DampingIsNoneForElasticAndCriticalForRestitutionExpMinusTwo) {
  EXPECT_NEAR(damping_ratio(1), 0, 1e-12);
  EXPECT_NEAR(damping_ratio(std::exp(-2.0)), 1, 1e-6);
  EXPECT_EQ(damping_ratio(0), damping_ratio(0.01));
  Real last = 10;
  for (const Real e : {0.01, 0.1, 0.13, 0.14, 0.5, 0.9, 0.99}) {
    EXPECT_LT(damping_ratio(e), last);
    last = damping_ratio(e);
  }
}

}  // namespace
}  // namespace peclet::dem
