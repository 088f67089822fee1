#pragma once
// A particle while a substep is under way: its state at the end of the substep, as known so far.
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet::dem {

struct Body {
  Vec3 position, velocity, angular_velocity;  // at the end of the substep
  Vec3 acceleration;                          // by gravity and external forces, constant
  Vec3 turn;                                  // rotation vector that impulses add to the free rotation
  Quaternion orientation;                     // of the free rotation
  Vec3 inverse_inertia;                       // along body axes
  Real inverse_mass = 0;
  bool is_deflected = false;  // an impulse acted in this substep
};

using Bodies = Array<Body>;

/// Neither pushed nor turned by anything. Kernels read such bodies from several threads and never write them.
KOKKOS_INLINE_FUNCTION bool is_immovable(Real inverse_mass, Vec3 inverse_inertia) {
  return inverse_mass == 0 && inverse_inertia.x == 0 && inverse_inertia.y == 0 && inverse_inertia.z == 0;
}

KOKKOS_INLINE_FUNCTION bool is_finite(Vec3 a) {
  return Kokkos::isfinite(a.x) && Kokkos::isfinite(a.y) && Kokkos::isfinite(a.z);
}

/// R I^-1 R^T v
KOKKOS_INLINE_FUNCTION Vec3 inverse_inertia_times(const Body& body, Vec3 v) {
  const Vec3 j = body.inverse_inertia;
  if (j.x == j.y && j.y == j.z) return j.x * v;
  const Vec3 local = rotate_back(body.orientation, v);
  return rotate(body.orientation, {j.x * local.x, j.y * local.y, j.z * local.z});
}

/// An impulse at arm from the centre, at the time `remaining` before the end of the substep. (A force that
/// acts evenly over the last s moves the body as its impulse at s/2 before the end does.)
KOKKOS_INLINE_FUNCTION void apply_impulse(Body& body, Vec3 impulse, Vec3 arm, Real remaining) {
  if (is_immovable(body.inverse_mass, body.inverse_inertia)) return;
  const Vec3 dv = body.inverse_mass * impulse;
  body.velocity += dv;
  body.position += remaining * dv;
  const Vec3 moment = cross(arm, impulse);
  if (moment.x != 0 || moment.y != 0 || moment.z != 0) {
    const Vec3 dw = inverse_inertia_times(body, moment);
    body.angular_velocity += dw;
    body.turn += remaining * dw;
  }
  body.is_deflected = true;
}

/// A couple (an impulse of torque), at the time `remaining` before the end of the substep.
KOKKOS_INLINE_FUNCTION void apply_couple(Body& body, Vec3 couple, Real remaining) {
  if (is_immovable(body.inverse_mass, body.inverse_inertia)) return;
  const Vec3 dw = inverse_inertia_times(body, couple);
  body.angular_velocity += dw;
  body.turn += remaining * dw;
  body.is_deflected = true;
}

/// Move by push / mass, velocity unchanged.
KOKKOS_INLINE_FUNCTION void displace(Body& body, Vec3 push) {
  if (body.inverse_mass > 0) body.position += body.inverse_mass * push;
}

/// Rotation by the vector a (axis times angle).
KOKKOS_INLINE_FUNCTION Quaternion rotation_by(Vec3 a) {
  const Real angle = norm(a);
  const Real sinc = angle > 1e-6 ? Kokkos::sin(0.5 * angle) / angle : 0.5 - angle * angle / 48;
  return {sinc * a.x, sinc * a.y, sinc * a.z, Kokkos::cos(0.5 * angle)};
}

}  // namespace peclet::dem
