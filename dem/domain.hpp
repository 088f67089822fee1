#pragma once
// The box that particles live in.
#include "core/vec3.hpp"

namespace peclet::dem {

/// Unbounded along axes of extent zero. Faces of the box are no walls.
struct Domain {
  Vec3 origin, extent;
  bool periodic[3] = {false, false, false};

  KOKKOS_INLINE_FUNCTION bool wraps(int axis) const { return periodic[axis] && extent[axis] > 0; }

  /// Image of x inside the box along the periodic axes.
  KOKKOS_INLINE_FUNCTION Vec3 wrap(Vec3 x) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!wraps(axis)) continue;
      const Real length = extent[axis];
      const Real turns = Kokkos::floor((x[axis] - origin[axis]) / length);
      if (turns != 0) x[axis] -= turns * length;
      if (x[axis] >= origin[axis] + length || x[axis] < origin[axis]) x[axis] = origin[axis];
    }
    return x;
  }
};

}  // namespace peclet::dem
