#pragma once
// Slits: faces beside moving bodies that are open in part although their centre is solid. They carry mass, so
// that the projection sees the surface and not a staircase of closed faces, whose added mass is too large by
// O(h). They are no points of the momentum grid: the pressure drives their velocity u, and the wall nearby,
// of velocity U, holds it back,
//   (u_new - u) / dt = -grad p / rho + f / rho + lambda / dt (U - u_new),
//   lambda = 2 nu dt / (l (1 + l) h^2),
// l being the distance of the middle of the open part to the wall, in spacings h. The projection knows the
// velocity without friction, w = (1 + lambda) u - lambda U, and the flux through a face of open part O is
//   O u + (1 - O) U = o w + (1 - o) U  with the open fraction  o = O / (1 + lambda):
// slits are open to inertia and closed to creeping flow, for which the no-slip wall lets nothing through.
//
// Between steps slits hold w. A step in which the body moves changes lambda, and turns slits into points of
// the fluid and back: they pass on u. A point of the fluid that took w would exceed it (1 + lambda) times.
#include "flow/momentum.hpp"
#include "flow/near_cells.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// nu dt / h^2 from nu dt, h being the smaller edge of a face across axis.
KOKKOS_INLINE_FUNCTION Real slit_diffusion(const Grid& grid, int axis, Real viscous_area) {
  const Real h = Kokkos::fmin(grid.spacing[(axis + 1) % 3], grid.spacing[(axis + 2) % 3]);
  return viscous_area / (h * h);
}

/// lambda from the open part O of the face and nu dt / h^2.
KOKKOS_INLINE_FUNCTION Real slit_friction(Real open_part, Real diffusion) {
  const Real distance = 0.5 * open_part;
  return 2 * diffusion / (distance * (1 + distance));
}

/// Slits of one velocity component.
struct Slits {
  Index count = 0;
  Array<Index> face;
  Array<int> owner;
  Array<Real> friction;       // lambda
  Array<Real> wall_velocity;  // U
  Array<Real> predicted;      // w before the projection

  void reserve(Index capacity);
  Index bytes() const;
};

/// Lists the slits of component c among the cells near walls. viscous_area = nu dt.
void build_slits(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open, Real viscous_area,
                 const CellList& near, const Array<Index>& scratch, Slits& slits);

/// Recomputes U from the present velocities of the bodies.
void refresh_slits(int c, const SolidSampler& solid, const Slits& slits);

/// velocity = U.
void impose_wall_velocity(const Slits& slits, const Field<Real>& velocity);

/// velocity: from w to u, and back.
void to_velocity_with_friction(const Slits& slits, const Field<Real>& velocity);
void to_velocity_without_friction(const Slits& slits, const Field<Real>& velocity);

/// velocity = U where body moved away from a slit and left a fluid point.
void impose_wall_velocity_where_uncovered(const Slits& slits, int body, const Field<OpenFraction>& open,
                                          const Field<Real>& velocity);

/// residual = dt (-grad p + f) / rho of component c.
void compute_slit_residual(int c, const MomentumTerms& terms, const Slits& slits,
                           const Field<Real>& residual);
/// w = u + residual.
void predict_slits(const Slits& slits, const Field<Real>& velocity, const Field<Real>& residual);
/// velocity = predicted w.
void impose_predicted_velocity(const Slits& slits, const Field<Real>& velocity);

}  // namespace peclet::flow
