#include "dem/integrator.hpp"

#include "core/loop.hpp"

namespace peclet::dem {
namespace {

/// w = R I^-1 R^T L
KOKKOS_INLINE_FUNCTION Vec3 spin_of(Quaternion q, Vec3 inverse_inertia, Vec3 momentum) {
  const Vec3 local = rotate_back(q, momentum);
  return rotate(q, {inverse_inertia.x * local.x, inverse_inertia.y * local.y, inverse_inertia.z * local.z});
}

KOKKOS_INLINE_FUNCTION Quaternion turned(Quaternion q, Vec3 angle) {
  return normalized(rotation_by(angle) * q);
}

/// Free rotation. Equal moments of inertia: dw/dt = torque / I, turned by the mean spin. Unequal ones: the
/// angular momentum L = R I R^T w advances by the torque, exactly, and the orientation by the spin that
/// belongs to the midpoint, second order. Where a body has an infinite moment of inertia, L does not exist
/// and the gyroscopic term is dropped.
KOKKOS_INLINE_FUNCTION void rotate_freely(Body& body, Vec3 spin, Quaternion q, Vec3 torque, Real dt) {
  const Vec3 j = body.inverse_inertia;
  const bool is_isotropic = j.x == j.y && j.y == j.z;
  if (is_isotropic || j.x == 0 || j.y == 0 || j.z == 0) {
    body.angular_velocity = spin + dt * spin_of(q, j, torque);
    body.orientation = turned(q, (0.5 * dt) * (spin + body.angular_velocity));
    return;
  }
  const Vec3 momentum = spin_of(q, {1 / j.x, 1 / j.y, 1 / j.z}, spin);
  const Quaternion middle = turned(q, (0.5 * dt) * spin);
  body.orientation = turned(q, dt * spin_of(middle, j, momentum + (0.5 * dt) * torque));
  body.angular_velocity = spin_of(body.orientation, j, momentum + dt * torque);
}

/// x + v dt + a dt^2 / 2, v + a dt; a fixed body has no acceleration.
KOKKOS_INLINE_FUNCTION Body predicted(const ParticleArrays& p, Index n, Vec3 gravity, Vec3 force, Vec3 torque,
                                      Real dt) {
  Body body;
  body.inverse_mass = p.inverse_mass(n);
  body.inverse_inertia = p.inverse_inertia(n);
  if (body.inverse_mass > 0) body.acceleration = gravity + body.inverse_mass * force;
  body.position = p.position(n) + dt * p.velocity(n) + (0.5 * dt * dt) * body.acceleration;
  body.velocity = p.velocity(n) + dt * body.acceleration;
  rotate_freely(body, p.angular_velocity(n), p.orientation(n), torque, dt);
  return body;
}

KOKKOS_INLINE_FUNCTION Body at_middle(const ParticleArrays& p, Index n, Vec3 gravity, Real dt) {
  Body body;
  body.inverse_mass = p.inverse_mass(n);
  body.inverse_inertia = p.inverse_inertia(n);
  if (body.inverse_mass > 0) body.acceleration = gravity + body.inverse_mass * p.force(n);
  body.position = p.position(n) + (0.5 * dt) * p.velocity(n);
  body.velocity = p.velocity(n);
  body.angular_velocity = p.angular_velocity(n);
  body.orientation = p.orientation(n);
  return body;
}

}  // namespace

void wrap_positions(const ParticleArrays& particles, const Domain& domain) {
  for_each(
      "dem::wrap_positions", particles.count,
      KOKKOS_LAMBDA(Index n) { particles.position(n) = domain.wrap(particles.position(n)); });
}

void predict_motion(const ParticleArrays& particles, Vec3 gravity, Real dt, const Bodies& bodies) {
  for_each(
      "dem::predict_motion", particles.count, KOKKOS_LAMBDA(Index n) {
        bodies(n) = predicted(particles, n, gravity, particles.force(n), particles.torque(n), dt);
      });
}

void predict_motion(const ParticleArrays& particles, Vec3 gravity, const ParticleLoads& contacts, Real dt,
                    const Bodies& bodies) {
  for_each(
      "dem::predict_motion_with_loads", particles.count, KOKKOS_LAMBDA(Index n) {
        bodies(n) = predicted(particles, n, gravity, particles.force(n) + contacts.force(n),
                              particles.torque(n) + contacts.torque(n), dt);
      });
}

void place_at_middle(const ParticleArrays& particles, Vec3 gravity, Real dt, const Bodies& bodies) {
  for_each(
      "dem::place_at_middle", particles.count,
      KOKKOS_LAMBDA(Index n) { bodies(n) = at_middle(particles, n, gravity, dt); });
}

bool is_finite_motion(const Bodies& bodies, Index count) {
  return max_each(
             "dem::is_finite_motion", count, KOKKOS_LAMBDA(Index n) {
               const Body& b = bodies(n);
               const bool is_good = is_finite(b.position) && is_finite(b.velocity) &&
                                    is_finite(b.angular_velocity) && is_finite(b.turn) &&
                                    is_finite({b.orientation.x, b.orientation.y, b.orientation.z}) &&
                                    Kokkos::isfinite(b.orientation.w);
               return is_good ? Real{0} : Real{1};
             }) == 0;
}

void accept_motion(const Bodies& bodies, const Domain& domain, bool positions_only,
                   const ParticleArrays& particles) {
  for_each(
      "dem::accept_motion", particles.count, KOKKOS_LAMBDA(Index n) {
        const Body& body = bodies(n);
        particles.position(n) = domain.wrap(body.position);
        if (positions_only) return;
        particles.velocity(n) = body.velocity;
        particles.angular_velocity(n) = body.angular_velocity;
        particles.orientation(n) = turned(body.orientation, body.turn);
      });
}

}  // namespace peclet::dem
