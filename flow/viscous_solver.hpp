#pragma once
// Solves (1 - theta dt nu L) e = residual for one velocity component, L with walls at their true distance.
//
// Chebyshev iteration on the operator scaled by its diagonal [Saad2003, section 12.3]: rows are diagonally
// dominant, so that the scaled operator has its spectrum within [1 - s, 1 + s],
// s = b / (1 + b), b = theta dt nu sum_a 2 / h_a^2; rows beside a Wall or Inflow side of the box, whose
// ghosts follow a parabola, reach further, to (1 + 8/3 b) / (1 + b). Sweeps run in single precision on the
// residual, which is then recomputed in double precision, until the largest residual falls below the
// tolerance.
#include "core/field.hpp"
#include "core/sweep.hpp"
#include "flow/domain_sides.hpp"
#include "flow/settings.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// One component's linear system.
struct ViscousSystem {
  Grid grid;
  DomainSides sides;
  int component = 0;
  Real diffusion = 0;  // theta dt nu
  const SweepPlan* plan = nullptr;
  RowRanges rows;
  Field<OpenFraction> open;  // 0: row of a solid point, left out of norms
  WallRows fixed_rows, moving_rows;
};

/// Interval that holds the eigenvalues of the scaled operator.
struct Spectrum {
  Real middle = 1, half_width = 0;
};

class ViscousSolver {
 public:
  explicit ViscousSolver(const Layout& layout);

  /// On return correction = e, residual = what is left of it, residual_sum = its sum over fluid points.
  /// Stops when the largest residual is below tolerance times velocity_scale (or times the largest residual
  /// at the start, where the fluid was at rest).
  SolverReport solve(const ViscousSystem& system, const Field<Real>& residual, const Field<Real>& correction,
                     Real tolerance, Real velocity_scale, int iteration_limit, Real& residual_sum);

  std::size_t bytes() const;

 private:
  /// iterate_ = e after that many sweeps from zero, ghosts filled.
  void run_sweeps(const ViscousSystem& system, const Field<Real>& residual, int sweeps,
                  const Spectrum& spectrum);

  Field<float> iterate_, next_;
};

}  // namespace peclet::flow
