#include "flow/open_faces.hpp"

#include <cmath>

#include "flow/slits.hpp"

namespace peclet::flow {
namespace {

/// Fraction of the low face of cell (i, j, k) along axis. The face is fluid where the mean distance of its
/// two cells is not negative, and then never quite closed; else it is closed, or a slit of a moving body.
KOKKOS_INLINE_FUNCTION OpenFraction open_fraction_at(const FaceOpener& opener, int axis, int i, int j,
                                                     int k) {
  const SolidSampler& solid = opener.solid;
  const Index p = solid.sdf.layout()(i, j, k);
  const Index q = p - solid.sdf.layout().stride(axis);
  const Real low = solid.sdf[q], high = solid.sdf[p];
  const bool is_solid = 0.5 * (low + high) < 0;
  if (low > opener.half_diagonal || high > opener.half_diagonal) return fully_open;
  if (low < -opener.half_diagonal || high < -opener.half_diagonal) return 0;
  // what two surfaces squeeze out of a narrow gap could not pass through what the geometry leaves open
  if (narrow_gap(solid, axis, i, j, k).share > 0) return is_solid ? OpenFraction(0) : fully_open;
  const Real open = face_opening(solid, axis, i, j, k, solid.owner[q], solid.owner[p]).open;
  if (is_solid) {
    const int owner = nearest_owner(solid, axis, p, solid.grid.face_center(axis, i, j, k));
    if (open == 0 || owner < 0 || !solid.geometry.bodies(owner).dynamic) return 0;
    const Real friction = slit_friction(open, slit_diffusion(solid.grid, axis, opener.viscous_area));
    const auto slit = static_cast<OpenFraction>(open / (1 + friction) * fully_open);
    return slit < smallest_slit ? OpenFraction(0) : OpenFraction(slit | 1);
  }
  const auto quantised = static_cast<OpenFraction>(2 * Kokkos::round(0.5 * open * fully_open));
  return quantised < smallest_open_fraction ? smallest_open_fraction : quantised;
}

/// Opens the low faces of cell (i, j, k); returns whether a wall touches them or the cell is solid.
KOKKOS_INLINE_FUNCTION bool open_cell_faces(const FaceOpener& opener, const FaceVector<OpenFraction>& open,
                                            int i, int j, int k) {
  const Index p = opener.solid.sdf.layout()(i, j, k);
  const Real distance = opener.solid.sdf[p];
  if (distance > opener.half_diagonal) {
    for (int a = 0; a < 3; ++a) open[a][p] = fully_open;
    return false;
  }
  bool touched = distance < 0;
  for (int a = 0; a < 3; ++a) {
    const OpenFraction fraction = open_fraction_at(opener, a, i, j, k);
    open[a][p] = fraction;
    touched = touched || fraction < fully_open;
  }
  return touched;
}

}  // namespace

FaceOpener::FaceOpener(const SolidSampler& sampler, Real area) : solid(sampler), viscous_area(area) {
  const Real3& h = sampler.grid.spacing;
  half_diagonal = 0.5 * std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}

void open_fixed_faces(const FaceOpener& opener, const FaceVector<OpenFraction>& open,
                      const Field<int>& marks) {
  const FaceOpener source = opener;
  const FaceVector<OpenFraction> target = open;
  const Field<int> mark = marks;
  for_each_cell(
      "flow::open_fixed_faces", RowRanges(marks.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const bool touched = open_cell_faces(source, target, i, j, k);
        mark(i, j, k) = touched ? cell_mark::touched | cell_mark::touched_by_fixed : 0;
      });
}

void open_moving_faces(const FaceOpener& opener, const CellList& band, const FaceVector<OpenFraction>& open,
                       const Field<int>& marks) {
  const FaceOpener source = opener;
  const CellList cells = band;
  const FaceVector<OpenFraction> target = open;
  const Field<int> mark = marks;
  for_each(
      "flow::open_moving_faces", band.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = cells.cell(n);
        const bool touched = open_cell_faces(source, target, cell[0], cell[1], cell[2]);
        const Index p = mark.layout()(cell[0], cell[1], cell[2]);
        if (touched) mark[p] |= cell_mark::touched;
      });
}

}  // namespace peclet::flow
