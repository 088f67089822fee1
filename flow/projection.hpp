#pragma once
// Projection of the predicted velocity on open fractions [NgMinGibou2009; SeoMittal2011]: with the flux
//   F = o u + integral of the wall velocity over the closed part of a face,
// find phi with  div(o grad phi) = div F(u*)  in every open cell; then u = u* - grad phi has div F(u) = 0.
#include "core/field.hpp"
#include "flow/moving_walls.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// divergence = div F(velocity); velocity ghosts filled.
void compute_divergence(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                        const CutCells& cut_cells, const FaceVector<Real>& velocity, const Field<Real>& divergence);

/// velocity -= grad phi on open faces; zero on closed ones.
void subtract_gradient(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                       const Field<Real>& phi, const FaceVector<Real>& velocity);

/// Rotational pressure update [TimmermansMinevVanDeVosse1996], theta the implicit weight of viscosity:
///   p += rho / dt phi - theta mu div F(u*).
void update_pressure(const RowRanges& rows, Real density_over_time_step, Real implicit_viscosity,
                     const Field<Real>& phi, const Field<Real>& divergence, const Field<Real>& pressure);

}  // namespace peclet::flow
