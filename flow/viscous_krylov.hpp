#pragma once
// Viscous systems that a multigrid cycle alone does not solve, such as advected ones: BiCGStab
// [VanDerVorst1992], preconditioned by one cycle per product. Vectors are in single precision; the caller
// recomputes the residual in double precision.
#include "flow/viscous_multigrid.hpp"

namespace peclet::flow {

class ViscousKrylov {
 public:
  explicit ViscousKrylov(const Layout& layout);

  /// e = approximation of A^-1 residual from zero, ghosts filled; until the largest residual, at first
  /// `largest`, has fallen to `reduction` times it. Returns the number of iterations; r is work space.
  int solve(const ViscousSystem& system, const ViscousMultigrid& multigrid, const Field<Real>& residual,
            Real largest, Real reduction, int limit, const Field<float>& e, const Field<float>& r);

  std::size_t bytes() const;

 private:
  /// out = A e, zero at solid points; returns out . other.
  Real multiply(const ViscousSystem& system, const Field<float>& e, const Field<float>& out,
                const Field<float>& other);

  Field<float> shadow_, search_, product_;
};

}  // namespace peclet::flow
