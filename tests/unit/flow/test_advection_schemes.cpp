#include "flow/advection_schemes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace peclet;
using namespace peclet::flow;

template <class Scheme>
class AdvectionSchemes : public testing::Test {};
using Schemes = testing::Types<SecondUpwindScheme, KorenScheme, CentralScheme>;
TYPED_TEST_SUITE(AdvectionSchemes, Schemes);

TYPED_TEST(AdvectionSchemes, CarryAConstant) {
  for (const Real carrier : {-0.7, 0.0, 0.7}) EXPECT_EQ(carried_value<TypeParam>(carrier, 3, 3, 3, 3), 3);
}

TYPED_TEST(AdvectionSchemes, AreExactForLinearFieldsInBothDirections) {
  for (const Real slope : {-2.0, 0.5})
    for (const Real carrier : {-1.0, 1.0})
      EXPECT_NEAR(carried_value<TypeParam>(carrier, 1 - 1.5 * slope, 1 - 0.5 * slope, 1 + 0.5 * slope,
                                           1 + 1.5 * slope),
                  1, 1e-15);
}

TYPED_TEST(AdvectionSchemes, MirrorWithTheFlow) {
  const Real values[4] = {0.3, -1.1, 2.0, 2.4};
  EXPECT_EQ(carried_value<TypeParam>(1, values[0], values[1], values[2], values[3]),
            carried_value<TypeParam>(-1, values[3], values[2], values[1], values[0]));
}

TYPED_TEST(AdvectionSchemes, DoNotDependOnTheSignOfTheField) {
  EXPECT_EQ(carried_value<TypeParam>(1, 0.3, -1.1, 2.0, 2.4),
            -carried_value<TypeParam>(1, -0.3, 1.1, -2.0, -2.4));
}

TEST(KorenScheme, StaysBetweenItsNeighbours) {
  // The value leaves the upwind cell towards the downwind one and never beyond either.
  for (const Real far : {-4.0, -1.0, 0.0, 0.4, 1.0, 5.0})
    for (const Real downwind : {-3.0, 0.0, 0.2, 1.0, 1.3, 7.0}) {
      const Real value = KorenScheme::face_value(far, 1, downwind);
      EXPECT_LE(value, std::fmax(1, downwind) + 1e-15);
      EXPECT_GE(value, std::fmin(1, downwind) - 1e-15);
    }
}

TEST(KorenScheme, IsUpwindAtExtrema) {
  EXPECT_EQ(KorenScheme::face_value(0, 1, 0), 1);
  EXPECT_EQ(KorenScheme::face_value(2, 1, 2), 1);
}

TEST(KorenScheme, IsThirdOrderOnSmoothMonotoneFields) {
  // Cell averages of x^2 around the face x = 0.5 + x0: the value there is reproduced exactly.
  const Real x0 = 10;
  const auto average = [&](Real x) { return (std::pow(x + 0.5, 3) - std::pow(x - 0.5, 3)) / 3; };
  const Real value = KorenScheme::face_value(average(x0 - 1), average(x0), average(x0 + 1));
  EXPECT_NEAR(value, (x0 + 0.5) * (x0 + 0.5), 1e-11);
}

}  // namespace
