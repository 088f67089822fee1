#pragma once
// Signed distances of the nine leaves in their own frame, negative inside. All are true Euclidean
// distances but the superquadric's, which is correct to first order near the surface. T is Real, or Dual
// for the gradient as well.
#include "core/sdf_dual.hpp"
#include "core/sdf_ellipsoid.hpp"
#include "core/sdf_operations.hpp"
#include "core/types.hpp"

namespace peclet::sdf {

using Parameters = Kokkos::Array<Real, 8>;

/// Distance to a quarter plane from its edge distances a and b (both negative inside).
template <class T>
KOKKOS_INLINE_FUNCTION T corner(T a, T b) {
  if (value_of(a) <= 0 || value_of(b) <= 0) return larger(a, b);
  return length(a, b);
}

template <class T>
KOKKOS_INLINE_FUNCTION T sphere(T x, T y, T z, Real radius) {
  return length(x, y, z) - radius;
}

template <class T>
KOKKOS_INLINE_FUNCTION T box(T x, T y, T z, Real half_x, Real half_y, Real half_z) {
  const T a = absolute(x) - half_x, b = absolute(y) - half_y, c = absolute(z) - half_z;
  const T inside = larger(larger(a, b), c);
  const int sides_outside = (value_of(a) > 0) + (value_of(b) > 0) + (value_of(c) > 0);
  if (sides_outside <= 1) return inside;
  return length(larger(a, T(0)), larger(b, T(0)), larger(c, T(0)));
}

/// Tube around the axis; solid where inner is zero.
template <class T>
KOKKOS_INLINE_FUNCTION T tube(T radial, T axial, Real inner, Real outer, Real half_height) {
  const T across =
      inner > 0 ? absolute(radial - 0.5 * (outer + inner)) - 0.5 * (outer - inner) : radial - outer;
  return corner(across, absolute(axial) - half_height);
}

template <class T>
KOKKOS_INLINE_FUNCTION T capsule(T x, T y, T z, Real radius, Real half_length) {
  const T beyond = absolute(y) - half_length;
  return length(x, larger(beyond, T(0)), z) - radius;
}

/// Ring of radius ring around the axis. Where ring < tube the discs of the cross-section overlap and share a
/// cusp on the axis, which is then nearest to the points whose foot on their own disc lies across the axis.
template <class T>
KOKKOS_INLINE_FUNCTION T torus(T radial, T axial, Real ring, Real tube) {
  const T from_ring = radial - ring;
  const T distance = length(from_ring, axial);
  if (ring < tube && value_of(distance) < tube &&
      ring * value_of(distance) + tube * value_of(from_ring) < 0) {
    const Real cusp = Kokkos::sqrt(tube * tube - ring * ring);
    return -length(radial, absolute(axial) - cusp);
  }
  return distance - tube;
}

/// Truncated cone; the half cross-section is a trapezoid with the corners (bottom, -h) and (top, h).
template <class T>
KOKKOS_INLINE_FUNCTION T cone(T radial, T axial, Real bottom, Real top, Real half_height) {
  const Real slope_r = top - bottom, slope_y = 2 * half_height;
  const Real side = Kokkos::sqrt(slope_r * slope_r + slope_y * slope_y);
  const Real tr = slope_r / side, ty = slope_y / side;  // up along the side; its outward normal is (ty, -tr)
  const T from_corner_r = radial - bottom, from_corner_y = axial + half_height;
  const T outside_side = ty * from_corner_r - tr * from_corner_y;
  const T along_side = tr * from_corner_r + ty * from_corner_y;
  const T above_caps = absolute(axial) - half_height;

  if (value_of(outside_side) <= 0 && value_of(above_caps) <= 0) return larger(outside_side, above_caps);
  const Real cap = value_of(axial) > 0 ? top : bottom;
  if (value_of(above_caps) > 0 && value_of(radial) <= cap) return above_caps;
  if (value_of(along_side) > side) return length(radial - top, axial - half_height);
  if (value_of(along_side) < 0) return length(from_corner_r, from_corner_y);
  return outside_side;
}

template <class T>
KOKKOS_INLINE_FUNCTION T ellipsoid(T x, T y, T z, Vec3 radii) {
  const EllipsoidDistance d = ellipsoid_distance({value_of(x), value_of(y), value_of(z)}, radii);
  return with_partials(d.value, d.normal, x, y, z);
}

/// Superquadric with exponent e >= 1: g = (sum |x_i / r_i|^e)^(1/e) is a norm, so the tangent estimate
/// (g - 1) / |grad g| [Taubin1994] never exceeds the distance outside. Inside it never falls short of the
/// depth, nor do the distances to the surface along the axes; the smallest is taken.
template <class T>
KOKKOS_INLINE_FUNCTION T convex_superquadric(const T (&x)[3], Vec3 r, Real e, const T (&along_axis)[3]) {
  const T largest = larger(larger(x[0] / r.x, x[1] / r.y), x[2] / r.z);
  if (!(value_of(largest) > 0)) return smaller(smaller(T(r.x), T(r.y)), T(r.z)) * T(-1.0);
  T scaled[3], sum = 0;
  for (int a = 0; a < 3; ++a) {
    scaled[a] = x[a] / (r[a] * largest);
    sum = sum + power(scaled[a], e);
  }
  const T norm_of_scaled = power(sum, 1 / e);  // g = largest * norm_of_scaled, without overflow
  T slope_squared = 0;
  for (int a = 0; a < 3; ++a) {
    const T slope = power(scaled[a] / norm_of_scaled, e - 1) / r[a];
    slope_squared = slope_squared + slope * slope;
  }
  const T tangent = (largest * norm_of_scaled - 1.0) / square_root(slope_squared);
  // Next to the surface the tangent is as good, and free of the cancellation in along_axis.
  constexpr Real shallow = 1e-6;
  if (value_of(tangent) > -shallow * Kokkos::fmin(r.x, Kokkos::fmin(r.y, r.z))) return tangent;
  return larger(larger(larger(tangent, along_axis[0]), along_axis[1]), along_axis[2]);
}

/// Superquadric sum |x_i / r_i|^e = 1. For e < 1 (star-shaped, with cusps) the distance to the plane through
/// the three points where the lines along the axes meet the surface; signed roots continue their distances
/// to lines that miss it.
template <class T>
KOKKOS_INLINE_FUNCTION T superquadric(T x, T y, T z, Vec3 r, Real e) {
  const T p[3] = {absolute(x), absolute(y), absolute(z)};
  const T terms[3] = {power(p[0] / r.x, e), power(p[1] / r.y, e), power(p[2] / r.z, e)};
  T along_axis[3];
  for (int a = 0; a < 3; ++a) {
    const T rest = 1.0 - (terms[(a + 1) % 3] + terms[(a + 2) % 3]);
    const T root = r[a] * power(absolute(rest), 1 / e);
    along_axis[a] = value_of(rest) >= 0 ? p[a] - root : p[a] + root;
  }
  if (e >= 1) return convex_superquadric(p, r, e, along_axis);
  const T level = terms[0] + terms[1] + terms[2] - 1.0;
  T inverse_squares = 0;
  for (int a = 0; a < 3; ++a) {
    if (value_of(along_axis[a]) == 0) return along_axis[a];  // on the surface
    inverse_squares = inverse_squares + 1.0 / (along_axis[a] * along_axis[a]);
  }
  const T distance = 1.0 / square_root(inverse_squares);
  return value_of(level) < 0 ? -distance : distance;
}

/// Distance of the leaf with this code at (x, y, z).
template <class T>
PECLET_CALLED_FUNCTION T leaf_distance(Opcode opcode, T x, T y, T z, const Parameters& p) {
  switch (opcode) {
    case Opcode::Sphere:
      return sphere(x, y, z, p[0]);
    case Opcode::HollowCylinder:
      return tube(length(x, z), y, p[0] - p[2], p[0], 0.5 * p[1]);
    case Opcode::Box:
      return box(x, y, z, p[0], p[1], p[2]);
    case Opcode::HollowCylinderShell:
      return tube(length(x, y), z, p[1], p[0], 0.5 * p[2]);
    case Opcode::Capsule:
      return capsule(x, y, z, p[0], p[1]);
    case Opcode::Torus:
      return torus(length(x, z), y, p[0], p[1]);
    case Opcode::Cone:
      return cone(length(x, z), y, p[0], p[1], p[2]);
    case Opcode::Ellipsoid:
      return ellipsoid(x, y, z, {p[0], p[1], p[2]});
    case Opcode::Superquadric:
      return superquadric(x, y, z, {p[0], p[1], p[2]}, p[3]);
    default:
      return T(1e30);
  }
}

}  // namespace peclet::sdf
