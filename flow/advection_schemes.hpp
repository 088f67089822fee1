#pragma once
// Value of a transported quantity on the face between two neighbours, seen from the upwind side:
// far, upwind and downwind are consecutive points along the flow.
#include "core/types.hpp"
#include "flow/settings.hpp"

namespace peclet::flow {

/// q_f = q_U, first order.
struct FirstUpwindScheme {
  KOKKOS_INLINE_FUNCTION static Real face_value(Real /*far*/, Real upwind, Real /*downwind*/) {
    return upwind;
  }
};

/// q_f = 3/2 q_U - 1/2 q_UU, second order.
struct SecondUpwindScheme {
  KOKKOS_INLINE_FUNCTION static Real face_value(Real far, Real upwind, Real /*downwind*/) {
    return 1.5 * upwind - 0.5 * far;
  }
};

/// q_f = q_U + 1/2 psi(r) (q_U - q_UU), psi = max(0, min(2 r, (1 + 2 r) / 3, 2)),
/// r = (q_D - q_U) / (q_U - q_UU); written without the quotient [Koren1993].
struct KorenScheme {
  KOKKOS_INLINE_FUNCTION static Real face_value(Real far, Real upwind, Real downwind) {
    const Real behind = upwind - far, ahead = downwind - upwind;
    const Real sign = behind < 0 ? -1.0 : 1.0;
    const Real b = sign * behind, a = sign * ahead;  // b >= 0
    const Real third = (b + 2 * a) * (1.0 / 3.0);
    Real slope = 2 * a < third ? 2 * a : third;
    slope = slope < 2 * b ? slope : 2 * b;
    slope = slope > 0 ? slope : 0;
    return upwind + 0.5 * sign * slope;
  }
};

/// q_f = (q_U + q_D) / 2, second order, not dissipative.
struct CentralScheme {
  KOKKOS_INLINE_FUNCTION static Real face_value(Real /*far*/, Real upwind, Real downwind) {
    return 0.5 * (upwind + downwind);
  }
};

/// Face value between left and right for a given sign of the carrying velocity; the four points are
/// consecutive along the axis.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real carried_value(Real carrier, Real left_far, Real left, Real right,
                                          Real right_far) {
  const bool positive = carrier > 0;
  const Real far = positive ? left_far : right_far;
  const Real upwind = positive ? left : right;
  const Real downwind = positive ? right : left;
  return Scheme::face_value(far, upwind, downwind);
}

}  // namespace peclet::flow
