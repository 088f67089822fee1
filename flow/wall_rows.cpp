#include "flow/wall_rows.hpp"

namespace peclet::flow {

void WallRows::reserve(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  if (face.extent(0) >= n) return;
  const std::size_t size = face.extent(0) == 0 ? n : n + n / 4;
  face = Array<Index>("flow::wall_rows.face", size);
  distance = Kokkos::View<float* [directions], MemorySpace>("flow::wall_rows.distance", size);
  weight = Kokkos::View<float* [directions], MemorySpace>("flow::wall_rows.weight", size);
  owner = Kokkos::View<int* [directions], MemorySpace>("flow::wall_rows.owner", size);
  walls = Array<std::uint8_t>("flow::wall_rows.walls", size);
  wall_sum = Array<Real>("flow::wall_rows.wall_sum", size);
  dilation = Array<Real>("flow::wall_rows.dilation", size);
  superseded = Array<std::uint8_t>("flow::wall_rows.superseded", size);
  chains.next = Array<int>("flow::wall_rows.next", size);
}

namespace {

/// Distances and owners of the row of component c at the low face of a cell.
KOKKOS_INLINE_FUNCTION void fill_row(const WallRows& rows, Index row, int c, const SolidSampler& solid,
                                     const FaceVector<OpenFraction>& open, const DomainSides& sides,
                                     const Int3& at) {
  const Layout& layout = open.x.layout();
  const Index p = layout(at[0], at[1], at[2]);
  const Vec3 x = solid.grid.face_center(c, at[0], at[1], at[2]);
  const int nearest = nearest_owner(solid, c, p, x);
  int walls = 0;
  for (int a = 0; a < 3; ++a) {
    for (int s = 0; s < 2; ++s) {
      const int d = 2 * a + s;
      const Index q = p + (s ? layout.stride(a) : -layout.stride(a));
      rows.distance(row, d) = rows.weight(row, d) = 1;
      rows.owner(row, d) = nearest;
      if (is_fluid(open[c][q])) continue;
      const bool on_side = a == c && sides.is_side(a, at[a] + (s ? 1 : -1), layout.cells);
      if (on_side && solid.sdf[s ? p : q] >= 0) continue;
      walls |= 1 << d;
      Vec3 y = x;
      y[a] += (s ? 1 : -1) * solid.grid.spacing[a];
      const int wall = nearest_owner(solid, c, q, y);
      rows.owner(row, d) = wall;
      rows.distance(row, d) = static_cast<float>(wall_crossing(solid, wall, nearest, x, y));
    }
  }
  rows.face(row) = p;
  rows.walls(row) = static_cast<std::uint8_t>(walls);
  rows.superseded(row) = 0;
}

/// Gradient of the distance at the low face p across axis c.
KOKKOS_INLINE_FUNCTION Vec3 distance_gradient(const SolidSampler& solid, int c, Index p) {
  const Field<Real>& sdf = solid.sdf;
  const Index q = p - sdf.layout().stride(c);
  Vec3 gradient;
  for (int a = 0; a < 3; ++a) {
    const Index step = sdf.layout().stride(a);
    const Real change =
        a == c ? sdf[p] - sdf[q] : 0.25 * (sdf[p + step] - sdf[p - step] + sdf[q + step] - sdf[q - step]);
    gradient[a] = change / solid.grid.spacing[a];
  }
  return gradient;
}

KOKKOS_INLINE_FUNCTION Real nearest_wall(const WallRows& rows, Index row) {
  Real nearest = 1;
  for (int d = 0; d < WallRows::directions; ++d)
    nearest = Kokkos::min(nearest, static_cast<Real>(rows.distance(row, d)));
  return nearest;
}

/// Smallest distance to walls, in spacings, that enters the stencil of the point at x, the low face p across
/// axis c; never more than smallest_approach_distance.
KOKKOS_INLINE_FUNCTION Real least_distance(const SolidSampler& solid, int c, Index p, Vec3 x,
                                           Real viscosity) {
  const int body = nearest_owner(solid, c, p, x);
  if (body < 0) return smallest_wall_distance;
  const Vec3 gradient = distance_gradient(solid, c, p);
  const Real steepness = norm(gradient);
  if (steepness == 0) return smallest_wall_distance;
  const Real normal_speed = Kokkos::abs(dot(solid.geometry.velocity(body, x), gradient)) / steepness;
  if (normal_speed == 0) return smallest_wall_distance;
  const Real reach = normal_speed * solid.grid.smallest_spacing();
  const Real along_normal = gradient[c] * gradient[c] / (steepness * steepness);  // n_c^2
  const Real moving =
      smallest_sliding_distance + (smallest_approach_distance - smallest_sliding_distance) * along_normal;
  return smallest_wall_distance +
         (moving - smallest_wall_distance) * reach / (reach + cell_reynolds_of_half_rise * viscosity);
}

/// Weights of a row whose wall distances are at least least; they stay 1 along axes without a wall.
KOKKOS_INLINE_FUNCTION void set_weights(const WallRows& rows, Index row, Real least) {
  for (int a = 0; a < 3; ++a) {
    if (!rows.is_wall(row, 2 * a) && !rows.is_wall(row, 2 * a + 1)) continue;
    Real distance[2];
    for (int s = 0; s < 2; ++s)
      distance[s] = Kokkos::max(static_cast<Real>(rows.distance(row, 2 * a + s)), least);
    const Real total = Kokkos::max(distance[0] + distance[1], Real{narrowest_stencil});
    for (int s = 0; s < 2; ++s) rows.weight(row, 2 * a + s) = static_cast<float>(2 / (distance[s] * total));
  }
}

}  // namespace

void chain_rows(const Layout& layout, WallRows& rows) {
  RowChains& chains = rows.chains;
  chains.rows_per_plane = layout.cells[1] + 1;
  const auto number_of_rows = static_cast<std::size_t>(chains.rows_per_plane * (layout.cells[2] + 1));
  if (chains.first.extent(0) != number_of_rows)
    chains.first = Array<int>("flow::wall_rows.first", number_of_rows);
  Kokkos::deep_copy(chains.first, -1);
  const WallRows target = rows;
  for_each(
      "flow::chain_wall_rows", rows.count, KOKKOS_LAMBDA(Index row) {
        const Int3 cell = cell_of(layout, target.face(row));
        int& first = target.chains.first(static_cast<std::size_t>(target.chains.row(cell[1], cell[2])));
        target.chains.next(row) = Kokkos::atomic_exchange(&first, static_cast<int>(row));
      });
}

void build_wall_rows(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                     const DomainSides& sides, const CellList& near, const Array<Index>& scratch,
                     WallRows& rows) {
  const CellList candidates = near;
  const FaceVector<OpenFraction> fraction = open;
  const Layout layout = open.x.layout();
  const DomainSides box = sides;
  const SolidSampler sampler = solid;
  rows.count = list_where(
      "flow::list_wall_rows", near.count, scratch,
      KOKKOS_LAMBDA(Index n) { return candidates.has(n, cell_part::wall_row, c); });
  rows.reserve(rows.count);
  const WallRows target = rows;
  for_each(
      "flow::build_wall_rows", rows.count, KOKKOS_LAMBDA(Index row) {
        fill_row(target, row, c, sampler, fraction, box, candidates.cell(scratch(row)));
      });
  chain_rows(layout, rows);
}

void refresh_wall_motion(int c, const SolidSampler& solid, Real viscosity, const WallRows& rows) {
  const SolidSampler sampler = solid;
  const WallRows target = rows;
  const Layout layout = solid.sdf.layout();
  for_each(
      "flow::refresh_wall_motion", rows.count, KOKKOS_LAMBDA(Index row) {
        target.wall_sum(row) = 0;
        if (target.walls(row) == 0) return;
        const Index p = target.face(row);
        const Int3 cell = cell_of(layout, p);
        const Vec3 x = sampler.grid.face_center(c, cell[0], cell[1], cell[2]);
        const Real least = nearest_wall(target, row) < smallest_approach_distance
                               ? least_distance(sampler, c, p, x, viscosity)
                               : smallest_approach_distance;
        set_weights(target, row, least);
        const NarrowGap gap = narrow_gap(sampler, c, cell[0], cell[1], cell[2]);
        Real sum = 0;
        for (int d = 0; d < WallRows::directions; ++d) {
          const int body = target.owner(row, d);
          if (!target.is_wall(row, d)) continue;
          const int a = d / 2;
          const Real h = sampler.grid.spacing[a];
          Vec3 wall = x;
          wall[a] += (d % 2 ? 1 : -1) * h * target.distance(row, d);
          sum += target.weight(row, d) * wall_velocity(sampler, gap, body, c, wall, Motion::Mean) / (h * h);
        }
        target.wall_sum(row) = sum;
      });
}

}  // namespace peclet::flow
