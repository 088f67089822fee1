#include "flow/momentum.hpp"

namespace peclet::flow {

namespace {

/// u + r/2 (u - u_old)
struct Extrapolation {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const Real *velocity, *previous;
  Real* extrapolated;
  Real half_ratio;

  struct Row {
    const Real *velocity, *previous;
    Real* extrapolated;
    Real half_ratio;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const {
      const Real value = velocity[i] + half_ratio * (velocity[i] - previous[i]);
      extrapolated[i] = value;
      return value;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {velocity + n, previous + n, extrapolated + n, half_ratio};
  }
};

/// u + r (u - u_old) + e + left_over
struct Correction {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  Layout layout;
  const Real *velocity, *correction;
  Real* previous;
  Real ratio, left_over;

  struct Row {
    const Real *velocity, *correction;
    Real* previous;
    Real ratio, left_over;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      previous[i] = velocity[i] + ratio * (velocity[i] - previous[i]) + (correction[i] + left_over);
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {velocity + n, correction + n, previous + n, ratio, left_over};
  }
};

/// L at a wall less the regular L.
KOKKOS_INLINE_FUNCTION Real laplacian_correction(const WallRows& rows, Index row, const Field<Real>& q,
                                                 Index p, const Real3& inverse_square) {
  const Layout& layout = q.layout();
  Real sum = rows.wall_sum(row);
  for (int d = 0; d < WallRows::directions; ++d) {
    const Index step = layout.stride(d / 2);
    const Real weight = rows.weight(row, d), neighbor = q[d % 2 ? p + step : p - step];
    const Real weighted = rows.is_wall(row, d) ? -neighbor : (weight - 1) * neighbor;
    sum += inverse_square[d / 2] * (weighted - (weight - 1) * q[p]);
  }
  return sum;
}

struct InverseSpacing {
  Real3 first, square;

  explicit InverseSpacing(const Grid& grid) {
    for (int a = 0; a < 3; ++a) {
      first[a] = 1 / grid.spacing[a];
      square[a] = first[a] * first[a];
    }
  }
};

/// Residual of component c on the regular grid; walls are put right afterwards.
template <class Scheme, int c>
struct GridResidual {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  MomentumTerms terms;
  InverseSpacing inverse;
  Real* residual;

  struct Row {
    const Real *q, *vx, *vy, *vz;  // transported and carrying velocities
    const Real *velocity, *previous, *pressure;
    Real* residual;
    Index sy, sz;
    Real fx, fy, fz;  // dt / h
    Real dx, dy, dz;  // dt nu / h^2
    Real pressure_scale, forcing, ratio;

    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const Index own = c == 0 ? 1 : (c == 1 ? sy : sz);
      const Real advection = fx * (momentum_flux_low<Scheme>(q, vx, i + 1, own, 1) -
                                   momentum_flux_low<Scheme>(q, vx, i, own, 1)) +
                             fy * (momentum_flux_low<Scheme>(q, vy, i + sy, own, sy) -
                                   momentum_flux_low<Scheme>(q, vy, i, own, sy)) +
                             fz * (momentum_flux_low<Scheme>(q, vz, i + sz, own, sz) -
                                   momentum_flux_low<Scheme>(q, vz, i, own, sz));
      const Real diffusion = dx * (q[i - 1] + q[i + 1]) + dy * (q[i - sy] + q[i + sy]) +
                             dz * (q[i - sz] + q[i + sz]) - 2 * (dx + dy + dz) * q[i];
      residual[i] = forcing - advection - pressure_scale * (pressure[i] - pressure[i - own]) + diffusion -
                    ratio * (velocity[i] - previous[i]);
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Layout& layout = terms.pressure.layout();
    const Index n = layout(0, j, k);
    const FaceVector<Real>& v = terms.extrapolated;
    const Real dt = terms.time_step, diffusion = dt * terms.kinematic_viscosity;
    return {v[c].data() + n,
            v.x.data() + n,
            v.y.data() + n,
            v.z.data() + n,
            terms.velocity[c].data() + n,
            terms.previous[c].data() + n,
            terms.pressure.data() + n,
            residual + n,
            layout.pitch_y,
            layout.pitch_z,
            dt * inverse.first[0],
            dt * inverse.first[1],
            dt * inverse.first[2],
            diffusion * inverse.square[0],
            diffusion * inverse.square[1],
            diffusion * inverse.square[2],
            dt * inverse.first[c] / terms.density,
            dt * terms.acceleration[c],
            terms.step_ratio};
  }
};

/// What walls add to the regular residual. Beside walls the carrying velocity is not solenoidal, because
/// faces are partly closed: without the term v_c div(v) a stream that moves with the body would not stay
/// uniform.
template <bool is_advected>
struct WallResidual {
  Field<Real> transported, residual;
  WallRows rows;
  Real time_step, viscosity;
  Real3 inverse_square;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const Real laplacian = laplacian_correction(rows, row, transported, p, inverse_square);
    const Real dilation = is_advected ? rows.dilation(row) : 0.0;
    residual[p] += time_step * (viscosity * laplacian + dilation);
  }
};

/// Momentum per unit time, density and volume that advection takes out of the fluid at wall rows.
template <class Scheme>
Real leak_of_rows(int c, const MomentumTerms& terms, const WallRows& rows) {
  const FaceVector<Real> v = terms.extrapolated;
  const InverseSpacing inverse(terms.grid);
  const WallRows w = rows;
  return sum_each(
      "flow::advective_leak", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return 0.0;
        const Layout& layout = v.x.layout();
        const Index p = w.face(row), own = layout.stride(c);
        const Real dilation = v[c][p] * carrier_divergence(v, c, p, inverse.first);
        w.dilation(row) = dilation;
        Real outflow = -dilation;
        for (int d = 0; d < WallRows::directions; ++d) {
          if (!w.is_wall(row, d)) continue;
          const Index step = layout.stride(d / 2);
          const Real flux =
              momentum_flux_low<Scheme>(v[c].data(), v[d / 2].data(), d % 2 ? p + step : p, own, step);
          outflow += inverse.first[d / 2] * (d % 2 ? flux : -flux);
        }
        return outflow;
      });
}

template <class Scheme>
Real leak_of_scheme(int c, const MomentumTerms& terms, const WallRows& fixed_rows,
                    const WallRows& moving_rows) {
  return leak_of_rows<Scheme>(c, terms, fixed_rows) + leak_of_rows<Scheme>(c, terms, moving_rows);
}

template <class Scheme, int c>
void residual_of_component(const MomentumTerms& terms, const SweepPlan& plan, const RowRanges& rows,
                           const WallRows& fixed_rows, const WallRows& moving_rows,
                           const Field<Real>& residual) {
  using AtWall = WallResidual<!std::is_same_v<Scheme, NoAdvection>>;
  const InverseSpacing inverse(terms.grid);
  const auto part = [&](const WallRows& walls) {
    return AtEntries<AtWall>{walls.chains, walls.count,
                             AtWall{terms.extrapolated[c], residual, walls, terms.time_step,
                                    terms.kinematic_viscosity, inverse.square}};
  };
  sweep("flow::momentum_residual", plan,
        Stage(rows, GridResidual<Scheme, c>{terms, inverse, residual.data()}, part(fixed_rows),
              part(moving_rows)));
}

template <class Scheme>
void residual_with_scheme(int c, const MomentumTerms& terms, const SweepPlan& plan, const RowRanges& rows,
                          const WallRows& fixed_rows, const WallRows& moving_rows,
                          const Field<Real>& residual) {
  if (c == 0) residual_of_component<Scheme, 0>(terms, plan, rows, fixed_rows, moving_rows, residual);
  if (c == 1) residual_of_component<Scheme, 1>(terms, plan, rows, fixed_rows, moving_rows, residual);
  if (c == 2) residual_of_component<Scheme, 2>(terms, plan, rows, fixed_rows, moving_rows, residual);
}

}  // namespace

Real extrapolate_velocity(const SweepPlan (&plan)[3], const RowRanges (&rows)[3],
                          const FaceVector<Real>& velocity, const FaceVector<Real>& previous, Real step_ratio,
                          const FaceVector<Real>& extrapolated) {
  Real largest = 0;
  for (int c = 0; c < 3; ++c) {
    const Extrapolation body{velocity[c].layout(), velocity[c].data(), previous[c].data(),
                             extrapolated[c].data(), 0.5 * step_ratio};
    const Norms norms = sweep("flow::extrapolate_velocity", plan[c], Stage{rows[c], body});
    largest = norms.largest > largest ? norms.largest : largest;
  }
  return largest;
}

void apply_correction(const SweepPlan& plan, const RowRanges& rows, Real step_ratio,
                      const Field<Real>& velocity, const Field<Real>& correction, Real left_over,
                      const Field<Real>& previous) {
  const Correction body{velocity.layout(), velocity.data(), correction.data(),
                        previous.data(),   step_ratio,      left_over};
  sweep("flow::apply_correction", plan, Stage{rows, body});
}

void compute_momentum_residual(int c, const MomentumTerms& terms, const SweepPlan& plan,
                               const RowRanges& rows, const WallRows& fixed_rows, const WallRows& moving_rows,
                               const Field<Real>& residual) {
  switch (terms.scheme) {
    case AdvectionScheme::None:
      return residual_with_scheme<NoAdvection>(c, terms, plan, rows, fixed_rows, moving_rows, residual);
    case AdvectionScheme::SecondUpwind:
      return residual_with_scheme<SecondUpwindScheme>(c, terms, plan, rows, fixed_rows, moving_rows,
                                                      residual);
    case AdvectionScheme::Koren:
      return residual_with_scheme<KorenScheme>(c, terms, plan, rows, fixed_rows, moving_rows, residual);
    case AdvectionScheme::Central:
      return residual_with_scheme<CentralScheme>(c, terms, plan, rows, fixed_rows, moving_rows, residual);
  }
}

Real advective_leak(int c, const MomentumTerms& terms, const WallRows& fixed_rows,
                    const WallRows& moving_rows) {
  switch (terms.scheme) {
    case AdvectionScheme::SecondUpwind:
      return leak_of_scheme<SecondUpwindScheme>(c, terms, fixed_rows, moving_rows);
    case AdvectionScheme::Koren:
      return leak_of_scheme<KorenScheme>(c, terms, fixed_rows, moving_rows);
    case AdvectionScheme::Central:
      return leak_of_scheme<CentralScheme>(c, terms, fixed_rows, moving_rows);
    case AdvectionScheme::None:
      break;
  }
  return 0;
}

}  // namespace peclet::flow
