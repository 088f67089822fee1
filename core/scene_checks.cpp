#include "core/scene_checks.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace peclet {

namespace {

void require_finite(Vec3 v, const std::string& argument) {
  for (int axis = 0; axis < 3; ++axis)
    peclet::require_finite(v[axis], argument + "[" + std::to_string(axis) + "]");
}

Quaternion checked_rotation(Quaternion q, const std::string& argument) {
  const Real largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  for (Real component : {q.x, q.y, q.z, q.w}) peclet::require_finite(component, argument);
  require(largest > 0, argument, "a quaternion (x, y, z, w) that is not zero", "(0, 0, 0, 0)");
  return normalized(Quaternion{q.x / largest, q.y / largest, q.z / largest, q.w / largest});
}

}  // namespace

Pose checked(const Pose& pose, const std::string& prefix, bool may_vanish) {
  require_finite(pose.translation, prefix + "translation");
  if (may_vanish)
    require_non_negative(pose.scale, prefix + "scale");
  else
    require_positive(pose.scale, prefix + "scale");
  return {pose.translation, checked_rotation(pose.rotation, prefix + "rotation"), pose.scale};
}

SceneInstance checked(SceneInstance instance, const std::string& prefix, bool may_vanish) {
  instance.pose = checked(instance.pose, prefix, may_vanish);
  require_finite(instance.twist.linear, prefix + "lin_vel");
  require_finite(instance.twist.angular, prefix + "ang_vel");
  if (instance.center_pinned) require_finite(instance.center, prefix + "center");
  require(instance.material >= -1, prefix + "material", "-1 (none) or a material number", instance.material);
  return instance;
}

}  // namespace peclet
