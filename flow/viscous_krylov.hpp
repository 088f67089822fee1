#pragma once
// Viscous systems that are stiff or advected: BiCGStab [VanDerVorst1992], preconditioned by one multigrid
// cycle per product.
//
// The cycle works on a symmetric relative of the operator: wall rows scaled, the exchange between neighbours
// the mean of what their rows say, U by its symmetric part. Vectors are in single precision; the caller
// recomputes the residual in double precision.
#include "flow/multigrid.hpp"
#include "flow/viscous_operator.hpp"

namespace peclet::flow {

class ViscousKrylov {
 public:
  ViscousKrylov(const Grid& grid, const DomainSides& sides);

  /// False after a change of the periodic sides.
  bool fits(const DomainSides& sides) const;
  /// Takes over the coefficients of a system.
  void set_system(const ViscousSystem& system);
  /// e = approximation of A^-1 residual from zero, ghosts filled; until the largest residual, at first
  /// `largest`, has fallen to `reduction` times it. Returns the number of iterations; r is work space.
  int solve(const ViscousSystem& system, const Field<Real>& residual, Real largest, Real reduction, int limit,
            const Field<float>& e, const Field<float>& r);

  Real largest_diagonal(const ViscousSystem& system) const {
    return Diffusion<Real>(system.grid, exchange_).diagonal;
  }
  std::size_t bytes() const;

 private:
  /// correction = M^-1 rhs, both in the fields of the multigrid, ghosts filled.
  const Field<float>& precondition(const ViscousSystem& system);
  /// out = A e, zero at solid points; returns out . other.
  Real multiply(const ViscousSystem& system, const Field<float>& e, const Field<float>& out,
                const Field<float>& other);

  PressureSides sides_;
  BasicMultigrid<true> multigrid_;
  FaceVector<OpenFraction> links_;
  Field<float> reaction_;
  Field<float> shadow_, search_, product_;
  Real exchange_ = 0;  // diffusion that bounds the exchange between neighbours
};

}  // namespace peclet::flow
