#pragma once
// Steady state of a scalar in a given flow, by Newton's method with the linearisation B of first-order upwind
// advection and diffusion:
//   B e = dt (-A(c) + D lap c + s),  c += e,
// solved by the stabilised biconjugate gradient method, scaled by the diagonal [VanDerVorst1992].
#include "flow/scalar_transport.hpp"

namespace peclet::flow {

/// Work space: all zero outside the fluid.
class SteadySystem {
 public:
  explicit SteadySystem(const Layout& layout);

  /// Takes over the geometry and the carrying velocity; returns the time step dt for which the largest
  /// diagonal entry of B is 1.
  Real set(const ScalarTerms& terms, const ScalarRows& rows);
  /// correction = e with |B e - residual| <= reduction |residual|, or after the limit; returns iterations.
  int solve(const Field<Real>& residual, const Field<Real>& correction, Real reduction, int limit) const;

 private:
  void apply(const Field<Real>& e, const Field<Real>& result) const;

  ScalarTerms terms_;
  ScalarRows rows_;
  Field<Real> diagonal_, remainder_, shadow_, search_, scaled_, image_, image_of_remainder_;
};

/// residual = dt (-A(c) + D lap c + s) of the present values. Overwrites predicted, advected and gain.
void compute_steady_residual(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                             const Field<Real>& residual);
/// The terms for which a step changes nothing but by that residual.
ScalarTerms steady_terms(const ScalarTerms& terms);
/// value += correction + shift in fluid cells.
void add_in_fluid(const ScalarFields& fields, const Field<Real>& correction, Real shift);
/// 2-norm over all cells.
Real norm_of(const Field<Real>& field);

}  // namespace peclet::flow
