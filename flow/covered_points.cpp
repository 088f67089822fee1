#include "flow/covered_points.hpp"

#include <utility>

namespace peclet::flow {
namespace {

/// Bins of one body.
enum Bin : int { Velocity, Previous, Points, bins_per_body };

KOKKOS_INLINE_FUNCTION Vec3 position(const SolidSampler& solid, int c, Index p) {
  const Int3 cell = cell_of(solid.sdf.layout(), p);
  return solid.grid.face_center(c, cell[0], cell[1], cell[2]);
}

/// The body beside a point of component c; negative where there is none.
KOKKOS_INLINE_FUNCTION int body_beside(const SolidSampler& solid, int c, Index p) {
  const int low = solid.owner[p - solid.owner.layout().stride(c)], high = solid.owner[p];
  return low == high ? low : nearest_owner(solid, c, p, position(solid, c, p));
}

/// What covered points carry beyond the motion of their body, and the number of the others.
void sum_points(int c, const SolidSampler& solid, const Field<OpenFraction>& open, Index count,
                const Array<Index>& points, const Field<Real>& velocity, const Field<Real>& previous,
                const ScatterSum& sums) {
  const SolidSampler sampler = solid;
  const Field<OpenFraction> fraction = open;
  const Array<Index> point = points;
  const Field<Real> u = velocity, before = previous;
  const Bins bins = sums.bins();
  for_each_scattered(
      "flow::sum_covered_points", count, sums, KOKKOS_LAMBDA(Index n, int chunk) {
        const Index p = point(n);
        const int body = body_beside(sampler, c, p);
        if (body < 0) return;
        const int first = bins_per_body * body;
        if (is_fluid(fraction[p])) {
          bins.add(chunk, first + Points, 1);
        } else {
          const Real wall = sampler.geometry.velocity(body, position(sampler, c, p))[c];
          bins.add(chunk, first + Velocity, u[p] - wall);
          bins.add(chunk, first + Previous, before[p] - wall);
        }
      });
}

void add_shares(int c, const SolidSampler& solid, const Field<OpenFraction>& open, Index count,
                const Array<Index>& points, const Array<Real>& totals, const Field<Real>& velocity,
                const Field<Real>& previous) {
  const SolidSampler sampler = solid;
  const Field<OpenFraction> fraction = open;
  const Array<Index> point = points;
  const Array<Real> total = totals;
  const Field<Real> u = velocity, before = previous;
  for_each(
      "flow::hand_on_covered_momentum", count, KOKKOS_LAMBDA(Index n) {
        const Index p = point(n);
        if (!is_fluid(fraction[p])) return;
        const int body = body_beside(sampler, c, p);
        if (body < 0) return;
        const int first = bins_per_body * body;
        u[p] += total(first + Velocity) / total(first + Points);
        before[p] += total(first + Previous) / total(first + Points);
      });
}

}  // namespace

void CoveredPoints::remember(int c, const WallRows& rows) {
  const auto n = static_cast<std::size_t>(rows.count);
  if (points_[c].extent(0) < n) points_[c] = Array<Index>("flow::points_beside_bodies", n + n / 4);
  const auto listed = std::pair<std::size_t, std::size_t>(0, n);
  Kokkos::deep_copy(Kokkos::subview(points_[c], listed), Kokkos::subview(rows.face, listed));
  count_[c] = rows.count;
}

void CoveredPoints::hand_on(int c, const SolidSampler& solid, const Field<OpenFraction>& open,
                            int number_of_bodies, const Field<Real>& velocity, const Field<Real>& previous) {
  sums_.reset(bins_per_body * number_of_bodies);
  sum_points(c, solid, open, count_[c], points_[c], velocity, previous, sums_);
  add_shares(c, solid, open, count_[c], points_[c], sums_.join_chunks(), velocity, previous);
}

}  // namespace peclet::flow
