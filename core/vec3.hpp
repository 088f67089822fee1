#pragma once
// Small vectors, quaternions (x, y, z, w) and rotations for host and device.
#include "core/types.hpp"

namespace peclet {

struct Vec3 {
  Real x = 0, y = 0, z = 0;

  KOKKOS_INLINE_FUNCTION Real& operator[](int a) { return a == 0 ? x : (a == 1 ? y : z); }
  KOKKOS_INLINE_FUNCTION Real operator[](int a) const { return a == 0 ? x : (a == 1 ? y : z); }
};

KOKKOS_INLINE_FUNCTION Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator*(Real s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator*(Vec3 a, Real s) { return s * a; }
KOKKOS_INLINE_FUNCTION Vec3 operator/(Vec3 a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
KOKKOS_INLINE_FUNCTION Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
KOKKOS_INLINE_FUNCTION Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }

KOKKOS_INLINE_FUNCTION Real dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
KOKKOS_INLINE_FUNCTION Real norm(Vec3 a) { return Kokkos::sqrt(dot(a, a)); }
KOKKOS_INLINE_FUNCTION Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Unit vector along a, or fallback where a vanishes.
KOKKOS_INLINE_FUNCTION Vec3 normalized(Vec3 a, Vec3 fallback = {1, 0, 0}) {
  const Real length = norm(a);
  return length > 0 ? a / length : fallback;
}

/// Unit quaternion; rotates vectors actively.
struct Quaternion {
  Real x = 0, y = 0, z = 0, w = 1;
};

KOKKOS_INLINE_FUNCTION Quaternion conjugate(Quaternion q) { return {-q.x, -q.y, -q.z, q.w}; }

KOKKOS_INLINE_FUNCTION Quaternion operator*(Quaternion a, Quaternion b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

KOKKOS_INLINE_FUNCTION Quaternion normalized(Quaternion q) {
  const Real length = Kokkos::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 0)) return {};
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

/// R v for the rotation R of the unit quaternion q.
KOKKOS_INLINE_FUNCTION Vec3 rotate(Quaternion q, Vec3 v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

/// R^T v, from world into body axes.
KOKKOS_INLINE_FUNCTION Vec3 rotate_back(Quaternion q, Vec3 v) { return rotate(conjugate(q), v); }

}  // namespace peclet
