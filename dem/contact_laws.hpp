#pragma once
// What happens at one contact, written for the relative motion of a as seen from b. All impulses are those on
// a; b receives the opposite at the same point, so that momentum and angular momentum are kept.
#include "dem/contact.hpp"

namespace peclet::dem {

/// Motion of the centre of a relative to that of b (to the tangent plane of a wall) with constant
/// acceleration.
struct RelativeMotion {
  Vec3 distance, velocity, acceleration;

  /// The state at time s before this one.
  KOKKOS_INLINE_FUNCTION RelativeMotion before(Real s) const {
    return {distance - s * velocity + 0.5 * s * s * acceleration, velocity - s * acceleration, acceleration};
  }
};

KOKKOS_INLINE_FUNCTION Vec3 center_distance(const Contact& c, const Bodies& bodies) {
  const Vec3 other = c.is_pair() ? bodies(c.b).position + c.offset : c.offset;
  return bodies(c.a).position - other;
}

/// At the end of the substep.
KOKKOS_INLINE_FUNCTION RelativeMotion relative_motion(const Contact& c, const Bodies& bodies) {
  const Body& a = bodies(c.a);
  if (!c.is_pair()) return {a.position - c.offset, a.velocity - c.wall_velocity, a.acceleration};
  const Body& b = bodies(c.b);
  return {a.position - b.position - c.offset, a.velocity - b.velocity, a.acceleration - b.acceleration};
}

KOKKOS_INLINE_FUNCTION Vec3 normal_of(const Contact& c, Vec3 distance) {
  return c.is_pair() ? normalized(distance, c.normal) : c.normal;
}

/// Distance of the centres, or of the centre from the wall.
KOKKOS_INLINE_FUNCTION Real length_of(const Contact& c, Vec3 distance) {
  return c.is_pair() ? norm(distance) : dot(c.normal, distance);
}

KOKKOS_INLINE_FUNCTION Real gap_of(const Contact& c, Vec3 distance) {
  return length_of(c, distance) - c.reach;
}

/// How long before the end of a substep the gap closed, for a motion that overlaps `inside` before the end;
/// dt if it was closed from the start. Newton's method, kept within a bracket.
KOKKOS_INLINE_FUNCTION Real find_closed_time(const Contact& c, const RelativeMotion& end, Real inside,
                                             Real dt) {
  if (gap_of(c, end.before(dt).distance) <= 0) return dt;
  Real low = inside, high = dt, s = dt;
  for (int k = 0; k < 60; ++k) {
    const RelativeMotion at = end.before(s);
    const Real gap = gap_of(c, at.distance);
    if (gap < 0)
      low = s;
    else
      high = s;
    if (Kokkos::abs(gap) <= 1e-15 * c.reach || high - low <= 1e-15 * dt) break;
    const Real slope = -dot(normal_of(c, at.distance), at.velocity);
    const Real next = s - gap / slope;
    s = next > low && next < high ? next : 0.5 * (low + high);
  }
  return s;
}

/// Time before the end at which the motion was deepest inside, or -1 if it does not overlap in the substep.
/// Spheres on their free path may meet and part again within it.
KOKKOS_INLINE_FUNCTION Real time_of_overlap(const Contact& c, const RelativeMotion& end, bool is_free,
                                            Real dt) {
  if (gap_of(c, end.distance) < 0) return 0;
  if (!is_free || !c.is_pair()) return -1;
  const Real speed2 = dot(end.velocity, end.velocity);
  const Real s = speed2 > 0 ? dot(end.distance, end.velocity) / speed2 : 0;
  return s > 0 && s < dt && gap_of(c, end.before(s).distance) < 0 ? s : -1;
}

/// Lever arms from the centres to the point of contact. They add up to the distance of the centres, whatever
/// rounding or overlap made of it: that is what keeps the angular momentum.
struct Arms {
  Vec3 a, b;
  KOKKOS_INLINE_FUNCTION Arms(const Contact& c, Vec3 n, Real length)
      : a(-(c.share * length) * n), b(((1 - c.share) * length) * n) {}
};

KOKKOS_INLINE_FUNCTION void apply_to_both(const Contact& c, const Bodies& bodies, Vec3 impulse,
                                          const Arms& arms, Real remaining) {
  apply_impulse(bodies(c.a), impulse, arms.a, remaining);
  if (c.is_pair()) apply_impulse(bodies(c.b), -impulse, arms.b, remaining);
}

/// Change of the relative normal velocity per normal impulse: 1/m_a + 1/m_b
KOKKOS_INLINE_FUNCTION Real normal_mobility(const Contact& c, const Bodies& bodies) {
  return bodies(c.a).inverse_mass + (c.is_pair() ? bodies(c.b).inverse_mass : 0);
}

/// Change of the slip along the unit vector t per impulse along t:
/// 1/m_a + 1/m_b + sum of (arm x t) . I^-1 (arm x t)
KOKKOS_INLINE_FUNCTION Real tangential_mobility(const Contact& c, const Bodies& bodies, const Arms& arms,
                                                Vec3 t) {
  const Vec3 moment_a = cross(arms.a, t);
  Real mobility = normal_mobility(c, bodies) + dot(moment_a, inverse_inertia_times(bodies(c.a), moment_a));
  if (c.is_pair()) {
    const Vec3 moment_b = cross(arms.b, t);
    mobility += dot(moment_b, inverse_inertia_times(bodies(c.b), moment_b));
  }
  return mobility;
}

/// Tangential part of the velocity of a's surface relative to b's, for centres that move at `velocity`.
KOKKOS_INLINE_FUNCTION Vec3 slip_velocity(const Contact& c, const Bodies& bodies, const Arms& arms, Vec3 n,
                                          Vec3 velocity) {
  Vec3 u = velocity + cross(bodies(c.a).angular_velocity, arms.a);
  if (c.is_pair()) u -= cross(bodies(c.b).angular_velocity, arms.b);
  return u - dot(n, u) * n;
}

/// Part of the spin of a relative to b that rolls a over b.
KOKKOS_INLINE_FUNCTION Vec3 rolling_spin(const Contact& c, const Bodies& bodies, Vec3 n) {
  Vec3 w = bodies(c.a).angular_velocity;
  if (c.is_pair()) w -= bodies(c.b).angular_velocity;
  return w - dot(n, w) * n;
}

/// Change of the relative spin about the unit vector t per couple about t.
KOKKOS_INLINE_FUNCTION Real rolling_mobility(const Contact& c, const Bodies& bodies, Vec3 t) {
  Real mobility = dot(t, inverse_inertia_times(bodies(c.a), t));
  if (c.is_pair()) mobility += dot(t, inverse_inertia_times(bodies(c.b), t));
  return mobility;
}

KOKKOS_INLINE_FUNCTION void apply_couple_to_both(const Contact& c, const Bodies& bodies, Vec3 couple,
                                                 Real remaining) {
  apply_couple(bodies(c.a), couple, remaining);
  if (c.is_pair()) apply_couple(bodies(c.b), -couple, remaining);
}

/// v scaled down to length limit, if it is longer.
KOKKOS_INLINE_FUNCTION Vec3 limited(Vec3 v, Real limit) {
  const Real length = norm(v);
  return length > limit ? (limit / length) * v : v;
}

/// Stop the rolling as far as a couple of mu_r R* times the normal impulse can, given the couple so far.
/// Returns the change of the speed at which the surfaces roll.
KOKKOS_INLINE_FUNCTION Real resist_rolling(const Contact& c, const Bodies& bodies, Vec3 n, Real normal,
                                           Real remaining, Vec3& couple) {
  const Vec3 spin = rolling_spin(c, bodies, n);
  const Real speed = norm(spin);
  const Real mobility = speed > 0 ? rolling_mobility(c, bodies, spin / speed) : 0;
  const Vec3 wanted = mobility > 0 ? couple - spin / mobility : couple;
  const Vec3 allowed = limited(wanted, c.material.rolling_friction * c.effective_radius() * normal);
  const Vec3 change = allowed - couple;
  couple = allowed;
  apply_couple_to_both(c, bodies, change, remaining);
  return mobility * norm(change) * c.effective_radius();
}

/// What counts as an impact; slower contacts are left to the sustained force.
struct ImpactRule {
  Real dt = 0;
  Real slowest = 0;  // speed of approach below which nothing is an impact: round-off
};

/// Resting speed 2 a dt with a the larger acceleration of the two: what one substep may build up in a contact
/// that stays closed. Such contacts are not bounced [Guendelman2003].
KOKKOS_INLINE_FUNCTION Real resting_speed(const Contact& c, const Bodies& bodies, Real dt) {
  const Vec3 a = bodies(c.a).acceleration, b = c.is_pair() ? bodies(c.b).acceleration : Vec3{};
  return 2 * dt * Kokkos::sqrt(Kokkos::max(dot(a, a), dot(b, b)));
}

/// Impact at the moment of touch, found on the path that leads to the present end of the substep. Normal
/// impulse (1 + e) v_n / w_n; tangential impulse (1 + beta) v_t / w_t, at most mu times the normal one
/// [Walton1993]. Returns whether there was an impact.
KOKKOS_INLINE_FUNCTION bool resolve_impact(Contact& c, const Bodies& bodies, const ImpactRule& rule) {
  const RelativeMotion end = relative_motion(c, bodies);
  const bool is_free = !bodies(c.a).is_deflected && !(c.is_pair() && bodies(c.b).is_deflected);
  const Real inside = time_of_overlap(c, end, is_free, rule.dt);
  if (inside < 0) return false;
  const Real s = find_closed_time(c, end, inside, rule.dt);
  const RelativeMotion touch = end.before(s);
  const Vec3 n = normal_of(c, touch.distance);
  const Real approach = -dot(n, touch.velocity);
  if (!(approach > Kokkos::max(rule.slowest, resting_speed(c, bodies, rule.dt)))) return false;

  const Real normal = (1 + c.material.restitution) * approach / normal_mobility(c, bodies);
  Vec3 impulse = normal * n;
  const Arms arms(c, n, length_of(c, touch.distance));
  if (c.material.friction > 0) {
    const Vec3 slip = slip_velocity(c, bodies, arms, n, touch.velocity);
    const Real speed = norm(slip);
    if (speed > 0) {
      const Vec3 t = slip / speed;
      const Real sticking =
          (1 + c.material.tangential_restitution) * speed / tangential_mobility(c, bodies, arms, t);
      impulse -= Kokkos::min(sticking, c.material.friction * normal) * t;
    }
  }
  apply_to_both(c, bodies, impulse, arms, s);
  if (c.material.rolling_friction > 0) {
    Vec3 couple;
    resist_rolling(c, bodies, n, normal, s, couple);
  }
  c.normal = n;
  c.closed_time = s;
  c.impact_impulse += impulse;
  return true;
}

/// Overlap (relative to the reach) within which a contact that carried a force is taken as still closed.
inline constexpr Real closed_tolerance = 1e-4;

/// Decide whether the contact is closed in the last part of the substep, and for how long. The force then
/// acts along the line of centres at the middle of that time, which conserves angular momentum; the approach
/// must stop along the line of centres at the end, so that spheres that roll over each other neither part nor
/// overlap.
KOKKOS_INLINE_FUNCTION void close_contact(Contact& c, const Bodies& bodies, Real dt) {
  const RelativeMotion end = relative_motion(c, bodies);
  const bool persists = c.carried_force > 0 && c.gap <= closed_tolerance * c.reach;
  const bool overlaps = gap_of(c, end.distance) < 0;
  if (!overlaps && !persists) {
    c.closed_time = 0;  // bounced off, or never met
    return;
  }
  if (persists)
    c.closed_time = dt;
  else if (c.closed_time == 0)
    c.closed_time = find_closed_time(c, end, 0, dt);
  const RelativeMotion touch = end.before(c.closed_time);
  const Vec3 middle = touch.distance + (0.5 * c.closed_time) * touch.velocity;
  c.normal = normal_of(c, middle);
  c.closed_length = length_of(c, middle);
  c.end_normal = normal_of(c, end.distance);
}

/// Start from the force of the last substep. (That is its impulse over the whole substep: over the closed
/// time, which may be arbitrarily short, it would not be a force that goes on.)
KOKKOS_INLINE_FUNCTION void apply_carried_force(Contact& c, const Bodies& bodies) {
  if (c.closed_time == 0 || c.carried_force == 0) return;
  c.normal_impulse = c.closed_time * c.carried_force;
  const Vec3 friction = c.closed_time * c.carried_friction;
  c.tangential_impulse =
      limited(friction - dot(c.normal, friction) * c.normal, c.material.friction * c.normal_impulse);
  apply_to_both(c, bodies, c.normal_impulse * c.normal + c.tangential_impulse,
                Arms(c, c.normal, c.closed_length), 0.5 * c.closed_time);
}

/// One Gauss-Seidel update of the force of a closed contact: no approach at the end of the substep, force not
/// negative; no slip, friction at most mu times the normal force. Returns the change of the relative
/// velocity.
KOKKOS_INLINE_FUNCTION Real update_sustained_force(Contact& c, const Bodies& bodies, Real dt) {
  if (c.closed_time == 0) {
    close_contact(c, bodies, dt);
    if (c.closed_time == 0) return 0;
  }
  const Vec3 n = c.normal;
  const Real mobility = normal_mobility(c, bodies);
  const Vec3 velocity = relative_motion(c, bodies).velocity;
  const Real separation = dot(c.end_normal, velocity) / dot(c.end_normal, n);
  const Real normal = Kokkos::max(Real{0}, c.normal_impulse - separation / mobility);
  Vec3 change = (normal - c.normal_impulse) * n;
  Real response = mobility * Kokkos::abs(normal - c.normal_impulse);
  c.normal_impulse = normal;
  const Arms arms(c, c.normal, c.closed_length);
  if (c.material.friction > 0) {
    const Vec3 slip = slip_velocity(c, bodies, arms, n, velocity);
    const Real speed = norm(slip);
    const Real tangential = speed > 0 ? tangential_mobility(c, bodies, arms, slip / speed) : mobility;
    const Vec3 friction = limited(c.tangential_impulse - slip / tangential, c.material.friction * normal);
    response += tangential * norm(friction - c.tangential_impulse);
    change += friction - c.tangential_impulse;
    c.tangential_impulse = friction;
  }
  if (response > 0) apply_to_both(c, bodies, change, arms, 0.5 * c.closed_time);
  if (c.material.rolling_friction > 0)
    response += resist_rolling(c, bodies, n, normal, 0.5 * c.closed_time, c.rolling_couple);
  return response;
}

/// Push an overlapping pair apart along the line of centres, by shares of the inverse masses; velocities
/// stay. Returns the overlap found, relative to the smaller radius.
KOKKOS_INLINE_FUNCTION Real separate(const Contact& c, const Bodies& bodies) {
  const Vec3 distance = center_distance(c, bodies);
  const Real overlap = -gap_of(c, distance);
  if (!(overlap > 0)) return 0;
  const Vec3 push = (overlap / normal_mobility(c, bodies)) * normal_of(c, distance);
  displace(bodies(c.a), push);
  if (c.is_pair()) displace(bodies(c.b), -push);
  const Real share = Kokkos::min(c.share, c.is_pair() ? 1 - c.share : c.share);
  return overlap / (share * c.reach);
}

}  // namespace peclet::dem
