#pragma once
// Conjugate gradients on the pressure equation, preconditioned by one multigrid cycle [HestenesStiefel1952].
#include "flow/multigrid.hpp"
#include "flow/pressure_solver.hpp"

namespace peclet::flow {

/// The equation  L phi = rhs - mean  with  L phi = sum over faces of o (phi_neighbour - phi) / h_a^2.
struct PressureEquation {
  LevelOperator<OpenFraction> op;  ///< weights of L in physical units
  Field<Real> rhs, phi;
  Real mean = 0;
};

/// Sum, squares and largest magnitude of rhs - mean over cells with an open face.
Norms measure_rhs(const PressureEquation& equation, const RowRanges& rows, const SweepPlan& plan);

/// Improves phi until the residual, recomputed in double precision, satisfies the settings. The vectors of
/// the iteration are in single precision and hold residual * scale; search is work space.
SolveReport conjugate_gradient(const PressureEquation& equation, const Multigrid& multigrid,
                               const Field<float>& search, Real rhs_norm, Real scale,
                               const PressureSettings& settings);

}  // namespace peclet::flow
