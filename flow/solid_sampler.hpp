#pragma once
// Signed distance of the solid near a cell, and what follows from it on one face: the open fraction, the
// centroid of the closed part, and where an axis-parallel segment crosses the wall.
#include "core/field.hpp"
#include "flow/bodies.hpp"
#include "flow/near_cells.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// Smallest open fraction of a face whose centre is fluid: a fluid face is never closed.
inline constexpr OpenFraction smallest_open_fraction = fully_open / 4;
/// Smallest open fraction of a slit; faces that are open less are closed.
inline constexpr OpenFraction smallest_slit = fully_open / 64;

/// Distance to the bodies that own the two cells beside a face, callable in kernels.
struct SolidSampler {
  BodyGeometry geometry;
  Field<Real> sdf;      // at cell centres, exact within a band around the surfaces
  Field<int> owner;     // nearest body of a cell within that band
  Field<int> marks;     // of cells
  Field<Real> samples;  // the solid given as an array, if any
  Grid grid;

  KOKKOS_INLINE_FUNCTION Real distance(int body, Vec3 x) const {
    if (body >= 0) return geometry.distance(body, x);
    if (body == sampled_solid) return interpolated_sample(x);
    return far_away;
  }
  KOKKOS_INLINE_FUNCTION Real distance(int a, int b, Vec3 x) const {
    const Real d = distance(a, x);
    if (a == b) return d;
    const Real e = distance(b, x);
    return e < d ? e : d;
  }

  /// Radius if both owners are one sphere whose nearest image is all that matters, else 0.
  KOKKOS_INLINE_FUNCTION Real sphere_radius(int a, int b) const {
    return a == b && a >= 0 ? geometry.sphere_radius(geometry.bodies(a)) : 0.0;
  }

  /// Trilinear interpolation of the samples at cell centres.
  KOKKOS_INLINE_FUNCTION Real interpolated_sample(Vec3 x) const {
    int cell[3];
    Real weight[3];
    for (int a = 0; a < 3; ++a) {
      Real s = (x[a] - grid.origin[a]) / grid.spacing[a] - 0.5;
      if (s < -1) s = -1;
      if (s > grid.cells[a] - 1e-9) s = grid.cells[a] - 1e-9;
      cell[a] = static_cast<int>(Kokkos::floor(s));
      weight[a] = s - cell[a];
    }
    Real value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
      value += (dx ? weight[0] : 1 - weight[0]) * (dy ? weight[1] : 1 - weight[1]) *
               (dz ? weight[2] : 1 - weight[2]) * samples(cell[0] + dx, cell[1] + dy, cell[2] + dz);
    }
    return value;
  }
};

/// Open part of a face from linear interpolation of the distance.
struct FaceOpening {
  Real open = 1;                    // fraction of the area
  Real closed_s = 0, closed_t = 0;  // centroid of the closed part in units of the face edges, centre = 0
};

/// Corners of a face in units of its edges, centre = 0.
KOKKOS_INLINE_FUNCTION Real corner_s(int n) { return n == 1 || n == 2 ? 0.5 : -0.5; }
KOKKOS_INLINE_FUNCTION Real corner_t(int n) { return n > 1 ? 0.5 : -0.5; }

/// Distance at the centre and the corners of a face.
struct FaceSamples {
  Real middle, corner[4];
};

/// s and t run along the axes (axis + 1) % 3 and (axis + 2) % 3.
KOKKOS_INLINE_FUNCTION FaceSamples sample_face(const SolidSampler& solid, int axis, int owner_low,
                                               int owner_high, Vec3 center) {
  const int axis_s = (axis + 1) % 3, axis_t = (axis + 2) % 3;
  const Real width_s = solid.grid.spacing[axis_s], width_t = solid.grid.spacing[axis_t];
  FaceSamples face;
  if (const Real radius = solid.sphere_radius(owner_low, owner_high); radius > 0) {
    const Vec3 arm = solid.geometry.arm(owner_low, center);
    face.middle = norm(arm) - radius;
    for (int n = 0; n < 4; ++n) {
      const Real s = arm[axis_s] + corner_s(n) * width_s, t = arm[axis_t] + corner_t(n) * width_t;
      face.corner[n] = Kokkos::sqrt(arm[axis] * arm[axis] + s * s + t * t) - radius;
    }
    return face;
  }
  face.middle = solid.distance(owner_low, owner_high, center);
  for (int n = 0; n < 4; ++n) {
    Vec3 x = center;
    x[axis_s] += corner_s(n) * width_s;
    x[axis_t] += corner_t(n) * width_t;
    face.corner[n] = solid.distance(owner_low, owner_high, x);
  }
  return face;
}

/// Adds one triangle (a quarter of the face: the centre and two corners) to a face opening whose closed_s
/// and closed_t accumulate first moments of the closed part.
KOKKOS_INLINE_FUNCTION void add_triangle(const Real (&d)[3], const Real (&s)[3], const Real (&t)[3],
                                         FaceOpening& face) {
  const int closed_count = (d[0] < 0) + (d[1] < 0) + (d[2] < 0);
  constexpr Real area = 0.25;
  const Real mean_s = (s[0] + s[1] + s[2]) / 3, mean_t = (t[0] + t[1] + t[2]) / 3;
  if (closed_count == 0) return;
  Real closed = area, moment_s = area * mean_s, moment_t = area * mean_t;
  if (closed_count < 3) {
    // the vertex alone on its side cuts off a small triangle
    int lone = 0;
    for (int v = 0; v < 3; ++v)
      if ((d[v] < 0) == (closed_count == 1)) lone = v;
    const int a = (lone + 1) % 3, b = (lone + 2) % 3;
    const Real to_a = d[lone] / (d[lone] - d[a]), to_b = d[lone] / (d[lone] - d[b]);
    const Real part = area * to_a * to_b;
    const Real part_s = s[lone] + (to_a * (s[a] - s[lone]) + to_b * (s[b] - s[lone])) / 3;
    const Real part_t = t[lone] + (to_a * (t[a] - t[lone]) + to_b * (t[b] - t[lone])) / 3;
    if (closed_count == 1) {
      closed = part;
      moment_s = part * part_s;
      moment_t = part * part_t;
    } else {
      closed = area - part;
      moment_s = area * mean_s - part * part_s;
      moment_t = area * mean_t - part * part_t;
    }
  }
  face.open -= closed;
  face.closed_s += moment_s;
  face.closed_t += moment_t;
}

/// Opening of the low face of cell (i, j, k) along axis: the distance is linear on each triangle.
KOKKOS_INLINE_FUNCTION FaceOpening face_opening(const SolidSampler& solid, int axis, int i, int j, int k,
                                                int owner_low, int owner_high) {
  const FaceSamples samples =
      sample_face(solid, axis, owner_low, owner_high, solid.grid.face_center(axis, i, j, k));
  const Real middle = samples.middle;
  const Real(&d)[4] = samples.corner;
  const int closed_count = (middle < 0) + (d[0] < 0) + (d[1] < 0) + (d[2] < 0) + (d[3] < 0);
  FaceOpening face;
  if (closed_count == 0) return face;
  if (closed_count == 5) return {0, 0, 0};
  for (int n = 0; n < 4; ++n) {
    const int m = (n + 1) % 4;
    const Real distance[3] = {middle, d[n], d[m]};
    const Real s[3] = {0, corner_s(n), corner_s(m)}, t[3] = {0, corner_t(n), corner_t(m)};
    add_triangle(distance, s, t, face);
  }
  const Real closed = 1 - face.open;
  if (closed > 0) {
    face.closed_s /= closed;
    face.closed_t /= closed;
  }
  return face;
}

/// Nearer to x of the bodies that own the two cells beside the low face p of component c.
KOKKOS_INLINE_FUNCTION int nearest_owner(const SolidSampler& solid, int c, Index p, Vec3 x) {
  const int low = solid.owner[p - solid.owner.layout().stride(c)], high = solid.owner[p];
  return low == high || solid.distance(low, x) < solid.distance(high, x) ? low : high;
}

/// The same for a sphere around the origin: smaller root of |x + root (y - x)| = radius.
KOKKOS_INLINE_FUNCTION Real sphere_crossing(Real radius, Vec3 x, Vec3 y) {
  const Real outside = dot(x, x) - radius * radius;
  if (outside <= 0) return 0;
  if (dot(y, y) >= radius * radius) return 1;
  const Vec3 way = y - x;
  const Real towards = -dot(x, way);
  return outside / (towards + Kokkos::sqrt(towards * towards - dot(way, way) * outside));
}

/// Distance from x to the wall along the segment towards y, as a fraction of the segment: root of the
/// signed distance by false position, where an end that stays twice counts half (Illinois rule); 1 where the
/// solid begins beyond y.
KOKKOS_INLINE_FUNCTION Real wall_crossing(const SolidSampler& solid, int owner_a, int owner_b, Vec3 x,
                                          Vec3 y) {
  if (const Real radius = solid.sphere_radius(owner_a, owner_b); radius > 0) {
    const Vec3 arm = solid.geometry.arm(owner_a, x);
    return sphere_crossing(radius, arm, arm + (y - x));
  }
  Real low = 0, high = 1;
  Real d_low = solid.distance(owner_a, owner_b, x), d_high = solid.distance(owner_a, owner_b, y);
  if (d_low <= 0) return 0;
  if (d_high >= 0) return 1;
  Real root = 1;
  int side = 0;  // of the wall on which the last root fell
  for (int iteration = 0; iteration < 30; ++iteration) {
    root = low + (high - low) * d_low / (d_low - d_high);
    const Real d = solid.distance(owner_a, owner_b, x + root * (y - x));
    if (Kokkos::abs(d) < 1e-9 * norm(y - x)) break;
    if (d > 0) {
      low = root;
      d_low = d;
      if (side > 0) d_high *= 0.5;
      side = 1;
    } else {
      high = root;
      d_high = d;
      if (side < 0) d_low *= 0.5;
      side = -1;
    }
  }
  return root;
}

/// A gap of less than one cell between two bodies that can move against each other.
struct NarrowGap {
  int first = no_owner, second = no_owner;  // the nearer body and the other one
  Real share = 0;  // of the other one in the common motion: 0 (no gap) to 1/2 (touching)
};

/// The gap around the low face of cell (i, j, k) along axis. Bodies are staircases of closed faces; where two
/// of them come within a cell, the stairs would mesh like gear teeth, and sliding past each other would
/// squeeze the cells between them. Faces in the gap therefore take part in a common motion of both.
KOKKOS_INLINE_FUNCTION NarrowGap narrow_gap(const SolidSampler& solid, int axis, int i, int j, int k) {
  const Layout& layout = solid.sdf.layout();
  const Index p = layout(i, j, k), q = p - layout.stride(axis);
  NarrowGap gap;
  if (!(solid.marks[p] & cell_mark::between_bodies)) return gap;
  gap.first = solid.owner[p];
  int other = solid.owner[q];
  for (int n = 0; n < 12 && other == gap.first; ++n) {
    const Index step = (n & 1 ? 1 : -1) * layout.stride(n / 4);
    other = solid.owner[(n & 2 ? p : q) + step];
  }
  if (other == gap.first || other == no_owner || gap.first == no_owner) return gap;
  const bool one_moves = (gap.first >= 0 && solid.geometry.bodies(gap.first).dynamic) ||
                         (other >= 0 && solid.geometry.bodies(other).dynamic);
  if (!one_moves) return gap;
  const Vec3 x = solid.grid.face_center(axis, i, j, k);
  const Real here = solid.distance(gap.first, x), there = solid.distance(other, x);
  gap.second = other;
  if (there < here) {
    gap.second = gap.first;
    gap.first = other;
  }
  const Real width = (here + there) / solid.grid.spacing[axis];
  if (width < 1) gap.share = width > 0 ? 0.5 * (1 - width) : 0.5;
  return gap;
}

/// Velocity along axis at x of the wall of body; on either side of a narrow gap it approaches the mean of
/// both, so that nothing is squeezed or sheared in a gap that the grid does not resolve.
KOKKOS_INLINE_FUNCTION Real wall_velocity(const SolidSampler& solid, const NarrowGap& gap, int body, int axis,
                                          Vec3 x, Motion motion = Motion::AtEnd) {
  const Real own = body >= 0 ? solid.geometry.velocity(body, x, motion)[axis] : 0.0;
  if (gap.share == 0) return own;
  const int across = body == gap.second ? gap.first : gap.second;
  const Real other = across >= 0 ? solid.geometry.velocity(across, x, motion)[axis] : 0.0;
  return own + gap.share * (other - own);
}

}  // namespace peclet::flow
