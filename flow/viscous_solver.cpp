#include "flow/viscous_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "flow/fluid_residual.hpp"
#include "flow/viscous_sweeps.hpp"

namespace peclet::flow {
namespace {

/// Sweeps between two evaluations of the residual in double precision.
constexpr int sweeps_per_cycle_limit = 40;
/// Where more sweeps would be needed in all, multigrid is faster.
constexpr int sweeps_limit = 80;
/// Reduction that single-precision sweeps can deliver in one cycle.
constexpr Real cycle_reduction_limit = 1e-5;

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

/// residual -= A e and correction += e (or = e); returns the norms of the residual that is left.
template <bool is_first>
Norms subtract_product(const ViscousSystem& system, const Field<float>& e, const Field<Real>& residual,
                       const Field<Real>& correction) {
  if (system.is_advected())
    return sweep("flow::advected_residual", *system.plan,
                 advected_residual_stage<is_first>(system, e, residual, correction));
  return sweep("flow::viscous_residual", *system.plan,
               residual_stage<is_first>(system, e, residual, correction));
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

}  // namespace

ViscousSolver::ViscousSolver(const Layout& layout)
    : rhs_("flow::viscous_rhs", layout),
      iterate_("flow::viscous_iterate", layout),
      next_("flow::viscous_next", layout) {}

std::size_t ViscousSolver::bytes() const {
  return 3 * sizeof(float) * iterate_.array().extent(0) + (multigrid_ ? multigrid_->bytes() : 0) +
         (krylov_ ? krylov_->bytes() : 0);
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
  // rows of scalars in small cut cells are beyond multigrid
  const bool is_velocity = system.component >= 0;
  const bool is_stiff =
      system.is_advected() ||
      (is_velocity && chebyshev_sweeps(spectrum, wanted_reduction(std::numeric_limits<Real>::min())) >
                          std::min(sweeps_limit, iteration_limit));
  if (is_stiff) prepare_multigrid(system);
  bool is_first = true, cycles_suffice = is_stiff && multigrid_->is_solver(system);
  int setbacks = 0, cycles_at_once = 1;
  while (is_first || (norms.largest > tolerance && report.iterations < iteration_limit && setbacks < 2 &&
                      std::isfinite(norms.sum))) {
    const Real before = norms.largest, wanted = wanted_reduction(cycle_reduction_limit);
    const int left = iteration_limit - report.iterations;
    const auto cycle = [&](auto first) {
      if (cycles_suffice) {
        const int cycles = std::min(cycles_at_once, left);
        report.iterations += cycles;
        return multigrid_cycle<first>(system, residual, correction, cycles);
      }
      if (is_stiff) return krylov_cycle<first>(system, residual, correction, before, wanted, left, report);
      const int sweeps = std::min({chebyshev_sweeps(spectrum, wanted), sweeps_per_cycle_limit, left});
      report.iterations += sweeps;
      return run_sweeps<first>(system, residual, correction, sweeps, spectrum);
    };
    norms = is_first ? cycle(std::true_type()) : cycle(std::false_type());
    // What a cycle leaves of the residual. Where one more will not do, two share a residual in double
    // precision.
    const Real left_by_one = std::pow(norms.largest / before, 1.0 / cycles_at_once);
    cycles_at_once = cycles_suffice && left_by_one * norms.largest > tolerance ? 2 : 1;
    if (is_stiff && left_by_one > 0.5 && ++setbacks == 2 && cycles_suffice) {
      cycles_suffice = false;
      setbacks = 0;
      cycles_at_once = 1;
    }
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

void ViscousSolver::prepare_multigrid(const ViscousSystem& system) {
  if (!multigrid_ || !multigrid_->fits(system.sides))
    multigrid_ = std::make_shared<ViscousMultigrid>(system.grid, system.sides);
  multigrid_->set_system(system);
}

template <bool is_first>
Norms ViscousSolver::multigrid_cycle(const ViscousSystem& system, const Field<Real>& residual,
                                     const Field<Real>& correction, int cycles) {
  multigrid_->apply(system, residual, cycles);
  return subtract_product<is_first>(system, multigrid_->correction(), residual, correction);
}

template <bool is_first>
Norms ViscousSolver::krylov_cycle(const ViscousSystem& system, const Field<Real>& residual,
                                  const Field<Real>& correction, Real largest, Real wanted, int limit,
                                  SolverReport& report) {
  if (!krylov_) krylov_ = std::make_shared<ViscousKrylov>(system.layout());
  // what rounding of the iterate leaves of the residual
  const Real attainable = std::numeric_limits<float>::epsilon() * multigrid_->largest_diagonal(system);
  const Real reduction = std::min(0.25, std::max(wanted, attainable));
  report.iterations +=
      krylov_->solve(system, *multigrid_, residual, largest, reduction, limit, iterate_, next_);
  return subtract_product<is_first>(system, iterate_, residual, correction);
}

template <bool is_first>
Norms ViscousSolver::run_sweeps(const ViscousSystem& system, const Field<Real>& residual,
                                const Field<Real>& correction, int sweeps, const Spectrum& spectrum) {
  const Field<float> iterates[2] = {iterate_, next_};
  const auto first = first_sweep(system, residual, rhs_, iterate_, chebyshev_weight(0, sweeps, spectrum));
  const auto repeated = [&](int m) {
    return next_sweep(system, rhs_, iterates[m % 2], iterates[(m + 1) % 2],
                      chebyshev_weight(m + 1, sweeps, spectrum));
  };
  const auto last = residual_stage<is_first>(system, iterates[(sweeps - 1) % 2], residual, correction);
  return sweep_series("flow::viscous_sweeps", *system.plan, first, sweeps - 1, repeated, last);
}

}  // namespace peclet::flow
