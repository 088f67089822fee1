#include "flow/slits.hpp"

#include "flow/moving_walls.hpp"

namespace peclet::flow {

void Slits::reserve(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  if (face.extent(0) >= n) return;
  const std::size_t size = n + n / 4;
  face = Array<Index>("flow::slits.face", size);
  owner = Array<int>("flow::slits.owner", size);
  friction = Array<Real>("flow::slits.friction", size);
  wall_velocity = Array<Real>("flow::slits.wall_velocity", size);
  predicted = Array<Real>("flow::slits.predicted", size);
}

Index Slits::bytes() const {
  return static_cast<Index>(face.extent(0) * (sizeof(Index) + sizeof(int) + 3 * sizeof(Real)));
}

void build_slits(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open, Real viscous_area,
                 const CellList& near, const Array<Index>& scratch, Slits& slits) {
  const CellList candidates = near;
  const Field<OpenFraction> fraction = open[c];
  const Real diffusion = slit_diffusion(solid.grid, c, viscous_area);
  slits.count = list_where(
      "flow::list_slits", near.count, scratch,
      KOKKOS_LAMBDA(Index n) { return candidates.has(n, cell_part::slit, c); });
  slits.reserve(slits.count);
  const Slits target = slits;
  const SolidSampler sampler = solid;
  for_each(
      "flow::build_slits", slits.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = candidates.cell(scratch(n));
        const int i = cell[0], j = cell[1], k = cell[2];
        const Index p = fraction.layout()(i, j, k);
        target.face(n) = p;
        target.owner(n) = nearest_owner(sampler, c, p, sampler.grid.face_center(c, i, j, k));
        const int low = sampler.owner[p - fraction.layout().stride(c)], high = sampler.owner[p];
        const Real open_part = face_opening(sampler, c, i, j, k, low, high).open;
        target.friction(n) = slit_friction(open_part, diffusion);
      });
}

void refresh_slits(int c, const SolidSampler& solid, const Slits& slits) {
  const Slits target = slits;
  const SolidSampler sampler = solid;
  const Layout layout = solid.sdf.layout();
  for_each(
      "flow::refresh_slits", slits.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = cell_of(layout, target.face(n));
        const Vec3 x = sampler.grid.face_center(c, cell[0], cell[1], cell[2]);
        target.wall_velocity(n) = wall_velocity(sampler, NarrowGap(), target.owner(n), c, x);
      });
}

void impose_wall_velocity(const Slits& slits, const Field<Real>& velocity) {
  impose_values(slits.count, slits.face, slits.wall_velocity, velocity);
}

void to_velocity_with_friction(const Slits& slits, const Field<Real>& velocity) {
  const Slits source = slits;
  const Field<Real> u = velocity;
  for_each(
      "flow::slit_velocity_with_friction", slits.count, KOKKOS_LAMBDA(Index n) {
        const Index face = source.face(n);
        const Real wall = source.wall_velocity(n);
        u[face] = wall + (u[face] - wall) / (1 + source.friction(n));
      });
}

void to_velocity_without_friction(const Slits& slits, const Field<Real>& velocity) {
  const Slits source = slits;
  const Field<Real> u = velocity;
  for_each(
      "flow::slit_velocity_without_friction", slits.count, KOKKOS_LAMBDA(Index n) {
        const Index face = source.face(n);
        u[face] += source.friction(n) * (u[face] - source.wall_velocity(n));
      });
}

void impose_wall_velocity_where_uncovered(const Slits& slits, int body, const Field<OpenFraction>& open,
                                          const Field<Real>& velocity) {
  const Slits source = slits;
  const Field<Real> u = velocity;
  const Field<OpenFraction> fraction = open;
  for_each(
      "flow::impose_wall_velocity_where_uncovered", slits.count, KOKKOS_LAMBDA(Index n) {
        const Index face = source.face(n);
        if (source.owner(n) == body && is_fluid(fraction[face])) u[face] = source.wall_velocity(n);
      });
}

void compute_slit_residual(int c, const MomentumTerms& terms, const Slits& slits,
                           const Field<Real>& residual) {
  const Slits source = slits;
  const Field<Real> target = residual, p = terms.pressure;
  const Real forcing = terms.time_step * terms.acceleration[c];
  const Real scale = terms.time_step / (terms.density * terms.grid.spacing[c]);
  const Index own = p.layout().stride(c);
  for_each(
      "flow::slit_residual", slits.count, KOKKOS_LAMBDA(Index n) {
        const Index face = source.face(n);
        target[face] = forcing - scale * (p[face] - p[face - own]);
      });
}

void predict_slits(const Slits& slits, const Field<Real>& velocity, const Field<Real>& residual) {
  const Slits target = slits;
  const Field<Real> w = velocity, gain = residual;
  for_each(
      "flow::predict_slits", slits.count, KOKKOS_LAMBDA(Index n) {
        const Index face = target.face(n);
        const Real friction = target.friction(n);
        const Real u = (w[face] + friction * target.wall_velocity(n)) / (1 + friction);
        target.predicted(n) = u + gain[face];
      });
}

void impose_predicted_velocity(const Slits& slits, const Field<Real>& velocity) {
  impose_values(slits.count, slits.face, slits.predicted, velocity);
}

}  // namespace peclet::flow
