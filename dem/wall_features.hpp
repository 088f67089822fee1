#pragma once
// Where a sphere may touch a wall. A distance function only knows the nearest surface, but in an edge or a
// corner a sphere touches several: each of them is found by following the gradient from a few points of
// the sphere's own surface.
#include "dem/walls.hpp"

namespace peclet::dem {

/// Normal n of a surface with n = gradient at x - radius n, i.e. one that faces the sphere squarely, found by
/// repeating that from a first guess. False if it does not settle.
KOKKOS_INLINE_FUNCTION bool find_facing_normal(const WallArrays& walls, const Wall& wall, Vec3 x, Real radius,
                                               Vec3& n) {
  for (int k = 0; k < 8; ++k) {
    const Vec3 next = walls.normal(wall, x - radius * n);
    const Vec3 change = next - n;
    n = next;
    if (dot(change, change) < 1e-12) return true;
  }
  return false;
}

/// Axes of the wall, both ways.
KOKKOS_INLINE_FUNCTION Vec3 probe_direction(const Wall& wall, int k) {
  Vec3 direction{0, 0, 0};
  direction[k / 2] = k % 2 == 0 ? 1 : -1;
  return rotate(wall.pose.rotation, direction);
}

KOKKOS_INLINE_FUNCTION bool is_known(Vec3 n, const WallFeature* features, int count) {
  constexpr Real cosine_of_same = 0.999;
  for (int k = 0; k < count; ++k)
    if (dot(n, features[k].normal) > cosine_of_same) return true;
  return false;
}

KOKKOS_INLINE_FUNCTION WallFeature feature_at(const Wall& wall, Vec3 x, Vec3 n, Real distance) {
  const Vec3 point = x - distance * n;
  return {point, n, velocity_at(wall.twist, wall.center, point)};
}

KOKKOS_INLINE_FUNCTION int WallArrays::features_near(const Wall& wall, Vec3 x, Real radius, Real reach,
                                                     WallFeature* features) const {
  const Real distance_of_center = distance(wall, x);
  if (!(distance_of_center < reach)) return 0;
  int count = 0;
  features[count++] = feature_at(wall, x, normal(wall, x), distance_of_center);
  if (wall.slot < 0) return count;
  for (int k = 0; k < 6 && count < maximum_features; ++k) {
    const Vec3 probe = x + radius * probe_direction(wall, k);
    if (!(distance(wall, probe) < reach - radius)) continue;
    Vec3 n = normal(wall, probe);
    if (is_known(n, features, count) || !find_facing_normal(*this, wall, x, radius, n)) continue;
    const Real gap = distance(wall, x - radius * n);
    if (gap < reach - radius && !is_known(n, features, count))
      features[count++] = feature_at(wall, x, n, gap + radius);
  }
  return count;
}

}  // namespace peclet::dem
