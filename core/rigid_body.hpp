#pragma once
// Pose and motion of a rigid body: similarity transforms that compose, and rigid velocities.
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet {

/// x = translation + scale R x_local. A scale of zero marks a body that has vanished.
struct Pose {
  Vec3 translation{};
  Quaternion rotation{};
  Real scale = 1;
};

/// Velocity of the centre of rotation and angular velocity, both along world axes.
struct Twist {
  Vec3 linear{}, angular{};
};

/// R^T (x - t) / s
KOKKOS_INLINE_FUNCTION Vec3 to_local(const Pose& pose, Vec3 x) {
  return rotate_back(pose.rotation, x - pose.translation) / pose.scale;
}

/// t + s R x_local
KOKKOS_INLINE_FUNCTION Vec3 to_world(const Pose& pose, Vec3 local) {
  return pose.translation + pose.scale * rotate(pose.rotation, local);
}

/// The pose that maps x to to_world(outer, to_world(inner, x)).
KOKKOS_INLINE_FUNCTION Pose compose(const Pose& outer, const Pose& inner) {
  return {to_world(outer, inner.translation), normalized(outer.rotation * inner.rotation),
          outer.scale * inner.scale};
}

/// U + omega x (x - center)
KOKKOS_INLINE_FUNCTION Vec3 velocity_at(const Twist& twist, Vec3 center, Vec3 x) {
  return twist.linear + cross(twist.angular, x - center);
}

}  // namespace peclet
