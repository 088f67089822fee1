#pragma once
// Open fractions of the faces of cells, from the signed distance at their centres.
#include "flow/near_cells.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// What determines the fraction of a face, besides where it is.
struct FaceOpener {
  SolidSampler solid;
  Real half_diagonal = 0;  // of a cell
  Real viscous_area = 0;   // nu dt, see flow/slits.hpp

  FaceOpener(const SolidSampler& sampler, Real area);
};

/// Opens the low faces of all cells and marks those that the fixed solid touches.
void open_fixed_faces(const FaceOpener& opener, const FaceVector<OpenFraction>& open,
                      const Field<int>& marks);

/// The same for the band around moving bodies.
void open_moving_faces(const FaceOpener& opener, const CellList& band, const FaceVector<OpenFraction>& open,
                       const Field<int>& marks);

}  // namespace peclet::flow
