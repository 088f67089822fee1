#pragma once
// Projection of the predicted velocity on open fractions [NgMinGibou2009; SeoMittal2011]: with the flux
//   F = o u + integral of the wall velocity over the closed part of a face,
// find phi with  div(o grad phi) = div F(u*)  in every open cell; then u = u* - grad phi has div F(u) = 0.
#include "core/field.hpp"
#include "core/sweep.hpp"
#include "flow/domain_sides.hpp"
#include "flow/moving_walls.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// divergence = div F(velocity), velocity ghosts filled; returns its largest magnitude. sdf tells which faces
/// of the sides of the box are beside fluid.
Real compute_divergence(const Grid& grid, const SweepPlan& plan, const RowRanges& rows,
                        const FaceVector<OpenFraction>& open, const CutCells& cut_cells,
                        const DomainSides& sides, const Field<Real>& sdf, const FaceVector<Real>& velocity,
                        const Field<Real>& divergence);

/// divergence = div(o f) of a uniform force, fluxes through Outflow sides included; returns its largest
/// magnitude.
Real compute_force_divergence(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                              const Real3& force, const Field<Real>& divergence);

/// Largest magnitude along an axis of what is left of the force on open faces: f - grad psi, the ghosts of
/// psi filled.
Real largest_driving_force(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                           const Real3& force, const Field<Real>& potential);

/// pressure += potential
void add_potential(const RowRanges& rows, const Field<Real>& potential, const Field<Real>& pressure);

/// What the pressure correction phi changes.
struct ProjectionUpdate {
  Real density_over_time_step = 1;
  Real implicit_viscosity = 0;    // theta mu, or a share of it
  bool weighs_open_part = false;  // s is the open part of each cell, else 1
  Field<Real> potential;          // phi, ghosts filled
  Field<Real> divergence;         // div F of the predicted velocity; becomes that over s
};

/// velocity -= grad phi on open faces (those on high Outflow sides included), zero on closed ones, and the
/// rotational pressure update [TimmermansMinevVanDeVosse1996]
///   p += rho / dt phi - theta mu div F(u*) / s.
/// In long steps the second term alone moves the pressure, an iteration of Uzawa's for the operator
/// div o (nu L)^-1 grad. Its diagonal is 1 / mu times the open part of the cell: with s = 1 the pressure of a
/// cell that is open by a tenth needs ten times the steps to settle. Cells that a moving body is about to
/// uncover have another divergence, for which a small s would be unstable.
void apply_projection(const Grid& grid, const SweepPlan& plan, const RowRanges& rows,
                      const FaceVector<OpenFraction>& open, const DomainSides& sides,
                      const ProjectionUpdate& update, const FaceVector<Real>& velocity,
                      const Field<Real>& pressure);

}  // namespace peclet::flow
