#include "flow/viscous_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "flow/fluid_residual.hpp"

namespace peclet::flow {
namespace {

/// Sweeps between two evaluations of the residual in double precision.
constexpr int sweeps_per_cycle_limit = 40;
/// Where more sweeps would be needed in all, multigrid is faster.
constexpr int sweeps_limit = 190;
/// Reduction that single-precision sweeps can deliver in one cycle.
constexpr Real cycle_reduction_limit = 1e-5;

/// First sweep from e = 0: e = scale * residual, zero at solid points.
struct FirstSweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const Real* residual;
  float* e;
  float scale;

  struct Row {
    const OpenFraction* open;
    const Real* residual;
    float* e;
    float scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      e[i] = in_fluid(open[i], scale * static_cast<float>(residual[i]));
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n, e + n, scale};
  }
};

/// next = (1 - weight) e + scale (residual + neighbours), zero at solid points, which ghosts are taken from.
struct Sweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const Real* residual;
  const float* e;
  float* next;
  Diffusion<float> d;
  float keep, scale;

  struct Row {
    const OpenFraction* open;
    const Real* residual;
    const float* e;
    float* next;
    Index sy, sz;
    float x, y, z, keep, scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float neighbors =
          x * (e[i - 1] + e[i + 1]) + y * (e[i - sy] + e[i + sy]) + z * (e[i - sz] + e[i + sz]);
      next[i] = in_fluid(open[i], keep * e[i] + scale * (static_cast<float>(residual[i]) + neighbors));
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n, e + n, next + n, layout.pitch_y, layout.pitch_z,
            d.x,      d.y,          d.z,   keep,     scale};
  }
};

/// residual -= A e and correction += e (or = e) in double precision.
template <bool is_first>
struct Accumulate {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float* e;
  Real *residual, *correction;
  Diffusion<Real> d;

  struct Row {
    const float* e;
    Real *residual, *correction;
    Index sy, sz;
    Real x, y, z, diagonal;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const Real here = e[i];
      const Real neighbors = x * (Real{e[i - 1]} + Real{e[i + 1]}) + y * (Real{e[i - sy]} + Real{e[i + sy]}) +
                             z * (Real{e[i - sz]} + Real{e[i + sz]});
      residual[i] += neighbors - diagonal * here;
      if constexpr (is_first)
        correction[i] = here;
      else
        correction[i] += here;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {e + n, residual + n, correction + n, layout.pitch_y, layout.pitch_z, d.x, d.y, d.z, d.diagonal};
  }
};

/// First sweep from e = 0 at walls.
struct FirstWallSweep {
  WallRows rows;
  Field<Real> residual;
  Field<float> e;
  Diffusion<float> diffusion;
  float weight;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    float diagonal = 1;
    for (int d = 0; d < WallRows::directions; ++d) diagonal += diffusion.along(d / 2) * rows.weight(row, d);
    const Index p = rows.face(row);
    e[p] = weight * static_cast<float>(residual[p]) / diagonal;
  }
};

struct WallSweep {
  WallRows rows;
  Field<Real> residual;
  Field<float> e, next;
  Diffusion<float> diffusion;
  float weight;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const WallRow<float> wall(rows, row, e, diffusion);
    next[p] = e[p] + weight * ((static_cast<float>(residual[p]) + wall.neighbors) / wall.diagonal - e[p]);
  }
};

/// At wall rows the regular formula was not the operator: undone and done right.
struct WallCorrection {
  WallRows rows;
  Field<Real> residual;
  Field<float> e;
  Diffusion<Real> diffusion;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const WallRow<Real> wall(rows, row, e, diffusion);
    Real regular = 0;
    for (int d = 0; d < WallRows::directions; ++d) {
      const Index step = e.layout().stride(d / 2);
      regular += diffusion.along(d / 2) * Real{e[d % 2 ? p + step : p - step]};
    }
    residual[p] += (wall.neighbors - regular) - (wall.diagonal - diffusion.diagonal) * Real{e[p]};
  }
};

/// residual -= A e and correction += e (or = e); the result is the residual of the fluid points.
template <bool is_first>
auto residual_stage(const ViscousSystem& system, const Field<float>& e, const Field<Real>& residual,
                    const Field<Real>& correction) {
  const Layout layout = system.layout();
  const Diffusion<Real> diffusion(system);
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  return Stage(system.rows,
               Accumulate<is_first>{layout, e.data(), residual.data(), correction.data(), diffusion},
               at_walls(fixed, WallCorrection{fixed, residual, e, diffusion}),
               at_walls(moving, WallCorrection{moving, residual, e, diffusion}),
               OnRows<GhostRounding<DiffusiveWeight>>{{layout,
                                                       GhostRules(layout, system.sides, system.component),
                                                       e.data(),
                                                       residual.data(),
                                                       {{diffusion.x, diffusion.y, diffusion.z}}}},
               FluidResidual{layout, system.open.data(), residual.data()});
}

/// The same with implicit advection.
template <bool is_first>
auto advected_residual_stage(const ViscousSystem& system, const Field<float>& e, const Field<Real>& residual,
                             const Field<Real>& correction) {
  const Layout layout = system.layout();
  const Diffusion<Real> diffusion(system);
  const UpwindAdvection<Real> upwind = system.upwind<Real>();
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  return Stage(system.rows,
               Accumulate<is_first>{layout, e.data(), residual.data(), correction.data(), diffusion},
               AddUpwind<Real>{upwind, e.data(), residual.data(), -1},
               at_walls(fixed, WallCorrection{fixed, residual, e, diffusion}),
               at_walls(moving, WallCorrection{moving, residual, e, diffusion}),
               at_walls(fixed, AddWallUpwind<Real>{fixed, upwind, e, residual, -1}),
               at_walls(moving, AddWallUpwind<Real>{moving, upwind, e, residual, -1}),
               OnRows<GhostRounding<AdvectiveWeight>>{{layout,
                                                       GhostRules(layout, system.sides, system.component),
                                                       e.data(),
                                                       residual.data(),
                                                       {{diffusion.x, diffusion.y, diffusion.z}, upwind}}},
               FluidResidual{layout, system.open.data(), residual.data()});
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

/// Sweeps needed by Chebyshev iteration for a reduction: 1 / T_m(middle / half width) <= reduction in each
/// cycle of m sweeps.
int chebyshev_sweeps(const Spectrum& spectrum, Real reduction) {
  if (spectrum.half_width <= 0) return 1;
  const Real per_sweep = std::acosh(spectrum.middle / spectrum.half_width);
  Real sweeps = std::acosh(1 / reduction) / per_sweep;
  if (sweeps > sweeps_per_cycle_limit)
    sweeps = sweeps_per_cycle_limit * std::log(1 / reduction) /
             std::log(std::cosh(sweeps_per_cycle_limit * per_sweep));
  return std::max(1, static_cast<int>(std::ceil(std::min(sweeps, 1e9))));
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

std::size_t ViscousSolver::bytes() const {
  return 2 * sizeof(float) * iterate_.array().extent(0) + (krylov_ ? krylov_->bytes() : 0);
}

SolverReport ViscousSolver::solve(const ViscousSystem& system, const Field<Real>& residual,
                                  const Field<Real>& correction, Real relative_tolerance, Real velocity_scale,
                                  int iteration_limit, Real& residual_sum) {
  const Spectrum spectrum = bound_spectrum(system);
  SolverReport report;
  Norms norms =
      sweep("flow::viscous_start", *system.plan,
            Stage(system.rows, FluidResidual{system.layout(), system.open.data(), residual.data()}));
  const Real scale = std::max(velocity_scale, norms.largest);
  const Real tolerance = relative_tolerance * scale;
  const auto wanted_reduction = [&](Real least) {
    return norms.largest > 0 ? std::clamp(0.5 * tolerance / norms.largest, least, 0.5) : 0.5;
  };
  // rows of scalars in small cut cells are beyond the preconditioner
  const bool is_velocity = system.component >= 0;
  const bool is_stiff =
      system.is_advected() ||
      (is_velocity && chebyshev_sweeps(spectrum, wanted_reduction(std::numeric_limits<Real>::min())) >
                          std::min(sweeps_limit, iteration_limit));
  if (is_stiff) prepare_krylov(system);
  bool is_first = true;
  int setbacks = 0;
  while (is_first || (norms.largest > tolerance && report.iterations < iteration_limit && setbacks < 2 &&
                      std::isfinite(norms.sum))) {
    const Real before = norms.largest, wanted = wanted_reduction(cycle_reduction_limit);
    const int left = iteration_limit - report.iterations;
    const auto cycle = [&](auto first) {
      if (is_stiff) return krylov_cycle<first>(system, residual, correction, before, wanted, left, report);
      const int sweeps = std::min({chebyshev_sweeps(spectrum, wanted), sweeps_per_cycle_limit, left});
      report.iterations += sweeps;
      return run_sweeps<first>(system, residual, correction, sweeps, spectrum);
    };
    norms = is_first ? cycle(std::true_type()) : cycle(std::false_type());
    if (is_stiff && norms.largest > 0.5 * before) ++setbacks;
    is_first = false;
  }
  report.residual = scale > 0 ? norms.largest / scale : 0;
  report.converged = norms.largest <= tolerance;
  residual_sum = norms.sum;
  if (system.is_advected()) {
    const UpwindAdvection<Real> upwind = system.upwind<Real>();
    residual_sum += upwind_leak(upwind, system.fixed_rows, correction) +
                    upwind_leak(upwind, system.moving_rows, correction);
  }
  return report;
}

void ViscousSolver::prepare_krylov(const ViscousSystem& system) {
  if (!krylov_ || !krylov_->fits(system.sides))
    krylov_ = std::make_shared<ViscousKrylov>(system.grid, system.sides);
  krylov_->set_system(system);
}

template <bool is_first>
Norms ViscousSolver::krylov_cycle(const ViscousSystem& system, const Field<Real>& residual,
                                  const Field<Real>& correction, Real largest, Real wanted, int limit,
                                  SolverReport& report) {
  // what rounding of the iterate leaves of the residual
  const Real attainable = std::numeric_limits<float>::epsilon() * krylov_->largest_diagonal(system);
  const Real reduction = std::min(0.25, std::max(wanted, attainable));
  report.iterations += krylov_->solve(system, residual, largest, reduction, limit, iterate_, next_);
  if (system.is_advected())
    return sweep("flow::advected_residual", *system.plan,
                 advected_residual_stage<is_first>(system, iterate_, residual, correction));
  return sweep("flow::viscous_residual", *system.plan,
               residual_stage<is_first>(system, iterate_, residual, correction));
}

template <bool is_first>
Norms ViscousSolver::run_sweeps(const ViscousSystem& system, const Field<Real>& residual,
                                const Field<Real>& correction, int sweeps, const Spectrum& spectrum) {
  const Layout layout = system.layout();
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  const Diffusion<float> diffusion(system);
  const Field<float> iterates[2] = {iterate_, next_};

  const float first_weight = chebyshev_weight(0, sweeps, spectrum);
  const Stage first(system.rows,
                    FirstSweep{layout, system.open.data(), residual.data(), iterate_.data(),
                               first_weight / diffusion.diagonal},
                    at_walls(fixed, FirstWallSweep{fixed, residual, iterate_, diffusion, first_weight}),
                    at_walls(moving, FirstWallSweep{moving, residual, iterate_, diffusion, first_weight}),
                    ghosts_of(system, iterate_));
  const auto repeated = [&](int m) {
    const float weight = chebyshev_weight(m + 1, sweeps, spectrum);
    const Field<float>&e = iterates[m % 2], &next = iterates[(m + 1) % 2];
    return Stage(system.rows,
                 Sweep{layout, system.open.data(), residual.data(), e.data(), next.data(), diffusion,
                       1.0F - weight, weight / diffusion.diagonal},
                 at_walls(fixed, WallSweep{fixed, residual, e, next, diffusion, weight}),
                 at_walls(moving, WallSweep{moving, residual, e, next, diffusion, weight}),
                 ghosts_of(system, next));
  };
  const auto last = residual_stage<is_first>(system, iterates[(sweeps - 1) % 2], residual, correction);
  return sweep_series("flow::viscous_sweeps", *system.plan, first, sweeps - 1, repeated, last);
}

}  // namespace peclet::flow
