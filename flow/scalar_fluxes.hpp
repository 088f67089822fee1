#pragma once
// Fluxes of a scalar through the faces of one cell, sides of the box and walls included.
#include "flow/advection_schemes.hpp"
#include "flow/scalar_transport.hpp"

namespace peclet::flow {

/// A face of cell p, in direction d = 2 axis + high.
struct ScalarFace {
  Index face;        // its linear index
  bool at_side;      // on a side of the box that is not periodic
  Real volume_flux;  // along the axis, per area of the whole face
  Real side_value;   // on the side, where it is given
  bool has_value;
};

KOKKOS_INLINE_FUNCTION ScalarFace scalar_face(const ScalarTerms& t, Index p, int d) {
  const Layout& layout = t.fields.value.layout();
  const int axis = d / 2, high = d % 2;
  const Int3 cell = cell_of(layout, p);
  const ScalarSide& side = t.sides.side[axis][high];
  ScalarFace face;
  face.face = high ? p + layout.stride(axis) : p;
  face.at_side = !side.is_periodic && cell[axis] == (high ? layout.cells[axis] - 1 : 0);
  const OpenFraction open = t.open[axis][face.face];
  // a face with prescribed velocity has no open part for the pressure
  const bool is_prescribed = face.at_side && open == 0;
  const Real fraction = is_prescribed ? (t.sdf[p] >= 0 ? 1 : 0) : open * open_fraction_unit;
  face.volume_flux = fraction * t.carrier[axis][face.face];
  face.has_value = face.at_side && side.condition == ScalarCondition::Value;
  face.side_value = face.has_value ? t.sides.value(axis, high, cell) : 0;
  return face;
}

/// Flux of c along the axis through a face of cell p, per area of the whole face.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real advective_flux(const ScalarTerms& t, const Field<Real>& c, Index p, int d,
                                           const ScalarFace& face) {
  const Real carrier = face.volume_flux;
  if (carrier == 0) return 0;
  const bool enters = d % 2 ? carrier < 0 : carrier > 0;
  if (face.at_side && enters) return carrier * (face.has_value ? face.side_value : c[p]);
  const Index n = face.face, step = t.fields.value.layout().stride(d / 2);
  return carrier * carried_value<Scheme>(carrier, c[n - 2 * step], c[n - step], c[n], c[n + step]);
}

/// div(F c_f) of cell p, per volume of the whole cell.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real advection_at_row(const ScalarTerms& t, const Field<Real>& c, Index p) {
  Real divergence = 0;
  for (int d = 0; d < ScalarRows::directions; ++d) {
    const int axis = d / 2;
    const ScalarFace face = scalar_face(t, p, d);
    const Real flux = advective_flux<Scheme>(t, c, p, d, face);
    const Real slope = 0.5 * t.mean_gradient[axis] * t.grid.spacing[axis];
    divergence += ((d % 2 ? flux : -flux) + slope * face.volume_flux) / t.grid.spacing[axis];
  }
  return divergence;
}

/// What the diffusive exchange of cell p in direction d is proportional to: value beyond minus value here.
/// weight: 0 for c, r/2 for v.
KOKKOS_INLINE_FUNCTION Real scalar_difference(const ScalarTerms& t, const ScalarRows& rows, Index row, int d,
                                              const Field<Real>& c, const Field<Real>& other, Real weight) {
  const int axis = d / 2, sign = d % 2 ? 1 : -1;
  const Index p = rows.links.face(row);
  const Real here = c[p] + weight * (c[p] - other[p]);
  if (rows.links.is_wall(row, d)) return rows.wall_value(row, d) - here;
  const Index q = p + sign * t.fields.value.layout().stride(axis);
  return c[q] + weight * (c[q] - other[q]) - here + sign * t.mean_gradient[axis] * t.grid.spacing[axis];
}

/// L v at a row, v = c + weight (c - c_old).
KOKKOS_INLINE_FUNCTION Real laplacian_at_row(const ScalarTerms& t, const ScalarRows& rows, Index row,
                                             Real weight) {
  Real sum = 0;
  for (int d = 0; d < ScalarRows::directions; ++d) {
    const Real coefficient = rows.coefficient(row, d);
    if (coefficient == 0) continue;
    const Real h = t.grid.spacing[d / 2];
    sum +=
        coefficient / (h * h) * scalar_difference(t, rows, row, d, t.fields.value, t.fields.previous, weight);
  }
  return sum;
}

}  // namespace peclet::flow
