#pragma once
// The momentum predictor. With r = dt / dt_old, extrapolated velocity v = u + r/2 (u - u_old) (at the middle
// of the step) and correction e, the predicted velocity is u* = u + r (u - u_old) + e, where
//   (u* - u) / dt = -A(v) - grad p / rho + f / rho + nu L (v + theta e).
// v + theta e is second order in time at the middle of the step for every theta; stiff modes are damped to
// 1/3 per step by theta = 9/16 [AscherRuuthWetton1995, modified Crank-Nicolson]. The first step, which has no
// past, is a step of Euler's method: r = 0, theta = 1. Where the time step grows more than twofold at once, a
// share (2 / r)^2 of the extrapolation is left, r becomes 4 / r, and theta moves towards 1 alike: with the
// whole of it, time steps that alternate by more than a factor of 8 are unstable.
// At a wall whose velocity changes from U_old to U, v + theta e is U_old + w (U - U_old). Where the motion is
// prescribed, w = s / 2 + theta (1 - s), s being the share of the extrapolation: 1 in the first step and 1/2
// later, which is second order. Where it follows from the forces, w = 1: by an explicit exchange the fluid is
// given the velocity of the beginning of the step, which is late enough.
#include "core/field.hpp"
#include "core/sweep.hpp"
#include "flow/advection_schemes.hpp"
#include "flow/settings.hpp"
#include "flow/time_weights.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// Everything that the predictor of one component reads.
struct MomentumTerms {
  Grid grid;
  FaceVector<Real> extrapolated;  // v, ghosts filled; wall velocity inside bodies
  FaceVector<Real> velocity;      // u
  FaceVector<Real> previous;      // u_old
  Field<Real> pressure;           // ghosts filled
  Real time_step = 1, density = 1, kinematic_viscosity = 0;
  Real step_ratio = 0;          // r
  Real implicit_weight = 1;     // theta
  Real wall_weight = 1;         // of the present velocity of walls in their velocity in v + theta e
  Real3 acceleration{0, 0, 0};  // f / rho
  AdvectionScheme scheme = AdvectionScheme::None;
};

/// extrapolated = u + r/2 (u - u_old); returns its largest component. plan and rows: of each component.
Real extrapolate_velocity(const SweepPlan (&plan)[3], const RowRanges (&rows)[3],
                          const FaceVector<Real>& velocity, const FaceVector<Real>& previous, Real step_ratio,
                          const FaceVector<Real>& extrapolated);

/// previous = u + r (u - u_old) + e + left_over: the predicted velocity takes the place of the oldest one.
/// left_over is the mean of what the viscous solver left of its residual: the fluid would lose that momentum.
void apply_correction(const SweepPlan& plan, const RowRanges& rows, Real step_ratio,
                      const Field<Real>& velocity, const Field<Real>& correction, Real left_over,
                      const Field<Real>& previous);

/// residual = u + dt (-A(v) - grad p / rho + f / rho + nu L v) - (u + r (u - u_old)): what e must balance.
/// rows begin on whole vectors. With advection, advective_leak comes before.
void compute_momentum_residual(int c, const MomentumTerms& terms, const SweepPlan& plan,
                               const RowRanges& rows, const WallRows& fixed_rows, const WallRows& moving_rows,
                               const Field<Real>& residual);

/// Sum over the fluid of A(v) of component c: fluxes between fluid points cancel, those towards walls and
/// the wall rows' v_c div(v) do not. This error, of first order in the spacing, is momentum that neither the
/// fluid nor a body would have; it is returned to the fluid as a uniform acceleration. Leaves v_c div(v) in
/// the wall rows.
Real advective_leak(int c, const MomentumTerms& terms, const WallRows& fixed_rows,
                    const WallRows& moving_rows);

/// No flux: Stokes flow.
struct NoAdvection {};

/// Flux of the transported velocity q through the low face of its control volume along an axis: mean of the
/// carrying velocity of the two points beside the face, times the value that the scheme carries.
/// own and step: steps of the linear index along the axis of q and along the axis of the face.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real momentum_flux_low(const Real* q, const Real* carrying, Index p, Index own,
                                              Index step) {
  const Real carrier = 0.5 * (carrying[p - own] + carrying[p]);
  return carrier * carried_value<Scheme>(carrier, q[p - 2 * step], q[p - step], q[p], q[p + step]);
}

template <>
KOKKOS_INLINE_FUNCTION Real momentum_flux_low<NoAdvection>(const Real*, const Real*, Index, Index, Index) {
  return 0;
}

/// Divergence of the carrying velocity in the control volume of face p.
KOKKOS_INLINE_FUNCTION Real carrier_divergence(const FaceVector<Real>& v, int c, Index p,
                                               const Real3& inverse_spacing) {
  const Layout& layout = v.x.layout();
  const Index own = layout.stride(c);
  Real divergence = 0;
  for (int a = 0; a < 3; ++a) {
    const Index high = p + layout.stride(a);
    divergence += inverse_spacing[a] * 0.5 * (v[a][high - own] + v[a][high] - v[a][p - own] - v[a][p]);
  }
  return divergence;
}

}  // namespace peclet::flow
