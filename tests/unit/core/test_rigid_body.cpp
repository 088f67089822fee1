#include "core/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace peclet;

void expect_near(Vec3 a, Vec3 b, Real tolerance = 1e-14) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance);
}

const Pose tilted{{1, -2, 3}, normalized(Quaternion{0.1, -0.4, 0.2, 0.7}), 2.5};
const Pose shifted{{-0.5, 4, 1}, normalized(Quaternion{0.3, 0.2, -0.6, 0.1}), 0.5};

TEST(Pose, QuarterTurnAboutZMapsXToY) {
  const Pose turn{{0, 0, 0}, normalized(Quaternion{0, 0, 1, 1}), 1};
  expect_near(to_world(turn, {1, 0, 0}), {0, 1, 0});
}

TEST(Pose, WorldAndLocalAreInverse) {
  const Vec3 x{0.3, 1.7, -2.2};
  expect_near(to_local(tilted, to_world(tilted, x)), x);
  expect_near(to_world(tilted, to_local(tilted, x)), x);
}

TEST(Pose, CompositionAppliesTheInnerPoseFirst) {
  const Vec3 x{0.3, 1.7, -2.2};
  expect_near(to_world(compose(tilted, shifted), x), to_world(tilted, to_world(shifted, x)));
}

TEST(Pose, ScalesDistances) {
  const Vec3 x{0.3, 1.7, -2.2}, y{1, 0, 0.5};
  EXPECT_NEAR(norm(to_world(tilted, x) - to_world(tilted, y)), 2.5 * norm(x - y), 1e-14);
}

TEST(Twist, RigidMotionKeepsDistances) {
  const Twist twist{{1, 2, 3}, {-0.3, 0.5, 0.8}};
  const Vec3 center{1, 1, 0}, x{2, 0.5, -1}, y{-1, 3, 2};
  // the rate of change of |x - y|^2 / 2
  EXPECT_NEAR(dot(velocity_at(twist, center, x) - velocity_at(twist, center, y), x - y), 0, 1e-14);
  expect_near(velocity_at(twist, center, center), twist.linear);
}

}  // namespace
