#pragma once
// Moments of the solid part of a cell by nested one-dimensional quadrature. Along the direction that the
// surface faces, the solid is found by root finding and integrated exactly; across it, Gauss rules run over
// intervals that are split where the surface leaves through a face or an edge of the cell [Saye2015]. Cells
// are halved until two rules agree, which isolates edges, kinks and tangencies.
#include "core/scene_program.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet {

/// Integrals of 1; x, y, z; xx, yy, zz, xy, yz, zx.
struct Moments {
  Real volume = 0;
  Vec3 first, squares, products;

  KOKKOS_INLINE_FUNCTION Moments& operator+=(const Moments& other) {
    volume += other.volume;
    first += other.first;
    squares += other.squares;
    products += other.products;
    return *this;
  }
};

/// Gauss-Legendre rule on [0, 1].
struct GaussRule {
  static constexpr int maximum_order = 16;
  int order = 0;
  Kokkos::Array<Real, maximum_order> nodes{}, weights{};
};

class SolidQuadrature {
 public:
  static constexpr int maximum_segments = 32;
  static constexpr int maximum_depth = 3;  // how often a cell may be halved

  struct Settings {
    GaussRule rule, check;  // cells are halved until both agree
    int segments = 8;       // in which a line across a cell is searched for the surface
    int depth = 4;          // how often a cell may be halved
    Real reach = 1;         // the surface is farther away than |value| / reach
    Vec3 reference_point;   // moments are about this point
  };

  SolidQuadrature(const SceneProgram& program, const Settings& settings)
      : program_(program), settings_(settings) {}

  /// Add the moments of the solid in the box.
  KOKKOS_FUNCTION void add_cell(Vec3 low, Vec3 high, Moments& sum) const;

 private:
  static constexpr int maximum_crossings = 8;
  static constexpr Real settled = 1e-5;  // difference between the two rules, relative to the cell

  struct Cell {
    Vec3 low, high;
    int depth = 0;
    KOKKOS_INLINE_FUNCTION Real volume() const {
      return (high.x - low.x) * (high.y - low.y) * (high.z - low.z);
    }
  };

  struct Crossings {
    Real at[2 + 4 * maximum_crossings];
    int count = 0;
    KOKKOS_INLINE_FUNCTION void insert(Real s) {
      int n = count++;
      for (; n > 0 && at[n - 1] > s; --n) at[n] = at[n - 1];
      at[n] = s;
    }
  };

  KOKKOS_INLINE_FUNCTION Real distance(Vec3 x, int axis, Real s) const {
    x[axis] = s;
    return program_.distance(0, x + settings_.reference_point);
  }
  KOKKOS_INLINE_FUNCTION Real crossing_between(Vec3 x, int axis, Real a, Real fa, Real b, Real fb) const;
  KOKKOS_INLINE_FUNCTION bool find_crossings(Vec3 x, int axis, Real a, Real b, Crossings& found) const;
  KOKKOS_INLINE_FUNCTION void add_line(Vec3 x, int axis, Real a, Real b, Real weight, Moments& sum) const;
  KOKKOS_INLINE_FUNCTION void add_plane(const Cell& cell, Vec3 x, const int (&axes)[3], Real weight,
                                        const GaussRule& rule, Moments& sum) const;
  KOKKOS_INLINE_FUNCTION Moments integrate(const Cell& cell, const GaussRule& rule) const;
  KOKKOS_INLINE_FUNCTION bool is_uncut(const Cell& cell, Moments& moments) const;
  KOKKOS_INLINE_FUNCTION void order_axes(const Cell& cell, int (&axes)[3]) const;

  SceneProgram program_;
  Settings settings_;
};

/// Line from (x, axis = a) to b, all solid.
KOKKOS_INLINE_FUNCTION void add_solid_line(Vec3 x, int axis, Real a, Real b, Real weight, Moments& sum) {
  const Real L0 = weight * (b - a), mean = 0.5 * (a + b);
  const Real L1 = L0 * mean, L2 = L0 * (mean * mean + (b - a) * (b - a) / 12);
  x[axis] = 0;
  Vec3 along;
  along[axis] = 1;
  sum.volume += L0;
  sum.first += L0 * x + L1 * along;
  const Vec3 swapped{x.y, x.z, x.x}, along_swapped{along.y, along.z, along.x};
  for (int n = 0; n < 3; ++n) {
    sum.squares[n] += L0 * x[n] * x[n] + L2 * along[n];
    sum.products[n] += L0 * x[n] * swapped[n] + L1 * (x[n] * along_swapped[n] + along[n] * swapped[n]);
  }
}

/// Root between a and b, where the signs differ: false position with the Illinois safeguard.
KOKKOS_INLINE_FUNCTION Real SolidQuadrature::crossing_between(Vec3 x, int axis, Real a, Real fa, Real b,
                                                              Real fb) const {
  const Real tolerance = 1e-14 * (b - a);
  int kept = 0;  // the end that stayed in the last step: -1 low, 1 high
  for (int n = 0; n < 60 && b - a > tolerance; ++n) {
    Real s = (a * fb - b * fa) / (fb - fa);
    if (!(s > a && s < b)) s = 0.5 * (a + b);
    const Real f = distance(x, axis, s);
    if (Kokkos::fabs(f) <= tolerance) return s;
    if ((f < 0) == (fa < 0)) {
      a = s;
      fa = f;
      if (kept == 1) fb *= 0.5;
      kept = 1;
    } else {
      b = s;
      fb = f;
      if (kept == -1) fa *= 0.5;
      kept = -1;
    }
  }
  return 0.5 * (a + b);
}

/// Insert the crossings between a and b in order; true if a is solid. Steps over which the values allow a
/// hidden pair of crossings are halved, down to a limit.
KOKKOS_INLINE_FUNCTION bool SolidQuadrature::find_crossings(Vec3 x, int axis, Real a, Real b,
                                                            Crossings& found) const {
  const Real segment = (b - a) / settings_.segments, smallest_step = segment / 16;
  Real s = a, f = distance(x, axis, a);
  const bool starts_solid = f < 0;
  for (int crossings = 0; s < b && crossings < maximum_crossings;) {
    Real next = Kokkos::fmin(b, s + Kokkos::fmax(segment, Kokkos::fabs(f) / settings_.reach));
    Real f_next = distance(x, axis, next);
    while ((f < 0) == (f_next < 0) && next - s > smallest_step &&
           Kokkos::fabs(f) + Kokkos::fabs(f_next) < settings_.reach * (next - s)) {
      next = 0.5 * (s + next);
      f_next = distance(x, axis, next);
    }
    if ((f < 0) != (f_next < 0)) {
      found.insert(crossing_between(x, axis, s, f, next, f_next));
      ++crossings;
    }
    s = next;
    f = f_next;
  }
  return starts_solid;
}

/// The solid on the line through x from a to b.
KOKKOS_INLINE_FUNCTION void SolidQuadrature::add_line(Vec3 x, int axis, Real a, Real b, Real weight,
                                                      Moments& sum) const {
  Crossings crossings;
  bool is_solid = find_crossings(x, axis, a, b, crossings);
  crossings.insert(b);
  Real start = a;
  for (int n = 0; n < crossings.count; ++n) {
    if (is_solid) add_solid_line(x, axis, start, crossings.at[n], weight, sum);
    start = crossings.at[n];
    is_solid = !is_solid;
  }
}

/// The solid in the plane through x: Gauss rule along axes[1], lines along axes[2].
KOKKOS_INLINE_FUNCTION void SolidQuadrature::add_plane(const Cell& cell, Vec3 x, const int (&axes)[3],
                                                       Real weight, const GaussRule& rule,
                                                       Moments& sum) const {
  const int across = axes[1], along = axes[2];
  const Real a = cell.low[along], b = cell.high[along];
  Crossings pieces;
  const Real faces[2] = {a, b};
  for (const Real face : faces) {
    x[along] = face;
    find_crossings(x, across, cell.low[across], cell.high[across], pieces);
  }
  pieces.insert(cell.high[across]);
  Real start = cell.low[across];
  for (int n = 0; n < pieces.count; ++n) {
    const Real length = pieces.at[n] - start;
    for (int g = 0; length > 0 && g < rule.order; ++g) {
      x[across] = start + rule.nodes[g] * length;
      add_line(x, along, a, b, weight * length * rule.weights[g], sum);
    }
    start = pieces.at[n];
  }
}

/// Directions from the least to the most across the surface, each measured in cell widths.
KOKKOS_INLINE_FUNCTION void SolidQuadrature::order_axes(const Cell& cell, int (&axes)[3]) const {
  const Vec3 center = 0.5 * (cell.low + cell.high);
  const Vec3 gradient = program_.gradient(0, center + settings_.reference_point);
  Real change[3];
  for (int n = 0; n < 3; ++n) {
    axes[n] = n;
    change[n] = Kokkos::fabs(gradient[n]) * (cell.high[n] - cell.low[n]);
  }
  for (int n = 1; n < 3; ++n)
    for (int m = n; m > 0 && change[axes[m]] < change[axes[m - 1]]; --m) {
      const int other = axes[m];
      axes[m] = axes[m - 1];
      axes[m - 1] = other;
    }
}

/// True if the distance at the centre shows that the cell is all solid or all outside.
KOKKOS_INLINE_FUNCTION bool SolidQuadrature::is_uncut(const Cell& cell, Moments& moments) const {
  const Vec3 center = 0.5 * (cell.low + cell.high);
  const Real half_diagonal = 0.5 * norm(cell.high - cell.low);
  const Real value = distance(center, 0, center.x);
  if (Kokkos::fabs(value) < settings_.reach * half_diagonal) return false;
  if (value > 0) return true;
  // The line is exact along x, and the two-point Gauss rule across it for the second moments.
  const Vec3 size = cell.high - cell.low;
  const Real spread_y = size.y / Kokkos::sqrt(12.0), spread_z = size.z / Kokkos::sqrt(12.0);
  for (int j = -1; j <= 1; j += 2)
    for (int k = -1; k <= 1; k += 2)
      add_solid_line({0, center.y + j * spread_y, center.z + k * spread_z}, 0, cell.low.x, cell.high.x,
                     0.25 * size.y * size.z, moments);
  return true;
}

KOKKOS_INLINE_FUNCTION Moments SolidQuadrature::integrate(const Cell& cell, const GaussRule& rule) const {
  Moments moments;
  int axes[3];
  order_axes(cell, axes);
  const int first = axes[0];
  Vec3 x;
  Crossings pieces;
  for (int edge = 0; edge < 4; ++edge) {
    x[axes[1]] = (edge & 1 ? cell.high : cell.low)[axes[1]];
    x[axes[2]] = (edge & 2 ? cell.high : cell.low)[axes[2]];
    find_crossings(x, first, cell.low[first], cell.high[first], pieces);
  }
  pieces.insert(cell.high[first]);
  Real start = cell.low[first];
  for (int n = 0; n < pieces.count; ++n) {
    const Real length = pieces.at[n] - start;
    for (int g = 0; length > 0 && g < rule.order; ++g) {
      x[first] = start + rule.nodes[g] * length;
      add_plane(cell, x, axes, length * rule.weights[g], rule, moments);
    }
    start = pieces.at[n];
  }
  return moments;
}

KOKKOS_INLINE_FUNCTION void SolidQuadrature::add_cell(Vec3 low, Vec3 high, Moments& sum) const {
  Cell pending[1 + 7 * maximum_depth];
  int count = 0;
  pending[count++] = {low, high, 0};
  while (count > 0) {
    const Cell cell = pending[--count];
    if (is_uncut(cell, sum)) continue;
    const Moments moments = integrate(cell, settings_.rule);
    const bool is_last = cell.depth == maximum_depth;
    if (is_last ||
        Kokkos::fabs(moments.volume - integrate(cell, settings_.check).volume) <= settled * cell.volume()) {
      sum += moments;
      continue;
    }
    const Vec3 middle = 0.5 * (cell.low + cell.high);
    for (int n = 0; n < 8; ++n) {
      Cell& octant = pending[count++];
      octant = {cell.low, cell.high, cell.depth + 1};
      for (int axis = 0; axis < 3; ++axis) ((n >> axis) & 1 ? octant.low : octant.high)[axis] = middle[axis];
    }
  }
}

}  // namespace peclet
