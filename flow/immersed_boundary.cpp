#include "flow/immersed_boundary.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "flow/open_rows.hpp"

namespace peclet::flow {
namespace {

/// Cells around a body in which it can change a distance, a face, or a stencil.
constexpr int region_margin = 3;
/// The same as a distance in spacings: stencils see corners of faces 1.5 cells away along two axes and half
/// a cell along the third, which makes 2.2; narrow gaps reach 2.
constexpr Real band_width = 2.5;

/// Cells around a body in which it can change a face: one that it touches, or one beside a narrow gap.
int surface_margin(const Grid& grid) {
  const Real3& h = grid.spacing;
  const Real ratio = std::max({h[0], h[1], h[2]}) / grid.smallest_spacing();
  return ratio < region_margin ? static_cast<int>(std::ceil(ratio)) : region_margin;
}

void sample_body(const SolidSampler& solid, const RegionList& regions) {
  const RegionView region = regions.view();
  const SolidSampler target = solid;
  for_each(
      "flow::sample_body", regions.number_of_cells(), KOKKOS_LAMBDA(Index n) {
        const RegionCell cell = region.at(n);
        const int body = region.body(cell.region);
        const Real d = target.geometry.distance(body, target.grid.cell_center(cell.i, cell.j, cell.k));
        if (d < target.sdf(cell.i, cell.j, cell.k)) {
          target.sdf(cell.i, cell.j, cell.k) = d;
          target.owner(cell.i, cell.j, cell.k) = body;
        }
      });
}

/// The two nearest of the moving bodies whose boxes hold a cell.
struct NearestBodies {
  Real distance = far_away, second = far_away;
  int body = no_owner;
};

KOKKOS_INLINE_FUNCTION NearestBodies nearest_bodies(const SolidSampler& solid, const RegionView& region,
                                                    const RegionCell& cell) {
  const Vec3 x = solid.grid.cell_center(cell.i, cell.j, cell.k);
  NearestBodies nearest;
  for (int m = region.first_neighbor(cell.region); m < region.first_neighbor(cell.region + 1); ++m) {
    const int other = region.neighbors(m);
    if (other != cell.region && !region.contains(other, cell.i, cell.j, cell.k)) continue;
    const Real d = solid.geometry.distance(region.body(other), x);
    if (d < nearest.distance)
      nearest = {d, nearest.distance, region.body(other)};
    else if (d < nearest.second)
      nearest.second = d;
  }
  return nearest;
}

/// What the fixed solid alone leaves.
struct FixedGeometry {
  Field<Real> sdf;
  Field<int> owner;
  FaceVector<OpenFraction> open;
  bool is_empty;  // no fixed solid
};

/// Lists the cells inside moving bodies and in the band around them, marks them, and samples distance and
/// owner there: fixed solid or moving body. Around a narrow gap, less than a spacing wide, the distances of a
/// cell to both sides add up to two spacings at most.
void sample_band(const SolidSampler& solid, const FixedGeometry& fixed, const RegionList& regions,
                 int band_mark, CellList& band) {
  const RegionView region = regions.view();
  const SolidSampler target = solid;
  const FixedGeometry source = fixed;
  const Real3& h = solid.grid.spacing;
  const Real width = band_width * std::max({h[0], h[1], h[2]});
  band.count = list_selected(
      "flow::sample_band", regions.number_of_cells(), region, band.listed,
      KOKKOS_LAMBDA(const RegionCell& cell, Int3& listed) {
        if (!cell.unique) return false;
        const NearestBodies moving = nearest_bodies(target, region, cell);
        if (moving.distance > width) return false;
        const Index p = target.sdf.layout()(cell.i, cell.j, cell.k);
        const Real wall = source.is_empty ? far_away : source.sdf[p];
        const bool is_nearest = moving.distance < wall;
        target.sdf[p] = is_nearest ? moving.distance : wall;
        target.owner[p] = is_nearest ? moving.body : source.owner[p];
        const bool is_between = moving.distance + Kokkos::min(moving.second, wall) <= width;
        target.marks[p] = (target.marks[p] & cell_mark::touched_by_fixed) | band_mark |
                          (is_between ? cell_mark::between_bodies : 0);
        listed = Int3{cell.i, cell.j, cell.k};
        return true;
      });
}

void mark_superseded(const Field<int>& marks, int band_mark, const WallRows& rows) {
  const WallRows target = rows;
  const Field<int> mark = marks;
  for_each(
      "flow::mark_superseded", rows.count,
      KOKKOS_LAMBDA(Index n) { target.superseded(n) = (mark[target.face(n)] & band_mark) != 0; });
}

/// Pressure of closed cells beside open ones := mean of p_q + f . (x - x_q) over the open neighbours, where f
/// is the gradient at hydrostatic equilibrium.
void extrapolate_pressure(const Grid& grid, const FaceVector<OpenFraction>& open, const DomainSides& sides,
                          const CellList& near, const Real3& hydrostatic_force, const Field<Real>& pressure) {
  const Real3 fall{hydrostatic_force[0] * grid.spacing[0], hydrostatic_force[1] * grid.spacing[1],
                   hydrostatic_force[2] * grid.spacing[2]};
  const CellList candidates = near;
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
          if (!candidates.has(m, cell_part::closed, a) && !box.is_side(a, at[a], cells)) return;
        if (is_open_cell(fraction, n)) return;
        Real sum = 0;
        int count = 0;
        for (int d = 0; d < 6; ++d) {
          const int a = d / 2;
          int q[3] = {at[0], at[1], at[2]};
          q[a] += d % 2 ? 1 : -1;
          if (!box.is_periodic(a) && (q[a] < 0 || q[a] == cells[a])) continue;
          q[a] = q[a] < 0 ? q[a] + cells[a] : (q[a] >= cells[a] ? q[a] - cells[a] : q[a]);
          const Index neighbor = layout(q[0], q[1], q[2]);
          if (!is_open_cell(fraction, neighbor)) continue;
          sum += p[neighbor] + (d % 2 ? -fall[a] : fall[a]);
          ++count;
        }
        if (count > 0) p[n] = sum / count;
      });
}

/// Points of component c that are fluid in fixed and not in open, less those the other way round.
Real count_covered_points(int c, const Field<OpenFraction>& open, const Field<OpenFraction>& fixed,
                          const DomainSides& sides, const CellList& near) {
  const Field<OpenFraction> now = open, before = fixed;
  const CellList candidates = near;
  const Layout layout = open.layout();
  const bool is_outflow_low = sides.side[c][0].kind == SideKind::Outflow;
  const bool is_outflow_high = sides.side[c][1].kind == SideKind::Outflow;
  return sum_each(
      "flow::count_covered_points", near.count, KOKKOS_LAMBDA(Index n) {
        int covered = candidates.has(n, cell_part::closed | cell_part::slit, c) -
                      candidates.has(n, cell_part::fixed_wall, c);
        if (!is_outflow_low && !is_outflow_high) return static_cast<Real>(covered);
        const Int3 cell = candidates.cell(n);
        const Index p = layout(cell[0], cell[1], cell[2]), next = p + layout.stride(c);
        if (is_outflow_low && cell[c] == 0) covered += is_fluid(before[p]) - is_fluid(now[p]);
        if (is_outflow_high && cell[c] + 1 == layout.cells[c])
          covered += is_fluid(before[next]) - is_fluid(now[next]);
        return static_cast<Real>(covered);
      });
}

/// The cells that have left the band as the fixed solid alone left them.
void restore_fixed(const SolidSampler& solid, const FixedGeometry& fixed,
                   const FaceVector<OpenFraction>& open, int band_mark, const CellList& former_band) {
  const CellList cells = former_band;
  const SolidSampler target = solid;
  const FixedGeometry source = fixed;
  const FaceVector<OpenFraction> fraction = open;
  const Field<int> mark = solid.marks;
  for_each(
      "flow::restore_fixed", former_band.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = cells.cell(n);
        const Index p = target.sdf.layout()(cell[0], cell[1], cell[2]);
        if (mark[p] & band_mark) return;
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
  solid_.marks = Field<int>("flow::cell_marks", layout);
  revise();
}

void ImmersedBoundary::revise() {
  static std::atomic<Index> number{0};
  revision_ = ++number;
}

void ImmersedBoundary::build(Bodies& bodies, const Field<Real>& samples, const WallFriction& friction) {
  solid_.samples = samples;
  friction_ = friction;
  sample_fixed(bodies);
  forget_moving();
  if (bodies.any_dynamic()) {
    if (!fixed_sdf_.is_allocated()) {
      fixed_sdf_ = Field<Real>("flow::fixed_sdf", solid_.sdf.layout());
      fixed_owner_ = Field<int>("flow::fixed_owner", solid_.sdf.layout());
      fixed_open_ = FaceVector<OpenFraction>("flow::fixed_open", solid_.sdf.layout());
    }
    Kokkos::deep_copy(fixed_sdf_.array(), solid_.sdf.array());
    Kokkos::deep_copy(fixed_owner_.array(), solid_.owner.array());
    for (int a = 0; a < 3; ++a) Kokkos::deep_copy(fixed_open_[a].array(), open_[a].array());
  }
  update(bodies, Field<Real>(), friction);
  changed_ = {Box{{0, 0, 0}, grid_.cells}};
}

void ImmersedBoundary::forget_moving() {
  regions_.clear();
  surfaces_.clear();
  band_.count = former_band_.count = near_.count = 0;
  for (int c = 0; c < 3; ++c) {
    moving_rows_[c] = WallRows();
    slits_[c] = former_slits_[c] = Slits();
    body_faces_[c] = BodyFaces();
    moving_contacts_[c] = ContactCells();
  }
  cut_cells_ = CutCells();
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
  fixed_is_empty_ = !solid_.samples.is_allocated();
  for (int b = 0; b < bodies.count(); ++b) {
    if (bodies[b].dynamic) continue;
    fixed_is_empty_ = false;
    RegionList region(grid_.cells);
    const Box box = bodies.region(b, region_margin);
    if (box.size() > 0) region.assign({box}, {b});
    sample_body(solid_, region);
  }
  fill_mirrored_ghosts(solid_.sdf, sides_);
  fill_mirrored_ghosts(solid_.owner, sides_);
  open_fixed_faces(FaceOpener(solid_, 0), open_, solid_.marks);
  fill_open_ghosts(open_, solid_.sdf, sides_);
  rows_ = open_row_ranges(open_, grid_.cells);
  ghost_axes_ = GhostAxes(grid_.cells, box_of_open_cells(open_, rows_));
  const CellList whole = CellList::of_grid(grid_.cells);
  CellList near;
  near.listed = Array<Int3>("flow::fixed_cells", static_cast<std::size_t>(whole.count));
  find_near_cells(solid_.marks, sides_, whole, near);
  sort_near_cells(open_, open_, solid_.sdf, solid_.marks, sides_, near);
  const Array<Index> scratch("flow::fixed_scratch", static_cast<std::size_t>(near.count));
  for (int c = 0; c < 3; ++c) {
    build_wall_rows(c, solid_, open_, sides_, near, scratch, fixed_rows_[c]);
    build_contact_cells(c, solid_, open_, sides_, near, scratch, fixed_contacts_[c]);
    refresh_wall_motion(c, solid_, friction_.viscosity, fixed_rows_[c]);
  }
}

void ImmersedBoundary::update(Bodies& bodies, const Field<Real>& pressure, const WallFriction& friction,
                              const Real3& hydrostatic_force) {
  revise();
  friction_ = friction;
  if (pressure.is_allocated()) extrapolate_pressure(grid_, open_, sides_, near_, hydrostatic_force, pressure);
  const bool had_regions = !regions_.empty();
  const int margin = surface_margin(grid_);
  std::vector<Box> boxes, surfaces;
  std::vector<int> owners;
  for (int b = 0; b < bodies.count(); ++b) {
    if (!bodies[b].dynamic) continue;
    const Box box = bodies.region(b, region_margin), surface = bodies.region(b, margin);
    if (surface.size() > 0) surfaces.push_back(surface);
    if (box.size() == 0) continue;
    boxes.push_back(box);
    owners.push_back(b);
  }
  regions_.assign(boxes, owners);
  changed_ = cut_inside(joined(surfaces_, surfaces), grid_.cells);
  surfaces_ = surfaces;
  solid_.geometry = bodies.geometry();
  if (had_regions || !regions_.empty()) sample_moving();
  refresh_velocity(bodies);
}

/// Whether ghosts depend on cells of the regions.
bool ImmersedBoundary::reaches_sides() const {
  for (const Box& box : regions_.boxes())
    for (int a = 0; a < 3; ++a)
      if (box.low[a] < Layout::ghost_width || box.high[a] > grid_.cells[a] - Layout::ghost_width) return true;
  return false;
}

void ImmersedBoundary::sample_moving() {
  const bool reaches = reaches_sides(), has_ghosts = reaches || reached_sides_;
  reached_sides_ = reaches;
  const FixedGeometry fixed{fixed_sdf_, fixed_owner_, fixed_open_, fixed_is_empty_};
  std::swap(band_, former_band_);
  band_.reserve(regions_.number_of_cells());
  band_mark_ ^= cell_mark::in_band;
  sample_band(solid_, fixed, regions_, band_mark_, band_);
  restore_fixed(solid_, fixed, open_, band_mark_, former_band_);
  if (has_ghosts) {
    fill_mirrored_ghosts(solid_.sdf, sides_, 1);
    fill_mirrored_ghosts(solid_.owner, sides_);  // narrow gaps look two cells far
  }
  open_moving_faces(FaceOpener(solid_, friction_.area()), band_, open_, solid_.marks);
  if (has_ghosts) fill_open_ghosts(open_, solid_.sdf, sides_);
  find_near_cells(solid_.marks, sides_, band_, near_);
  sort_near_cells(open_, fixed_open_, solid_.sdf, solid_.marks, sides_, near_);
  number_near_cells(near_, solid_.marks);
  const auto total = static_cast<std::size_t>(near_.count);
  if (scratch_.extent(0) < total) scratch_ = Array<Index>("flow::near_scratch", total + total / 4);
  for (int c = 0; c < 3; ++c) {
    mark_superseded(solid_.marks, band_mark_, fixed_rows_[c]);
    build_wall_rows(c, solid_, open_, sides_, near_, scratch_, moving_rows_[c]);
    std::swap(former_slits_[c], slits_[c]);
    build_slits(c, solid_, open_, friction_.area(), near_, scratch_, slits_[c]);
    build_body_faces(c, solid_, near_, scratch_, body_faces_[c]);
    build_contact_cells(c, solid_, open_, sides_, near_, scratch_, moving_contacts_[c]);
  }
  build_cut_cells(open_.x.layout(), near_, scratch_, cut_cells_);
}

Real ImmersedBoundary::covered_points(int c) const {
  return near_.count == 0 ? 0 : count_covered_points(c, open_[c], fixed_open_[c], sides_, near_);
}

std::size_t ImmersedBoundary::bytes() const {
  const Index cells = Layout(grid_.cells).size;
  Index total = cells * static_cast<Index>(3 * sizeof(OpenFraction) + sizeof(Real) + 2 * sizeof(int));
  if (fixed_sdf_.is_allocated())
    total += cells * static_cast<Index>(3 * sizeof(OpenFraction) + sizeof(Real) + sizeof(int));
  for (int c = 0; c < 3; ++c)
    total += fixed_rows_[c].bytes() + moving_rows_[c].bytes() + slits_[c].bytes() +
             fixed_contacts_[c].bytes() + moving_contacts_[c].bytes();
  return static_cast<std::size_t>(total);
}

void ImmersedBoundary::refresh_face_velocity(Bodies& bodies) {
  solid_.geometry = bodies.geometry();
  for (int c = 0; c < 3; ++c) {
    refresh_slits(c, solid_, slits_[c]);
    refresh_body_faces(c, solid_, body_faces_[c]);
  }
}

void ImmersedBoundary::refresh_velocity(Bodies& bodies) {
  refresh_face_velocity(bodies);
  refresh_cut_cells(solid_, open_, sides_, near_, solid_.marks, cut_cells_);
}

void ImmersedBoundary::refresh_friction(Bodies& bodies) {
  revise();
  solid_.geometry = bodies.geometry();
  for (int c = 0; c < 3; ++c) refresh_wall_motion(c, solid_, friction_.viscosity, moving_rows_[c]);
}

}  // namespace peclet::flow
