#pragma once
// Solves (1 + dt U - theta dt nu L) e = residual for one velocity component, L with walls at their true
// distance, U where advection is implicit.
//
// Chebyshev iteration on the operator scaled by its diagonal [Saad2003, section 12.3]. Sweeps run in single
// precision on the residual, which is then recomputed in double precision, until the largest residual falls
// below the tolerance. Where that takes many sweeps, cycles of ViscousMultigrid take their place. Where these
// converge badly, and always with U, ViscousKrylov does. An iteration is a sweep, a cycle or one of its.
#include <memory>

#include "flow/settings.hpp"
#include "flow/viscous_krylov.hpp"
#include "flow/viscous_sweeps.hpp"

namespace peclet::flow {

class ViscousSolver {
 public:
  explicit ViscousSolver(const Layout& layout);

  /// On return correction = e, residual = what is left of it, residual_sum = its sum over fluid points and
  /// what U took out of them at walls: momentum that would be lost.
  /// Stops when the largest residual is below tolerance times velocity_scale (or times the largest residual
  /// at the start, where the fluid was at rest).
  SolverReport solve(const ViscousSystem& system, const Field<Real>& residual, const Field<Real>& correction,
                     Real tolerance, Real velocity_scale, int iteration_limit, Real& residual_sum);

  std::size_t bytes() const;

 private:
  /// That many sweeps from zero make the correction or are added to it; returns the norms of the residual
  /// that is left.
  template <bool is_first>
  Norms run_sweeps(const ViscousSystem& system, const Field<Real>& residual, const Field<Real>& correction,
                   int sweeps, const Spectrum& spectrum);

  void prepare_multigrid(const ViscousSystem& system);
  /// The same with that many cycles.
  template <bool is_first>
  Norms multigrid_cycle(const ViscousSystem& system, const Field<Real>& residual,
                        const Field<Real>& correction, int cycles);
  /// The same with ViscousKrylov: reduces the residual, at first `largest`, to `wanted` times that if it can.
  template <bool is_first>
  Norms krylov_cycle(const ViscousSystem& system, const Field<Real>& residual, const Field<Real>& correction,
                     Real largest, Real wanted, int limit, SolverReport& report);

  Field<float> rhs_, iterate_, next_;
  std::shared_ptr<ViscousMultigrid> multigrid_;  // from the first stiff system on
  std::shared_ptr<ViscousKrylov> krylov_;        // from the first that needs it on
};

}  // namespace peclet::flow
