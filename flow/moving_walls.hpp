#pragma once
// What moving bodies impose on the grid: velocities of the faces inside them, and the volume that their
// surfaces sweep out of cut cells.
#include "core/field.hpp"
#include "flow/domain_sides.hpp"
#include "flow/near_cells.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// Closed faces (slits are not) of one component inside moving regions; they carry the velocity of their
/// body.
struct BodyFaces {
  Index count = 0;
  Array<Index> face;
  Array<int> owner;
  Array<Real> velocity;

  void reserve(Index capacity);
};

/// Cells with open and closed faces in moving regions. The flux through a whole face is
///   F = o u + integral of the wall velocity over its closed part,
/// so that sums over cells telescope and rigid motion of any closed body is compatible with a closed box.
struct CutCells {
  Index count = 0;
  Array<Index> cell;
  Array<Real> wall_flux;  // outward flux of the closed parts of all six faces per cell volume

  Index faces = 0;    // between cut cells or beside one, closed in part or whole
  Array<Index> face;  // 3 n + a: the low face along a of the near cell n
  Array<Real> swept;  // flux of the closed part of face 3 n + a, per area

  void reserve(Index capacity);
  void reserve_faces(Index near_cells);
};

void build_body_faces(int c, const SolidSampler& solid, const CellList& near, const Array<Index>& scratch,
                      BodyFaces& faces);
void build_cut_cells(const Layout& layout, const CellList& near, const Array<Index>& scratch,
                     CutCells& cells);

/// Recompute velocities and fluxes from the present motion of the bodies.
void refresh_body_faces(int c, const SolidSampler& solid, const BodyFaces& faces);
void refresh_cut_cells(const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                       const DomainSides& sides, const CellList& near, const Field<int>& marks,
                       const CutCells& cells);

/// velocity[face] = value, for the first count faces.
void impose_values(Index count, const Array<Index>& faces, const Array<Real>& values,
                   const Field<Real>& velocity);

/// velocity[face] = velocity of the body there.
void impose_body_velocity(const BodyFaces& faces, const Field<Real>& velocity);

}  // namespace peclet::flow
