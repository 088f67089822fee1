#pragma once
// Exact signed distance of an ellipsoid with its normal.
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet::sdf {

struct EllipsoidDistance {
  Real value;
  Vec3 normal;  // outward, at the nearest surface point
};

/// The surface point c nearest to y satisfies y = c + lambda grad F(c), F = sum (c_i / e_i)^2 - 1
/// [Eberly2013]. With lengths in units of the smallest semi-axis m and t = 1 + lambda / m^2,
///   c_i = e_i A_i / (t + b_i),  A_i = e_i |y_i| / m^2,  b_i = (e_i / m)^2 - 1,
/// where t > 0 is the only root of S(t) = sum (A_i / (t + b_i))^2 = 1. Newton's method for the concave
/// function S^(-1/2) - 1 never oversteps the root and increases from the second step on; for a sphere its
/// first step is exact.
KOKKOS_INLINE_FUNCTION EllipsoidDistance ellipsoid_distance(Vec3 y, Vec3 semi_axes) {
  constexpr Real smallest_offset = 1e-60;  // picks a side for points on a symmetry plane
  constexpr Real close_enough = 1e-9;      // before the last step, which squares it
  constexpr int maximum_iterations = 60;
  const Real m = Kokkos::fmin(semi_axes.x, Kokkos::fmin(semi_axes.y, semi_axes.z));
  Real A[3], b[3], t = 0;
  for (int a = 0; a < 3; ++a) {
    const Real e = semi_axes[a] / m;
    A[a] = e * Kokkos::fmax(Kokkos::fabs(y[a]) / m, smallest_offset);
    b[a] = (e - 1) * (e + 1);
    t = Kokkos::fmax(t, A[a] - b[a]);
  }
  const Real lowest = t;
  t = Kokkos::fmax(t, Real(1));  // the surface
  for (int n = 0; n < maximum_iterations; ++n) {
    Real S = 0, slope = 0;  // slope = -S' / 2
    for (int a = 0; a < 3; ++a) {
      const Real inverse = 1 / (t + b[a]), q = A[a] * inverse;
      S += q * q;
      slope += q * q * inverse;
    }
    const Real previous = t;
    t = Kokkos::fmax(t + S * (Kokkos::sqrt(S) - 1) / slope, lowest);
    if (Kokkos::fabs(t - previous) <= close_enough * t) break;
  }
  Vec3 nearest, normal;
  for (int a = 0; a < 3; ++a) {
    const Real sign = y[a] < 0 ? -1 : 1;
    const Real unit = sign * A[a] / (t + b[a]);  // c_i / e_i
    nearest[a] = semi_axes[a] * unit;
    normal[a] = unit * (m / semi_axes[a]);
  }
  normal = normalized(normal);
  return {dot(y - nearest, normal), normal};
}

}  // namespace peclet::sdf
