#include "flow/volume_defect.hpp"

namespace peclet::flow {
namespace {

/// Bins of one body: volume and leverage of each component.
enum Bin : int { Volume = 0, Leverage = 3, bins_per_body = 12 };

/// What the points at the low faces of the cells of one row have.
struct DefectsOfRow {
  SolidSampler solid;
  FaceVector<OpenFraction> open;
  DomainSides sides;
  Bins bins;
  int bodies;

  KOKKOS_INLINE_FUNCTION void operator()(Index row, int chunk) const {
    const Grid& grid = solid.grid;
    const int j = static_cast<int>(row % grid.cells[1]), k = static_cast<int>(row / grid.cells[1]);
    for (int i = 0; i < grid.cells[0]; ++i) {
      const Index p = solid.sdf.layout()(i, j, k);
      if (is_near_surface(p)) add_cell(p, {i, j, k}, chunk);
    }
  }

 private:
  /// Whether the cell or one of its low neighbours is cut by the smooth step.
  KOKKOS_INLINE_FUNCTION bool is_near_surface(Index p) const {
    const Real3& h = solid.grid.spacing;
    const Real reach = 2 * Kokkos::fmax(h[0], Kokkos::fmax(h[1], h[2]));
    bool near = Kokkos::abs(solid.sdf[p]) < reach;
    for (int a = 0; a < 3; ++a)
      near = near | (Kokkos::abs(solid.sdf[p - solid.sdf.layout().stride(a)]) < reach);
    return near;
  }

  /// Spacing along the normal of the nearest surface.
  KOKKOS_INLINE_FUNCTION Real width(Index p) const {
    Real differences = 0, slopes = 0;
    for (int a = 0; a < 3; ++a) {
      const Index step = solid.sdf.layout().stride(a);
      const Real difference = solid.sdf[p + step] - solid.sdf[p - step];
      const Real slope = difference / solid.grid.spacing[a];
      differences += difference * difference;
      slopes += slope * slope;
    }
    return slopes > 0 ? Kokkos::sqrt(differences / slopes) : solid.grid.smallest_spacing();
  }

  KOKKOS_INLINE_FUNCTION void add_cell(Index p, const Int3& cell, int chunk) const {
    const Real normal_width = width(p), here = smooth_fluid_part(solid.sdf[p], normal_width);
    for (int c = 0; c < 3; ++c) {
      for (int high = 0; high < 2; ++high)
        if (sides.is_side(c, cell[c] + high, solid.grid.cells)) add_at_side(p, cell, c, high, here, chunk);
      if (sides.is_side(c, cell[c], solid.grid.cells)) continue;
      const Index low = p - solid.sdf.layout().stride(c);
      const Real part = 0.5 * (here + smooth_fluid_part(solid.sdf[low], normal_width));
      const int owner = solid.owner[solid.sdf[p] < solid.sdf[low] ? p : low];
      add(owner, c, part - is_fluid(open[c][p]), cell, chunk);
    }
  }

  /// Between a side and the middle of the cell beside it there is no point, and no body that only touches the
  /// side as far as the points know.
  KOKKOS_INLINE_FUNCTION void add_at_side(Index p, Int3 cell, int c, int high, Real part, int chunk) const {
    const int owner = solid.owner[p];
    if (owner >= 0 && solid.geometry.bodies(owner).is_cut[c][high]) return;
    cell[c] += high;
    add(owner, c, 0.5 * (part - 1), cell, chunk);
  }

  /// A part of the cell around a point at the low face of a cell along c.
  KOKKOS_INLINE_FUNCTION void add(int owner, int c, Real part, const Int3& cell, int chunk) const {
    if (part == 0) return;
    const Real volume = part * solid.grid.cell_volume();
    const int first = bins_per_body * (owner >= 0 ? owner : bodies);
    bins.add(chunk, first + Volume + c, volume);
    if (owner < 0) return;
    Vec3 along;
    along[c] = volume;
    const Vec3 torque =
        cross(solid.geometry.lever(owner, solid.grid.face_center(c, cell[0], cell[1], cell[2])), along);
    for (int a = 0; a < 3; ++a) bins.add(chunk, first + Leverage + 3 * c + a, torque[a]);
  }
};

}  // namespace

const std::vector<VolumeDefect>& VolumeDefects::find(const ImmersedBoundary& boundary,
                                                     const DomainSides& sides, int bodies) {
  if (revision_ == boundary.revision()) return defects_;
  revision_ = boundary.revision();
  sums_.reset(bins_per_body * (bodies + 1));
  const SolidSampler& solid = boundary.solid();
  const Int3& cells = solid.grid.cells;
  for_each_scattered("flow::find_volume_defects", static_cast<Index>(cells[1]) * cells[2], sums_,
                     DefectsOfRow{solid, boundary.open(), sides, sums_.bins(), bodies});
  const std::vector<Real> totals = sums_.totals();
  defects_.assign(static_cast<std::size_t>(bodies) + 1, {});
  for (std::size_t b = 0; b < defects_.size(); ++b)
    for (int c = 0; c < 3; ++c) {
      const Real* const of_body = totals.data() + b * bins_per_body;
      defects_[b].volume[c] = of_body[Volume + c];
      for (int a = 0; a < 3; ++a) defects_[b].leverage[c][a] = of_body[Leverage + 3 * c + a];
    }
  return defects_;
}

}  // namespace peclet::flow
