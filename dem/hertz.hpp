#pragma once
// Forces between elastic spheres that overlap a little: Hertz across the contact, Mindlin along it, each with
// a dashpot, and an elastic-plastic resistance to rolling. All are those on a.
//
// They act on positions x + v dt/2 in the middle of a substep, where the integrator applies them. Dashpots
// see the velocity there as well, their own share in it included, so that they need no small dt.
#include "dem/contact_laws.hpp"

namespace peclet::dem {

/// Constants of two surfaces pressed together [Johnson1985]:
/// 1/E* = sum (1 - nu^2)/E, 1/G* = sum 2 (2 - nu)(1 + nu)/E
struct ElasticPair {
  Real young = 0, shear = 0;

  ElasticPair() = default;
  KOKKOS_INLINE_FUNCTION ElasticPair(const ElasticMaterial& p, const ElasticMaterial& q)
      : young(1 / ((1 - p.poisson * p.poisson) / p.young + (1 - q.poisson * q.poisson) / q.young)),
        shear(0.5 /
              ((2 - p.poisson) * (1 + p.poisson) / p.young + (2 - q.poisson) * (1 + q.poisson) / q.young)) {}
};

/// What a closed contact keeps from one substep to the next.
struct ContactSpring {
  Real circle = 0;  // radius of the circle of contact; 0: open
  Vec3 normal;
  Vec3 force;   // elastic part of the tangential force on a
  Vec3 moment;  // elastic part of the rolling resistance on a
};

/// Moments are about the centres; b feels the opposite force.
struct SoftLoad {
  Vec3 force, moment_on_a, moment_on_b;
};

/// Motion in the middle of a substep.
struct SoftMotion {
  Vec3 distance;      // of the centres, or of the centre of a from a point of the wall
  Vec3 velocity;      // relative, at the start of the substep
  Vec3 acceleration;  // relative, by gravity and external forces
  Real dt = 0;
};

/// Dashpot c = 2 zeta sqrt(5/6 k m) beside a spring that stiffens like a Hertz contact [AntypovElliott2011].
KOKKOS_INLINE_FUNCTION Real hertz_damping(const Contact& c, Real stiffness, Real mobility) {
  return 2 * c.material.damping_ratio * Kokkos::sqrt(5.0 / 6 * stiffness / mobility);
}

/// v turned with the normal: into the plane across n, at its old length.
KOKKOS_INLINE_FUNCTION Vec3 turned_into_plane(Vec3 v, Vec3 n) {
  const Vec3 inside = v - dot(n, v) * n;
  const Real length = norm(inside);
  return length > 0 ? (norm(v) / length) * inside : inside;
}

/// Springs follow the normal and slacken with the circle of contact, lest unloading set free more energy than
/// loading stored [ThorntonCumminsCleary2013].
KOKKOS_INLINE_FUNCTION void carry_spring(ContactSpring& spring, Vec3 n, Real circle) {
  const Real share = circle < spring.circle ? circle / spring.circle : 1;
  spring.force = share * turned_into_plane(spring.force, n);
  spring.moment = share * turned_into_plane(spring.moment, n);
  spring.normal = n;
  spring.circle = circle;
}

/// F = 4/3 E* a delta - c v_n with a = sqrt(R* delta), never attractive.
KOKKOS_INLINE_FUNCTION Real normal_force(const Contact& c, const ElasticPair& elastic, Real circle,
                                         Real overlap, Real separation, Real mobility, Real dt) {
  const Real damping = hertz_damping(c, 2 * elastic.young * circle, mobility);
  const Real force = 4.0 / 3 * elastic.young * circle * overlap - damping * separation;
  return Kokkos::max(Real{0}, force / (1 + 0.5 * dt * damping * mobility));
}

/// dF/dt = -8 G* a slip, with a dashpot, at most mu F_n.
KOKKOS_INLINE_FUNCTION Vec3 tangential_force(const Contact& c, const ElasticPair& elastic,
                                             const Bodies& bodies, const Arms& arms, const SoftMotion& motion,
                                             Real normal, ContactSpring& spring) {
  const Vec3 n = spring.normal;
  const Vec3 slip = slip_velocity(c, bodies, arms, n, motion.velocity);
  const Vec3 push = motion.acceleration - dot(n, motion.acceleration) * n;
  const Real stiffness = 8 * elastic.shear * spring.circle;
  const Real damping = hertz_damping(c, stiffness, normal_mobility(c, bodies));
  const Real limit = c.material.friction * normal;
  spring.force -= (motion.dt * stiffness) * slip;
  const Vec3 force = spring.force - damping * (slip + (0.5 * motion.dt) * push);
  const Real size = norm(force);
  if (size == 0) return {};
  const Real mobility = tangential_mobility(c, bodies, arms, force / size);
  spring.force = limited(spring.force, limit);
  return limited(force / (1 + 0.5 * motion.dt * damping * mobility), limit);
}

/// A spring against rolling as stiff as the tangential one at the arm R*, half critically damped, at most
/// mu_r R* F_n [AiEtAl2011].
KOKKOS_INLINE_FUNCTION Vec3 rolling_moment(const Contact& c, const ElasticPair& elastic, const Bodies& bodies,
                                           Real dt, Real normal, ContactSpring& spring) {
  const Real radius = c.effective_radius();
  const Vec3 spin = rolling_spin(c, bodies, spring.normal);
  const Real stiffness = 8 * elastic.shear * spring.circle * radius * radius;
  const Real limit = c.material.rolling_friction * radius * normal;
  spring.moment = limited(spring.moment - (dt * stiffness) * spin, limit);
  const Real speed = norm(spin);
  const Real mobility = speed > 0 ? rolling_mobility(c, bodies, spin / speed) : 0;
  if (mobility == 0) return spring.moment;
  const Real damping = Kokkos::sqrt(stiffness / mobility);
  return limited((spring.moment - damping * spin) / (1 + 0.5 * dt * damping * mobility), limit);
}

/// Load of a contact with the unit vector n from b to a, and the spring of the next substep.
KOKKOS_INLINE_FUNCTION SoftLoad hertz_load(const Contact& c, const ElasticPair& elastic, const Bodies& bodies,
                                           const SoftMotion& motion, Vec3 n, ContactSpring& spring) {
  const Real length = dot(n, motion.distance);
  const Real overlap = c.reach - length;
  const Real mobility = normal_mobility(c, bodies);
  if (!(overlap > 0) || mobility == 0) {
    spring = {};
    return {};
  }
  carry_spring(spring, n, Kokkos::sqrt(c.effective_radius() * overlap));
  const Real separation = dot(n, motion.velocity + (0.5 * motion.dt) * motion.acceleration);
  const Real normal = normal_force(c, elastic, spring.circle, overlap, separation, mobility, motion.dt);
  const Arms arms(c, n, length);
  SoftLoad load{normal * n, {}, {}};
  if (c.material.friction > 0)
    load.force += tangential_force(c, elastic, bodies, arms, motion, normal, spring);
  load.moment_on_a = cross(arms.a, load.force);
  load.moment_on_b = cross(arms.b, -load.force);
  if (c.material.rolling_friction > 0) {
    const Vec3 moment = rolling_moment(c, elastic, bodies, motion.dt, normal, spring);
    load.moment_on_a += moment;
    load.moment_on_b -= moment;
  }
  return load;
}

}  // namespace peclet::dem
