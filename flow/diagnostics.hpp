#pragma once
// Sums and maxima over the fluid.
#include "core/field.hpp"
#include "core/loop.hpp"
#include "flow/bodies.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

Real largest_component(const RowRanges& rows, const FaceVector<Real>& velocity);

/// Largest over the cells of sum_a |u_a| / h_a, the larger of both faces along each axis. What flows through
/// slits carries scalars but no momentum.
Real largest_courant_rate(const RowRanges& rows, const FaceVector<OpenFraction>& open,
                          const FaceVector<Real>& velocity, const Real3& spacing, bool count_slits);

/// velocity = 0 at solid points.
void mask_solid_points(const RowRanges& whole, const FaceVector<OpenFraction>& open,
                       const FaceVector<Real>& velocity);

/// Sum of u - u_old over the fluid points of one component.
Real sum_of_change(const RowRanges& rows, const Field<OpenFraction>& open, const Field<Real>& velocity,
                   const Field<Real>& previous);

/// Largest magnitude in cells that have an open face.
Real divergence_in_open_cells(const RowRanges& rows, const FaceVector<OpenFraction>& open,
                              const Field<Real>& divergence);

/// Number of fluid points of one component.
Real count_fluid_points(const RowRanges& rows, const Field<OpenFraction>& open);

}  // namespace peclet::flow
