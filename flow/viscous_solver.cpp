#include "flow/viscous_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/halo.hpp"

namespace peclet::flow {
namespace {

/// Sweeps between two evaluations of the residual in double precision.
constexpr int sweeps_per_cycle_limit = 40;
/// Reduction that single-precision sweeps can deliver in one cycle.
constexpr Real cycle_reduction_limit = 1e-5;

struct Diffusion {
  float along[3];
  float inverse_diagonal;
};

Diffusion diffusion_of(const ViscousSystem& system) {
  Diffusion d{};
  Real diagonal = 1;
  for (int a = 0; a < 3; ++a) {
    const Real number = system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
    d.along[a] = static_cast<float>(number);
    diagonal += 2 * number;
  }
  d.inverse_diagonal = static_cast<float>(1 / diagonal);
  return d;
}

/// First sweep from e = 0.
void start_sweep(const ViscousSystem& system, const Field<Real>& residual, float weight, const Field<float>& e) {
  const float scale = weight * diffusion_of(system).inverse_diagonal;
  for_each_cell(
      "flow::viscous_start", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = e.layout()(i, j, k);
        e[p] = scale * static_cast<float>(residual[p]);
      });
}

/// next = e + weight D^-1 (residual - A e) on the regular grid.
void sweep(const ViscousSystem& system, const Field<Real>& residual, float weight, const Field<float>& e,
           const Field<float>& next) {
  const Diffusion d = diffusion_of(system);
  const float scale = weight * d.inverse_diagonal;
  const float keep = 1 - weight;
  for_each_cell(
      "flow::viscous_sweep", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = e.layout()(i, j, k);
        const Index sy = e.layout().pitch_y, sz = e.layout().pitch_z;
        const float neighbors = d.along[0] * (e[p - 1] + e[p + 1]) + d.along[1] * (e[p - sy] + e[p + sy]) +
                                d.along[2] * (e[p - sz] + e[p + sz]);
        next[p] = keep * e[p] + scale * (static_cast<float>(residual[p]) + neighbors);
      });
}

/// Row of a wall: sum of weighted neighbours and diagonal of 1 - diffusion L.
template <class T>
KOKKOS_INLINE_FUNCTION void wall_row(const WallRows& rows, Index row, const Field<float>& e, const T (&along)[3], T& neighbors,
                                     T& diagonal) {
  const Index p = rows.face(row);
  neighbors = 0;
  diagonal = 1;
  for (int d = 0; d < WallRows::directions; ++d) {
    const T coefficient = along[d / 2] * static_cast<T>(rows.weight(row, d));
    const Index step = e.layout().stride(d / 2);
    diagonal += coefficient;
    if (!rows.is_wall(row, d)) neighbors += coefficient * static_cast<T>(e[d % 2 ? p + step : p - step]);
  }
}

void sweep_wall_rows(const ViscousSystem& system, const WallRows& rows, const Field<Real>& residual, float weight,
                     const Field<float>& e, const Field<float>& next) {
  const Diffusion diffusion = diffusion_of(system);
  const WallRows w = rows;
  for_each(
      "flow::viscous_sweep_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        const Index p = w.face(row);
        float neighbors, diagonal;
        wall_row(w, row, e, diffusion.along, neighbors, diagonal);
        next[p] = e[p] + weight * ((static_cast<float>(residual[p]) + neighbors) / diagonal - e[p]);
      });
}

/// residual -= A e in double precision.
void subtract_operator(const ViscousSystem& system, const Field<float>& e, const Field<Real>& residual,
                       const Field<Real>& correction) {
  Real3 along;
  Real diagonal = 1;
  for (int a = 0; a < 3; ++a) {
    along[a] = system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
    diagonal += 2 * along[a];
  }
  const Field<Real> r = residual, total = correction;
  for_each_cell(
      "flow::viscous_residual", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = e.layout()(i, j, k);
        const Index sy = e.layout().pitch_y, sz = e.layout().pitch_z;
        const Real here = e[p];
        const Real neighbors = along[0] * (Real{e[p - 1]} + Real{e[p + 1]}) +
                               along[1] * (Real{e[p - sy]} + Real{e[p + sy]}) +
                               along[2] * (Real{e[p - sz]} + Real{e[p + sz]});
        r[p] += neighbors - diagonal * here;
        total[p] += here;
      });
}

/// The same at wall rows, where the regular formula above was not the operator: undone and done right.
void subtract_operator_at_walls(const ViscousSystem& system, const WallRows& rows, const Field<float>& e,
                                const Field<Real>& residual) {
  Real along[3];
  Real regular_diagonal = 1;
  for (int a = 0; a < 3; ++a) {
    along[a] = system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
    regular_diagonal += 2 * along[a];
  }
  const Real along_x = along[0], along_y = along[1], along_z = along[2];
  const WallRows w = rows;
  const Field<Real> r = residual;
  for_each(
      "flow::viscous_residual_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        const Index p = w.face(row);
        const Real per_axis[3] = {along_x, along_y, along_z};
        Real neighbors, diagonal;
        wall_row(w, row, e, per_axis, neighbors, diagonal);
        Real regular = 0;
        for (int d = 0; d < WallRows::directions; ++d) {
          const Index step = e.layout().stride(d / 2);
          regular += per_axis[d / 2] * Real{e[d % 2 ? p + step : p - step]};
        }
        r[p] += (neighbors - regular) - (diagonal - regular_diagonal) * Real{e[p]};
      });
}

MaxAndSum residual_norms(const ViscousSystem& system, const Field<Real>& residual) {
  const Field<OpenFraction> open = system.open;
  const Field<Real> r = residual;
  return max_and_sum_cells(
      "flow::viscous_residual_norm", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = r.layout()(i, j, k);
        return open[p] ? r[p] : 0.0;
      });
}

/// Sweeps needed by Chebyshev iteration for a reduction: 1 / T_m(1 / s) <= reduction.
int chebyshev_sweeps(Real s, Real reduction) {
  if (s <= 0) return 1;
  return std::max(1, static_cast<int>(std::ceil(std::acosh(1 / reduction) / std::acosh(1 / s))));
}

/// Weight of sweep m of n: inverse of a root of T_n on [1 - s, 1 + s], in an order that keeps intermediate
/// iterates small (pairs from both ends).
float chebyshev_weight(int m, int n, Real s) {
  const int root = m % 2 == 0 ? m / 2 : n - 1 - m / 2;
  return static_cast<float>(1 / (1 - s * std::cos(std::numbers::pi * (2 * root + 1) / (2.0 * n))));
}

}  // namespace

ViscousSolver::ViscousSolver(const Layout& layout)
    : iterate_("flow::viscous_iterate", layout), next_("flow::viscous_next", layout) {}

std::size_t ViscousSolver::bytes() const { return 2 * sizeof(float) * iterate_.array().extent(0); }

SolverReport ViscousSolver::solve(const ViscousSystem& system, const Periodicity& periodic, const Field<Real>& residual,
                                  const Field<Real>& correction, Real relative_tolerance, Real velocity_scale,
                                  int iteration_limit, Real& residual_sum) {
  Real spread = 0;  // b: sum of the off-diagonal part
  for (int a = 0; a < 3; ++a) spread += 2 * system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
  const Real s = spread / (1 + spread);

  correction.fill(0);
  SolverReport report;
  MaxAndSum norms = residual_norms(system, residual);
  const Real scale = std::max(velocity_scale, norms.max);
  const Real tolerance = relative_tolerance * scale;
  while (norms.max > tolerance && report.iterations < iteration_limit) {
    const Real reduction = std::clamp(0.5 * tolerance / norms.max, cycle_reduction_limit, 0.5);
    const int sweeps = std::min({chebyshev_sweeps(s, reduction), sweeps_per_cycle_limit,
                                 iteration_limit - report.iterations});
    start_sweep(system, residual, chebyshev_weight(0, sweeps, s), iterate_);
    next_.fill(0);
    // from zero, a wall row differs from the regular one by its diagonal only
    sweep_wall_rows(system, system.fixed_rows, residual, chebyshev_weight(0, sweeps, s), next_, iterate_);
    sweep_wall_rows(system, system.moving_rows, residual, chebyshev_weight(0, sweeps, s), next_, iterate_);
    for (int m = 1; m < sweeps; ++m) {
      const float weight = chebyshev_weight(m, sweeps, s);
      fill_periodic_ghosts(iterate_, periodic, 1);
      sweep(system, residual, weight, iterate_, next_);
      sweep_wall_rows(system, system.fixed_rows, residual, weight, iterate_, next_);
      sweep_wall_rows(system, system.moving_rows, residual, weight, iterate_, next_);
      std::swap(iterate_, next_);
    }
    fill_periodic_ghosts(iterate_, periodic, 1);
    subtract_operator(system, iterate_, residual, correction);
    subtract_operator_at_walls(system, system.fixed_rows, iterate_, residual);
    subtract_operator_at_walls(system, system.moving_rows, iterate_, residual);
    report.iterations += sweeps;
    norms = residual_norms(system, residual);
    if (!std::isfinite(norms.sum)) break;
  }
  report.residual = scale > 0 ? norms.max / scale : 0;
  report.converged = norms.max <= tolerance;
  residual_sum = norms.sum;
  return report;
}

}  // namespace peclet::flow
