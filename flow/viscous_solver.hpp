#pragma once
// Solves (1 - theta dt nu L) e = residual for one velocity component, L with walls at their true distance.
//
// Chebyshev iteration on the operator scaled by its diagonal [Saad2003, section 12.3]: rows are diagonally
// dominant, so that the scaled operator has its spectrum within [1 - s, 1 + s],
// s = b / (1 + b), b = theta dt nu sum_a 2 / h_a^2. Sweeps run in single precision on the residual, which is
// then recomputed in double precision, until the largest residual falls below the tolerance.
#include "core/field.hpp"
#include "core/halo.hpp"
#include "core/sweep.hpp"
#include "flow/settings.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// One component's linear system.
struct ViscousSystem {
  Grid grid;
  Real diffusion = 0;  // theta dt nu
  const SweepPlan* plan = nullptr;
  RowRanges rows;
  Field<OpenFraction> open;  // 0: row of a solid point, left out of norms
  WallRows fixed_rows, moving_rows;
};

class ViscousSolver {
 public:
  explicit ViscousSolver(const Layout& layout);

  /// On return correction = e, residual = what is left of it, residual_sum = its sum over fluid points.
  /// Stops when the largest residual is below tolerance times velocity_scale (or times the largest residual
  /// at the start, where the fluid was at rest).
  SolverReport solve(const ViscousSystem& system, const Periodicity& periodic, const Field<Real>& residual,
                     const Field<Real>& correction, Real tolerance, Real velocity_scale, int iteration_limit,
                     Real& residual_sum);

  std::size_t bytes() const;

 private:
  /// iterate_ = e after that many sweeps from zero, ghosts filled.
  void run_sweeps(const ViscousSystem& system, const Periodicity& periodic, const Field<Real>& residual,
                  int sweeps, Real s);

  Field<float> iterate_, next_;
};

}  // namespace peclet::flow
