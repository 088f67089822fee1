#pragma once
// Fluid part of a cell from the distance at its centre, face centres and corners.
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// Part of the edge from a point at distance p >= 0 to one at n < 0 that is positive.
KOKKOS_INLINE_FUNCTION Real positive_edge(Real p, Real n) { return p / (p - n); }

/// Part of a tetrahedron where the linear interpolant of d is positive.
KOKKOS_INLINE_FUNCTION Real positive_part(const Real (&d)[4]) {
  int positive[4], negative[4], n_positive = 0, n_negative = 0;
  for (int v = 0; v < 4; ++v) {
    if (d[v] < 0)
      negative[n_negative++] = v;
    else
      positive[n_positive++] = v;
  }
  if (n_negative == 0) return 1;
  if (n_positive == 0) return 0;
  if (n_positive == 1) {
    const int p = positive[0];
    return positive_edge(d[p], d[negative[0]]) * positive_edge(d[p], d[negative[1]]) *
           positive_edge(d[p], d[negative[2]]);
  }
  if (n_negative == 1) {
    const int n = negative[0];
    return 1 - (1 - positive_edge(d[positive[0]], d[n])) * (1 - positive_edge(d[positive[1]], d[n])) *
                   (1 - positive_edge(d[positive[2]], d[n]));
  }
  const int p = positive[0], q = positive[1], r = negative[0], s = negative[1];
  const Real pr = positive_edge(d[p], d[r]), ps = positive_edge(d[p], d[s]), qr = positive_edge(d[q], d[r]),
             qs = positive_edge(d[q], d[s]);
  return pr * ps + pr * qs * (1 - ps) + qr * qs * (1 - pr);
}

/// Fluid part of cell (i, j, k): 24 tetrahedra from its centre to a quarter of a face each.
KOKKOS_INLINE_FUNCTION Real fluid_part_of_cell(const SolidSampler& solid, int i, int j, int k, int owner) {
  const Vec3 center = solid.grid.cell_center(i, j, k);
  const Real middle = solid.distance(owner, center);
  Real corner[8];
  for (int n = 0; n < 8; ++n)
    corner[n] = solid.distance(owner, solid.grid.corner(i + (n & 1), j + ((n >> 1) & 1), k + (n >> 2)));
  Real part = 0;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, high = face % 2, s = (axis + 1) % 3, t = (axis + 2) % 3;
    Vec3 x = center;
    x[axis] += (high ? 0.5 : -0.5) * solid.grid.spacing[axis];
    const Real at_face = solid.distance(owner, x);
    const int first = high << axis;
    const int ring[4] = {first, first | (1 << s), first | (1 << s) | (1 << t), first | (1 << t)};
    for (int n = 0; n < 4; ++n) {
      const Real d[4] = {middle, at_face, corner[ring[n]], corner[ring[(n + 1) % 4]]};
      part += positive_part(d);
    }
  }
  return part / 24;
}

}  // namespace peclet::flow
