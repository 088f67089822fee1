#include "flow/immersed_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace peclet::flow {
namespace {

/// Cells around a body in which it can change a distance, a face, or a stencil.
constexpr int region_margin = 3;

void sample_body(const SolidSampler& solid, const RegionList& regions) {
  const RegionView region = regions.view();
  const SolidSampler target = solid;
  for_each(
      "flow::sample_body", regions.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(n);
        const int body = region.body(cell.region);
        const Real d = target.geometry.distance(body, target.grid.cell_center(cell.i, cell.j, cell.k));
        if (d < target.sdf(cell.i, cell.j, cell.k)) {
          target.sdf(cell.i, cell.j, cell.k) = d;
          target.owner(cell.i, cell.j, cell.k) = body;
        }
      });
}

/// Distance and owner of every cell in the regions: fixed solid or any of the overlapping moving bodies.
void sample_region_cells(const SolidSampler& solid, const Field<Real>& fixed_sdf,
                         const Field<int>& fixed_owner, const RegionList& regions) {
  const RegionView region = regions.view();
  const SolidSampler target = solid;
  for_each(
      "flow::sample_region_cells", regions.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(n);
        if (!cell.unique) return;
        const Index p = target.sdf.layout()(cell.i, cell.j, cell.k);
        const Vec3 x = target.grid.cell_center(cell.i, cell.j, cell.k);
        Real nearest = fixed_sdf[p];
        int owner = fixed_owner[p];
        for (int m = region.first_neighbor(cell.region); m < region.first_neighbor(cell.region + 1); ++m) {
          const int body = region.body(region.neighbors(m));
          const Real d = target.geometry.distance(body, x);
          if (d < nearest) {
            nearest = d;
            owner = body;
          }
        }
        target.sdf[p] = nearest;
        target.owner[p] = owner;
      });
}

/// Fraction of the low face of cell (i, j, k) along axis. The face is fluid where the mean distance of its
/// two cells is not negative, and then never quite closed; else it is closed, or a slit of a moving body.
/// viscous_area = nu dt.
KOKKOS_INLINE_FUNCTION OpenFraction open_fraction_at(const SolidSampler& solid, int axis, int i, int j, int k,
                                                     Real half_diagonal, Real viscous_area) {
  const Index p = solid.sdf.layout()(i, j, k);
  const Index q = p - solid.sdf.layout().stride(axis);
  const Real low = solid.sdf[q], high = solid.sdf[p];
  const bool is_solid = 0.5 * (low + high) < 0;
  if (low > half_diagonal || high > half_diagonal) return fully_open;
  if (low < -half_diagonal || high < -half_diagonal) return 0;
  // what two surfaces squeeze out of a narrow gap could not pass through what the geometry leaves open
  if (narrow_gap(solid, axis, i, j, k).share > 0) return is_solid ? OpenFraction(0) : fully_open;
  const Real open = face_opening(solid, axis, i, j, k, solid.owner[q], solid.owner[p]).open;
  if (is_solid) {
    const int owner = nearest_owner(solid, axis, p, solid.grid.face_center(axis, i, j, k));
    if (open == 0 || owner < 0 || !solid.geometry.bodies(owner).dynamic) return 0;
    const Real friction = slit_friction(open, slit_diffusion(solid.grid, axis, viscous_area));
    const auto slit = static_cast<OpenFraction>(open / (1 + friction) * fully_open);
    return slit < smallest_slit ? OpenFraction(0) : OpenFraction(slit | 1);
  }
  const auto quantised = static_cast<OpenFraction>(2 * Kokkos::round(0.5 * open * fully_open));
  return quantised < smallest_open_fraction ? smallest_open_fraction : quantised;
}

Real half_diagonal_of(const Grid& grid) {
  return 0.5 * std::sqrt(grid.spacing[0] * grid.spacing[0] + grid.spacing[1] * grid.spacing[1] +
                         grid.spacing[2] * grid.spacing[2]);
}

/// Opens the low faces of cell (i, j, k); returns whether a wall touches them or the cell is solid.
KOKKOS_INLINE_FUNCTION bool open_cell_faces(const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                                            int i, int j, int k, Real half_diagonal, Real viscous_area) {
  bool touched = solid.sdf(i, j, k) < 0;
  for (int a = 0; a < 3; ++a) {
    const OpenFraction fraction = open_fraction_at(solid, a, i, j, k, half_diagonal, viscous_area);
    open[a](i, j, k) = fraction;
    touched = touched || fraction < fully_open;
  }
  return touched;
}

/// None of the bodies moves.
void open_all_faces(const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                    const Field<std::uint8_t>& marks) {
  const SolidSampler sampler = solid;
  const FaceVector<OpenFraction> target = open;
  const Field<std::uint8_t> mark = marks;
  const Real half_diagonal = half_diagonal_of(solid.grid);
  for_each_cell(
      "flow::open_all_faces", RowRanges(solid.grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const bool touched = open_cell_faces(sampler, target, i, j, k, half_diagonal, 0);
        mark(i, j, k) = touched ? cell_mark::touched | cell_mark::touched_by_fixed : 0;
      });
}

void open_region_faces(const SolidSampler& solid, const FaceVector<OpenFraction>& open, Real viscous_area,
                       const Field<std::uint8_t>& marks, const RegionList& regions) {
  const RegionView region = regions.view();
  const SolidSampler sampler = solid;
  const FaceVector<OpenFraction> target = open;
  const Field<std::uint8_t> mark = marks;
  const Real half_diagonal = half_diagonal_of(solid.grid);
  for_each(
      "flow::open_region_faces", regions.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(n);
        if (!cell.unique) return;
        const bool touched =
            open_cell_faces(sampler, target, cell.i, cell.j, cell.k, half_diagonal, viscous_area);
        const Index p = mark.layout()(cell.i, cell.j, cell.k);
        mark[p] = static_cast<std::uint8_t>((mark[p] & cell_mark::touched_by_fixed) | cell_mark::in_region |
                                            (touched ? cell_mark::touched : 0));
      });
}

void mark_superseded(const Field<std::uint8_t>& marks, const WallRows& rows) {
  const WallRows target = rows;
  const Field<std::uint8_t> mark = marks;
  for_each(
      "flow::mark_superseded", rows.count,
      KOKKOS_LAMBDA(Index n) { target.superseded(n) = mark[target.face(n)] & cell_mark::in_region; });
}

/// Pressure of closed cells beside open ones := mean over the open neighbours.
void extrapolate_pressure(const FaceVector<OpenFraction>& open, const DomainSides& sides,
                          const NearCells& near, const Field<Real>& pressure) {
  const NearCells candidates = near;
  const FaceVector<OpenFraction> fraction = open;
  const Field<Real> p = pressure;
  const Int3 cells = pressure.layout().cells;
  const DomainSides box = sides;
  for_each(
      "flow::extrapolate_pressure", near.count, KOKKOS_LAMBDA(Index m) {
        const Int3 at = candidates.cell(m);
        const Layout& layout = p.layout();
        const Index n = layout(at[0], at[1], at[2]);
        for (int a = 0; a < 3; ++a)
          if (fraction[a][n] || fraction[a][n + layout.stride(a)]) return;  // an open cell
        Real sum = 0;
        int count = 0;
        for (int d = 0; d < 6; ++d) {
          const int a = d / 2;
          int q[3] = {at[0], at[1], at[2]};
          q[a] += d % 2 ? 1 : -1;
          if (!box.is_periodic(a) && (q[a] < 0 || q[a] == cells[a])) continue;
          q[a] = q[a] < 0 ? q[a] + cells[a] : (q[a] >= cells[a] ? q[a] - cells[a] : q[a]);
          const Index neighbor = layout(q[0], q[1], q[2]);
          bool is_open = false;
          for (int b = 0; b < 3; ++b)
            is_open = is_open || fraction[b][neighbor] || fraction[b][neighbor + layout.stride(b)];
          if (!is_open) continue;
          sum += p[neighbor];
          ++count;
        }
        if (count > 0) p[n] = sum / count;
      });
}

/// Per row of cells, the range outside which every face is closed; it begins on whole vectors.
RowRanges open_row_ranges(const FaceVector<OpenFraction>& open_fractions, const Int3& n) {
  RowRanges rows(n);
  const auto count = static_cast<std::size_t>(rows.number_of_rows());
  rows.first = Array<int>("flow::rows.first", count);
  rows.last = Array<int>("flow::rows.last", count);
  const FaceVector<OpenFraction> open = open_fractions;
  const Array<int> first = rows.first, last = rows.last;
  const Layout layout = open.x.layout();
  for_each(
      "flow::open_row_ranges", rows.number_of_rows(), KOKKOS_LAMBDA(Index row) {
        const int j = static_cast<int>(row % n[1]), k = static_cast<int>(row / n[1]);
        int begin = n[0], end = 0;
        for (int i = 0; i < n[0]; ++i) {
          const Index p = layout(i, j, k);
          bool any = false;
          for (int a = 0; a < 3; ++a) any = any || open[a][p] || open[a][p + layout.stride(a)];
          if (!any) continue;
          begin = i < begin ? i : begin;
          end = i + 1;
        }
        first(row) = end > begin ? begin / Layout::alignment * Layout::alignment : 0;
        last(row) = end > begin ? end : 0;
      });
  return rows;
}

/// What the fixed solid alone leaves.
struct FixedGeometry {
  Field<Real> sdf;
  Field<int> owner;
  FaceVector<OpenFraction> open;
};

/// The regions as the fixed solid alone left them.
void restore_fixed(const SolidSampler& solid, const FixedGeometry& fixed,
                   const FaceVector<OpenFraction>& open, const Field<std::uint8_t>& marks,
                   const RegionList& regions) {
  const RegionView region = regions.view();
  const SolidSampler target = solid;
  const FixedGeometry source = fixed;
  const FaceVector<OpenFraction> fraction = open;
  const Field<std::uint8_t> mark = marks;
  for_each(
      "flow::restore_fixed", regions.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.cell(n);
        const Index p = target.sdf.layout()(cell.i, cell.j, cell.k);
        target.sdf[p] = source.sdf[p];
        target.owner[p] = source.owner[p];
        for (int a = 0; a < 3; ++a) fraction[a][p] = source.open[a][p];
        mark[p] =
            mark[p] & cell_mark::touched_by_fixed ? cell_mark::touched | cell_mark::touched_by_fixed : 0;
      });
}

}  // namespace

ImmersedBoundary::ImmersedBoundary(const Grid& grid, const DomainSides& sides)
    : grid_(grid),
      sides_(sides),
      open_("flow::open", Layout(grid.cells)),
      rows_(grid.cells),
      regions_(grid.cells) {
  const Layout layout(grid.cells);
  solid_.grid = grid;
  solid_.sdf = Field<Real>("flow::sdf", layout);
  solid_.owner = Field<int>("flow::owner", layout);
  marks_ = Field<std::uint8_t>("flow::cell_marks", layout);
}

void ImmersedBoundary::build(Bodies& bodies, const Field<Real>& samples, Real viscous_area) {
  solid_.samples = samples;
  sample_fixed(bodies);
  regions_.clear();
  near_.count = 0;
  bool any_dynamic = false;
  for (int b = 0; b < bodies.count(); ++b) any_dynamic = any_dynamic || bodies[b].dynamic;
  if (any_dynamic) {
    if (!fixed_sdf_.is_allocated()) {
      fixed_sdf_ = Field<Real>("flow::fixed_sdf", solid_.sdf.layout());
      fixed_owner_ = Field<int>("flow::fixed_owner", solid_.sdf.layout());
      fixed_open_ = FaceVector<OpenFraction>("flow::fixed_open", solid_.sdf.layout());
    }
    Kokkos::deep_copy(fixed_sdf_.array(), solid_.sdf.array());
    Kokkos::deep_copy(fixed_owner_.array(), solid_.owner.array());
    for (int a = 0; a < 3; ++a) Kokkos::deep_copy(fixed_open_[a].array(), open_[a].array());
  }
  update(bodies, Field<Real>(), viscous_area);
  changed_ = {Box{{0, 0, 0}, grid_.cells}};
}

void ImmersedBoundary::sample_fixed(Bodies& bodies) {
  solid_.geometry = bodies.geometry();
  if (solid_.samples.is_allocated()) {
    Kokkos::deep_copy(solid_.sdf.array(), solid_.samples.array());
    solid_.owner.fill(sampled_solid);
  } else {
    solid_.sdf.fill(far_away);
    solid_.owner.fill(no_owner);
  }
  for (int b = 0; b < bodies.count(); ++b) {
    if (bodies[b].dynamic) continue;
    RegionList region(grid_.cells);
    const Box box = bodies.region(b, region_margin);
    if (box.size() > 0) region.assign({box}, {b});
    sample_body(solid_, region);
  }
  fill_mirrored_ghosts(solid_.sdf, sides_);
  fill_mirrored_ghosts(solid_.owner, sides_);
  open_all_faces(solid_, open_, marks_);
  fill_open_ghosts(open_, solid_.sdf, sides_);
  rows_ = open_row_ranges(open_, grid_.cells);
  RegionList whole(grid_.cells);
  whole.assign({Box{{0, 0, 0}, grid_.cells}}, {no_owner});
  const Array<Index> scratch("flow::whole_grid_scratch", static_cast<std::size_t>(whole.number_of_cells()));
  NearCells near;
  find_near_cells(marks_, sides_, whole, scratch, near);
  for (int c = 0; c < 3; ++c) {
    build_wall_rows(c, solid_, open_, sides_, near, scratch, fixed_rows_[c]);
    refresh_wall_velocity(c, solid_, fixed_rows_[c]);
  }
}

void ImmersedBoundary::update(Bodies& bodies, const Field<Real>& pressure, Real viscous_area) {
  viscous_area_ = viscous_area;
  changed_ = regions_.boxes_inside();
  if (pressure.is_allocated()) extrapolate_pressure(open_, sides_, near_, pressure);
  restore_fixed(solid_, {fixed_sdf_, fixed_owner_, fixed_open_}, open_, marks_, regions_);
  std::vector<Box> boxes;
  std::vector<int> owners;
  for (int b = 0; b < bodies.count(); ++b) {
    if (!bodies[b].dynamic) continue;
    const Box box = bodies.region(b, region_margin);
    if (box.size() == 0) continue;
    boxes.push_back(box);
    owners.push_back(b);
  }
  regions_.assign(boxes, owners);
  const auto now = regions_.boxes_inside();
  changed_.insert(changed_.end(), now.begin(), now.end());
  solid_.geometry = bodies.geometry();
  if (!changed_.empty()) sample_moving(regions_);
  refresh_velocity(bodies);
}

void ImmersedBoundary::sample_moving(const RegionList& regions) {
  const auto total = static_cast<std::size_t>(regions.number_of_cells());
  if (scratch_.extent(0) < total) scratch_ = Array<Index>("flow::region_scratch", total + total / 4);
  sample_region_cells(solid_, fixed_sdf_, fixed_owner_, regions);
  fill_mirrored_ghosts(solid_.sdf, sides_, 1);
  fill_mirrored_ghosts(solid_.owner, sides_, 1);
  open_region_faces(solid_, open_, viscous_area_, marks_, regions);
  fill_open_ghosts(open_, solid_.sdf, sides_);
  find_near_cells(marks_, sides_, regions, scratch_, near_);
  for (int c = 0; c < 3; ++c) {
    mark_superseded(marks_, fixed_rows_[c]);
    build_wall_rows(c, solid_, open_, sides_, near_, scratch_, moving_rows_[c]);
    std::swap(former_slits_[c], slits_[c]);
    build_slits(c, solid_, open_, viscous_area_, near_, scratch_, slits_[c]);
    build_body_faces(c, solid_, open_, sides_, near_, scratch_, body_faces_[c]);
  }
  build_cut_cells(open_, near_, scratch_, cut_cells_);
}

std::size_t ImmersedBoundary::bytes() const {
  const Index cells = Layout(grid_.cells).size;
  Index total = cells * static_cast<Index>(3 * sizeof(OpenFraction) + sizeof(Real) + sizeof(int) + 1);
  if (fixed_sdf_.is_allocated())
    total += cells * static_cast<Index>(3 * sizeof(OpenFraction) + sizeof(Real) + sizeof(int));
  for (int c = 0; c < 3; ++c) total += fixed_rows_[c].bytes() + moving_rows_[c].bytes() + slits_[c].bytes();
  return static_cast<std::size_t>(total);
}

void ImmersedBoundary::refresh_velocity(Bodies& bodies) {
  solid_.geometry = bodies.geometry();
  for (int c = 0; c < 3; ++c) {
    refresh_wall_velocity(c, solid_, moving_rows_[c]);
    refresh_slits(c, solid_, slits_[c]);
    refresh_body_faces(c, solid_, body_faces_[c]);
  }
  refresh_cut_cells(solid_, open_, sides_, cut_cells_);
}

}  // namespace peclet::flow
