#pragma once
// First-order upwind advection U of a correction e by a frozen velocity v, implicit in time: per control
// volume and with the volume C = dt v / h that enters or leaves through each face,
//   dt U e = sum over faces of  inflow (e - e_neighbour)  +  e (outflow - inflow),
// the difference of conservative fluxes. At wall rows, where the faces of v do not balance, the last term is
// left out, as in compute_momentum_residual, and e is zero beyond walls: rows are diagonally dominant.
//
// As e is the change of the velocity against its extrapolation, the upwind flux adds to the explicit one only
// what is of second order in time, and nothing in a steady flow [KhoslaRubin1974, deferred correction].
#include "core/field.hpp"
#include "core/sweep_stage.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

template <class T>
struct UpwindAdvection {
  FaceVector<Real> carrier;  // v, ghosts filled
  Index own = 0;             // step of the linear index along the axis of e
  Real scale[3] = {};        // dt / (2 h)

  UpwindAdvection(const Grid& grid, const FaceVector<Real>& velocity, int c, Real time_step)
      : carrier(velocity), own(velocity.x.layout().stride(c)) {
    for (int a = 0; a < 3; ++a) scale[a] = 0.5 * time_step / grid.spacing[a];
  }
  Layout layout() const { return carrier.x.layout(); }

  /// C through the low face along axis of the control volume of p.
  KOKKOS_INLINE_FUNCTION T carried(int axis, Index p) const {
    const Field<Real>& v = carrier[axis];
    return static_cast<T>(scale[axis] * (v[p - own] + v[p]));
  }
  /// What flows into the control volume of p from direction d of WallRows.
  KOKKOS_INLINE_FUNCTION T inflow(Index p, int d) const {
    const T through = carried(d / 2, d % 2 ? p + carrier.x.layout().stride(d / 2) : p);
    return positive_part(d % 2 ? -through : through);
  }
  KOKKOS_INLINE_FUNCTION T outflow(Index p, int d) const {
    const T through = carried(d / 2, d % 2 ? p + carrier.x.layout().stride(d / 2) : p);
    return positive_part(d % 2 ? through : -through);
  }
  /// dt U e at a wall row.
  KOKKOS_INLINE_FUNCTION T at_wall_row(const WallRows& rows, Index row, const Field<float>& e) const {
    const Index p = rows.face(row);
    T sum = 0;
    for (int d = 0; d < WallRows::directions; ++d) {
      const Index step = e.layout().stride(d / 2);
      const T neighbor = rows.openness(row, d) * e[d % 2 ? p + step : p - step];
      sum += inflow(p, d) * (e[p] - neighbor);
    }
    return sum;
  }

  KOKKOS_INLINE_FUNCTION static T positive_part(T value) { return value > 0 ? value : T(0); }
  /// Part of dt U e along one axis, from C through the low and the high face.
  KOKKOS_INLINE_FUNCTION static T along_axis(T low, T high, T e, T e_low, T e_high) {
    return positive_part(low) * (e - e_low) + positive_part(-high) * (e - e_high) + (high - low) * e;
  }
};

/// target += sign dt U e on the regular grid.
template <class T>
struct AddUpwind {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  UpwindAdvection<T> upwind;
  const float* e;
  T* target;
  T sign;

  struct Row {
    const Real *vx, *vy, *vz;
    const float* e;
    T* target;
    Index own, sy, sz;
    Real fx, fy, fz;  // dt / (2 h)
    T sign;

    KOKKOS_INLINE_FUNCTION T along(const Real* v, Real f, int i, Index step) const {
      return UpwindAdvection<T>::along_axis(static_cast<T>(f * (v[i - own] + v[i])),
                                            static_cast<T>(f * (v[i + step - own] + v[i + step])), T(e[i]),
                                            T(e[i - step]), T(e[i + step]));
    }
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      target[i] += sign * (along(vx, fx, i, 1) + along(vy, fy, i, sy) + along(vz, fz, i, sz));
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Layout& layout = upwind.carrier.x.layout();
    const Index n = layout(0, j, k);
    return {upwind.carrier.x.data() + n,
            upwind.carrier.y.data() + n,
            upwind.carrier.z.data() + n,
            e + n,
            target + n,
            upwind.own,
            layout.pitch_y,
            layout.pitch_z,
            upwind.scale[0],
            upwind.scale[1],
            upwind.scale[2],
            sign};
  }
};

/// At wall rows the regular formula was not U: undone and done right.
template <class T>
struct AddWallUpwind {
  WallRows rows;
  UpwindAdvection<T> upwind;
  Field<float> e;
  Field<T> target;
  T sign;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    T regular = 0;
    for (int a = 0; a < 3; ++a) {
      const Index step = e.layout().stride(a);
      regular += UpwindAdvection<T>::along_axis(upwind.carried(a, p), upwind.carried(a, p + step), T(e[p]),
                                                T(e[p - step]), T(e[p + step]));
    }
    target[p] += sign * (upwind.at_wall_row(rows, row, e) - regular);
  }
};

/// Sum of dt U e over the fluid, e zero in walls: fluxes between fluid points cancel, so that it comes from
/// wall rows, and from the sides of the box, which are not counted.
Real upwind_leak(const UpwindAdvection<Real>& upwind, const WallRows& rows, const Field<Real>& e);

}  // namespace peclet::flow
