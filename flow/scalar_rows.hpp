#pragma once
// Cells whose diffusion stencil touches a wall or a side of the box: a compact list beside the grid sweep.
//
// Beside walls of given value, a fluid cell centre sees the wall at its true distance along each axis
// [ShortleyWeller1938]. Beside walls of given flux, the balance of the fluid part of the cell counts
// [NgMinGibou2009]: with volume fraction V and open fractions o of its faces,
//   V dc/dt = sum over faces of o D (c_neighbour - c) / h^2 + flux * (wall area) / (cell volume),
// the wall area being the length of the vector of closed face areas, so that linear fields are exact.
// Both kinds are rows of WallRows, so that the viscous solver takes them.
#include "flow/scalar.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// Smallest fluid part of a cell that counts: bounds the advective CFL number.
inline constexpr float smallest_cell_volume = 0.125F;

/// The geometry as scalars see it.
struct ScalarGeometry {
  SolidSampler solid;
  FaceVector<OpenFraction> open;
  ScalarSides sides;
  Array<ScalarWall> walls;  // of the body or solid with this owner, at owner + 2

  KOKKOS_INLINE_FUNCTION const ScalarWall& wall(int owner) const { return walls.data()[owner + 2]; }
  KOKKOS_INLINE_FUNCTION bool gives_value(int owner) const {
    return owner != no_owner && wall(owner).condition == ScalarCondition::Value;
  }
};

struct ScalarRows {
  static constexpr int directions = WallRows::directions;
  static constexpr int body_slot = directions;  // of given: the wall in the cell; below: a side of the box

  WallRows links;  // weight: of each neighbour or wall in (V - theta dt D L) / V
  Kokkos::View<Real* [directions], MemorySpace> coefficient;  // the weights in double precision
  Kokkos::View<Real* [directions], MemorySpace> wall_value;
  Kokkos::View<Real * [directions + 1], MemorySpace> given;  // amount per time from walls of given flux
  Array<Real> source;                                        // their sum over the fluid volume of the cell

  void reserve(Index capacity);
  KOKKOS_INLINE_FUNCTION bool is_side(int giver) const { return giver < sampled_solid; }
};

/// State and volume fraction of every cell, ghosts included.
void classify_cells(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                    const Field<float>& volume);

void build_scalar_rows(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                       const Field<float>& volume, const Array<Index>& scratch, ScalarRows& rows);

/// Solid cells beside fluid ones that no wall of given value owns; their value is a mean of the fluid beside
/// them, which the face values of higher order look at, and from which uncovered cells start.
struct ExtensionCells {
  Index count = 0;
  Array<Index> cell;
};
void build_extension(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                     const Array<Index>& scratch, ExtensionCells& cells);
void extend_into_solid(const ExtensionCells& cells, const Field<OpenFraction>& state,
                       const Field<Real>& value);

}  // namespace peclet::flow
