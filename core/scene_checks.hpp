#pragma once
// Checks of what enters a scene; each returns its argument with the quaternion normalised.
#include <string>

#include "core/scene.hpp"

namespace peclet {

/// prefix goes before the name of the wrong part in messages. may_vanish: the scale may be zero.
Pose checked(const Pose& pose, const std::string& prefix, bool may_vanish = false);
SceneInstance checked(SceneInstance instance, const std::string& prefix, bool may_vanish);

}  // namespace peclet
