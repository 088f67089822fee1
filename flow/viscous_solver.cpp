#include "flow/viscous_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace peclet::flow {
namespace {

/// Sweeps between two evaluations of the residual in double precision.
constexpr int sweeps_per_cycle_limit = 40;
/// Reduction that single-precision sweeps can deliver in one cycle.
constexpr Real cycle_reduction_limit = 1e-5;

template <class T>
struct Diffusion {
  T x, y, z;  // theta dt nu / h^2
  T diagonal;

  explicit Diffusion(const ViscousSystem& system) {
    T along[3];
    for (int a = 0; a < 3; ++a)
      along[a] = static_cast<T>(system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]));
    x = along[0];
    y = along[1];
    z = along[2];
    diagonal = 1 + 2 * (x + y + z);
  }
  KOKKOS_INLINE_FUNCTION T along(int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
};

/// First sweep from e = 0: e = scale * residual.
struct FirstSweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const Real* residual;
  float* e;
  float scale;

  struct Row {
    const Real* residual;
    float* e;
    float scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { e[i] = scale * static_cast<float>(residual[i]); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {residual + n, e + n, scale};
  }
};

/// next = (1 - weight) e + scale (residual + neighbours).
struct Sweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const Real* residual;
  const float* e;
  float* next;
  Diffusion<float> d;
  float keep, scale;

  struct Row {
    const Real* residual;
    const float* e;
    float* next;
    Index sy, sz;
    float x, y, z, keep, scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float neighbors =
          x * (e[i - 1] + e[i + 1]) + y * (e[i - sy] + e[i + sy]) + z * (e[i - sz] + e[i + sz]);
      next[i] = keep * e[i] + scale * (static_cast<float>(residual[i]) + neighbors);
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {residual + n, e + n, next + n, layout.pitch_y, layout.pitch_z, d.x, d.y, d.z, keep, scale};
  }
};

/// residual -= A e and correction += e (or = e) in double precision.
struct Accumulate {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  Layout layout;
  const float* e;
  Real *residual, *correction;
  Diffusion<Real> d;
  bool is_first;

  struct Row {
    const float* e;
    Real *residual, *correction;
    Index sy, sz;
    Real x, y, z, diagonal;
    bool is_first;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const Real here = e[i];
      const Real neighbors = x * (Real{e[i - 1]} + Real{e[i + 1]}) + y * (Real{e[i - sy]} + Real{e[i + sy]}) +
                             z * (Real{e[i - sz]} + Real{e[i + sz]});
      residual[i] += neighbors - diagonal * here;
      correction[i] = is_first ? here : correction[i] + here;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {e + n, residual + n, correction + n, layout.pitch_y, layout.pitch_z, d.x,
            d.y,   d.z,          d.diagonal,     is_first};
  }
};

/// The residual of fluid points.
struct FluidResidual {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const Real* residual;

  struct Row {
    const OpenFraction* open;
    const Real* residual;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const { return open[i] ? residual[i] : 0.0; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n};
  }
};

Norms residual_norms(const ViscousSystem& system, const Field<Real>& residual) {
  const FluidResidual body{residual.layout(), system.open.data(), residual.data()};
  return sweep("flow::viscous_residual_norm", *system.plan, Stage{system.rows, body});
}

/// Row of a wall in (1 - theta dt nu L): sum of weighted fluid neighbours and diagonal.
template <class T>
struct WallRow {
  T neighbors = 0, diagonal = 1;

  KOKKOS_INLINE_FUNCTION WallRow(const WallRows& rows, Index row, const Field<float>& e,
                                 const Diffusion<T>& diffusion) {
    const Index p = rows.face(row);
    for (int d = 0; d < WallRows::directions; ++d) {
      const T coefficient = diffusion.along(d / 2) * static_cast<T>(rows.weight(row, d));
      const Index step = e.layout().stride(d / 2);
      diagonal += coefficient;
      if (!rows.is_wall(row, d)) neighbors += coefficient * static_cast<T>(e[d % 2 ? p + step : p - step]);
    }
  }
};

/// First sweep from e = 0 at walls.
void start_wall_rows(const ViscousSystem& system, const WallRows& rows, const Field<Real>& residual,
                     float weight, const Field<float>& e) {
  const Diffusion<float> diffusion(system);
  const WallRows w = rows;
  for_each(
      "flow::viscous_start_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        float diagonal = 1;
        for (int d = 0; d < WallRows::directions; ++d) diagonal += diffusion.along(d / 2) * w.weight(row, d);
        const Index p = w.face(row);
        e[p] = weight * static_cast<float>(residual[p]) / diagonal;
      });
}

void sweep_wall_rows(const ViscousSystem& system, const WallRows& rows, const Field<Real>& residual,
                     float weight, const Field<float>& e, const Field<float>& next) {
  const Diffusion<float> diffusion(system);
  const WallRows w = rows;
  for_each(
      "flow::viscous_sweep_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        const Index p = w.face(row);
        const WallRow<float> wall(w, row, e, diffusion);
        next[p] = e[p] + weight * ((static_cast<float>(residual[p]) + wall.neighbors) / wall.diagonal - e[p]);
      });
}

/// At wall rows the regular formula was not the operator: undone and done right.
void correct_residual_at_walls(const ViscousSystem& system, const WallRows& rows, const Field<float>& e,
                               const Field<Real>& residual) {
  const Diffusion<Real> diffusion(system);
  const WallRows w = rows;
  const Field<Real> r = residual;
  for_each(
      "flow::viscous_residual_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        const Index p = w.face(row);
        const WallRow<Real> wall(w, row, e, diffusion);
        Real regular = 0;
        for (int d = 0; d < WallRows::directions; ++d) {
          const Index step = e.layout().stride(d / 2);
          regular += diffusion.along(d / 2) * Real{e[d % 2 ? p + step : p - step]};
        }
        r[p] += (wall.neighbors - regular) - (wall.diagonal - diffusion.diagonal) * Real{e[p]};
      });
}

Spectrum bound_spectrum(const ViscousSystem& system) {
  Real regular = 0, walled = 0;  // sums of the off-diagonal part
  for (int a = 0; a < 3; ++a) {
    const Real along = 2 * system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
    const bool at_wall = a != system.component && (system.sides.side[a][0].prescribes_velocity() ||
                                                   system.sides.side[a][1].prescribes_velocity());
    regular += along;
    walled += at_wall ? 8.0 / 3 * along : 2 * along;
  }
  const Real low = 1 / (1 + regular), high = (1 + walled) / (1 + regular);
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// Sweeps needed by Chebyshev iteration for a reduction: 1 / T_m(middle / half width) <= reduction.
int chebyshev_sweeps(const Spectrum& spectrum, Real reduction) {
  if (spectrum.half_width <= 0) return 1;
  const Real per_sweep = std::acosh(spectrum.middle / spectrum.half_width);
  return std::max(1, static_cast<int>(std::ceil(std::acosh(1 / reduction) / per_sweep)));
}

/// Weight of sweep m of n: inverse of a root of T_n on the spectrum, in an order that keeps intermediate
/// iterates small (pairs from both ends).
float chebyshev_weight(int m, int n, const Spectrum& spectrum) {
  const int root = m % 2 == 0 ? m / 2 : n - 1 - m / 2;
  const Real cosine = std::cos(std::numbers::pi * (2 * root + 1) / (2.0 * n));
  return static_cast<float>(1 / (spectrum.middle - spectrum.half_width * cosine));
}

}  // namespace

ViscousSolver::ViscousSolver(const Layout& layout)
    : iterate_("flow::viscous_iterate", layout), next_("flow::viscous_next", layout) {}

std::size_t ViscousSolver::bytes() const { return 2 * sizeof(float) * iterate_.array().extent(0); }

SolverReport ViscousSolver::solve(const ViscousSystem& system, const Field<Real>& residual,
                                  const Field<Real>& correction, Real relative_tolerance, Real velocity_scale,
                                  int iteration_limit, Real& residual_sum) {
  const Spectrum spectrum = bound_spectrum(system);
  SolverReport report;
  Norms norms = residual_norms(system, residual);
  const Real scale = std::max(velocity_scale, norms.largest);
  const Real tolerance = relative_tolerance * scale;
  bool is_first = true;
  while (is_first ||
         (norms.largest > tolerance && report.iterations < iteration_limit && std::isfinite(norms.sum))) {
    const Real wanted = norms.largest > 0 ? 0.5 * tolerance / norms.largest : 0.5;
    const int sweeps = std::min({chebyshev_sweeps(spectrum, std::clamp(wanted, cycle_reduction_limit, 0.5)),
                                 sweeps_per_cycle_limit, iteration_limit - report.iterations});
    run_sweeps(system, residual, sweeps, spectrum);
    const Accumulate body{residual.layout(), iterate_.data(),         residual.data(),
                          correction.data(), Diffusion<Real>(system), is_first};
    sweep("flow::viscous_residual", *system.plan, Stage{system.rows, body});
    correct_residual_at_walls(system, system.fixed_rows, iterate_, residual);
    correct_residual_at_walls(system, system.moving_rows, iterate_, residual);
    report.iterations += sweeps;
    norms = residual_norms(system, residual);
    is_first = false;
  }
  report.residual = scale > 0 ? norms.largest / scale : 0;
  report.converged = norms.largest <= tolerance;
  residual_sum = norms.sum;
  return report;
}

void ViscousSolver::run_sweeps(const ViscousSystem& system, const Field<Real>& residual, int sweeps,
                               const Spectrum& spectrum) {
  const Layout& layout = residual.layout();
  const Diffusion<float> diffusion(system);
  const float first = chebyshev_weight(0, sweeps, spectrum);
  sweep("flow::viscous_start", *system.plan,
        Stage{system.rows, FirstSweep{layout, residual.data(), iterate_.data(), first / diffusion.diagonal}});
  start_wall_rows(system, system.fixed_rows, residual, first, iterate_);
  start_wall_rows(system, system.moving_rows, residual, first, iterate_);
  for (int m = 1; m < sweeps; ++m) {
    const float weight = chebyshev_weight(m, sweeps, spectrum);
    fill_correction_ghosts(iterate_, system.component, system.sides);
    const Sweep body{layout,
                     residual.data(),
                     iterate_.data(),
                     next_.data(),
                     diffusion,
                     1.0F - weight,
                     weight / diffusion.diagonal};
    sweep("flow::viscous_sweep", *system.plan, Stage{system.rows, body});
    sweep_wall_rows(system, system.fixed_rows, residual, weight, iterate_, next_);
    sweep_wall_rows(system, system.moving_rows, residual, weight, iterate_, next_);
    std::swap(iterate_, next_);
  }
  fill_correction_ghosts(iterate_, system.component, system.sides);
}

}  // namespace peclet::flow
