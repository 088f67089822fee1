#include "flow/moving_walls.hpp"

#include "flow/wall_rows.hpp"

namespace peclet::flow {

void BodyFaces::reserve(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  if (face.extent(0) >= n) return;
  face = Array<Index>("flow::body_faces.face", n + n / 4);
  owner = Array<int>("flow::body_faces.owner", n + n / 4);
  velocity = Array<Real>("flow::body_faces.velocity", n + n / 4);
}

void CutCells::reserve(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  if (cell.extent(0) >= n) return;
  cell = Array<Index>("flow::cut_cells.cell", n + n / 4);
  wall_flux = Array<Real>("flow::cut_cells.wall_flux", n + n / 4);
}

void CutCells::reserve_faces(Index near_cells) {
  const auto n = static_cast<std::size_t>(3 * near_cells);
  if (face.extent(0) >= n) return;
  face = Array<Index>("flow::cut_cells.face", n + n / 4);
  swept = Array<Real>("flow::cut_cells.swept", n + n / 4);
}

namespace {

/// What the wall adds to o u on the low face of cell (i, j, k) along axis, per face area: the integral of the
/// wall velocity over the whole face less o times its value in the middle of the open part.
KOKKOS_INLINE_FUNCTION Real swept_flux(const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                                       int axis, int i, int j, int k) {
  const Index p = open.x.layout()(i, j, k);
  const OpenFraction fraction = open[axis][p];
  if (fraction == fully_open) return 0;
  const Vec3 x = solid.grid.face_center(axis, i, j, k);
  const int body = nearest_owner(solid, axis, p, x);
  const NarrowGap gap = narrow_gap(solid, axis, i, j, k);
  const Real whole = wall_velocity(solid, gap, body, axis, x);
  if (fraction == 0) return whole;
  const Real part = fraction * open_fraction_unit;
  const bool is_uniform = gap.share == 0 && (body < 0 || !solid.geometry.bodies(body).spins());
  if (is_uniform) return whole - part * whole;
  const FaceOpening face = face_opening(solid, axis, i, j, k, body, body);
  const int s = (axis + 1) % 3, t = (axis + 2) % 3;
  const Real lever = face.open > 0 ? -(1 - face.open) / face.open : 0.0;  // of the open part's middle
  Vec3 middle = x;
  middle[s] += lever * face.closed_s * solid.grid.spacing[s];
  middle[t] += lever * face.closed_t * solid.grid.spacing[t];
  return whole - part * wall_velocity(solid, gap, body, axis, middle);
}

}  // namespace

void build_body_faces(int c, const SolidSampler& solid, const CellList& near, const Array<Index>& scratch,
                      BodyFaces& faces) {
  const CellList candidates = near;
  faces.count = list_where(
      "flow::list_body_faces", near.count, scratch,
      KOKKOS_LAMBDA(Index n) { return candidates.has(n, cell_part::closed, c); });
  faces.reserve(faces.count);
  const BodyFaces target = faces;
  const SolidSampler sampler = solid;
  const Layout layout = solid.sdf.layout();
  for_each(
      "flow::build_body_faces", faces.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = candidates.cell(scratch(n));
        const Index p = layout(cell[0], cell[1], cell[2]);
        target.face(n) = p;
        target.owner(n) =
            nearest_owner(sampler, c, p, sampler.grid.face_center(c, cell[0], cell[1], cell[2]));
      });
}

void build_cut_cells(const Layout& layout, const CellList& near, const Array<Index>& scratch,
                     CutCells& cells) {
  const CellList candidates = near;
  cells.reserve_faces(near.count);
  cells.faces = list_where(
      "flow::list_swept_faces", 3 * near.count, cells.face,
      KOKKOS_LAMBDA(Index n) { return candidates.has(n / 3, cell_part::swept, static_cast<int>(n % 3)); });
  cells.count = list_where(
      "flow::list_cut_cells", near.count, scratch,
      KOKKOS_LAMBDA(Index n) { return candidates.has(n, cell_part::cut_cell); });
  cells.reserve(cells.count);
  const CutCells target = cells;
  const Layout cell_layout = layout;
  for_each(
      "flow::build_cut_cells", cells.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = candidates.cell(scratch(n));
        target.cell(n) = cell_layout(cell[0], cell[1], cell[2]);
      });
}

void refresh_body_faces(int c, const SolidSampler& solid, const BodyFaces& faces) {
  const BodyFaces target = faces;
  const SolidSampler sampler = solid;
  const Layout layout = solid.sdf.layout();
  for_each(
      "flow::refresh_body_faces", faces.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = cell_of(layout, target.face(n));
        const Vec3 x = sampler.grid.face_center(c, cell[0], cell[1], cell[2]);
        const NarrowGap gap = narrow_gap(sampler, c, cell[0], cell[1], cell[2]);
        target.velocity(n) = wall_velocity(sampler, gap, target.owner(n), c, x);
      });
}

/// Flux of the closed part of the low face along axis of a cell with this mark; walls beyond the regions
/// rest.
KOKKOS_INLINE_FUNCTION Real swept_by_wall(const CutCells& cells, int mark, int axis) {
  const int n = near_index(mark);
  return n < 0 ? 0.0 : cells.swept(3 * static_cast<Index>(n) + axis);
}

/// Velocity with which a moving body that covers the centre of this cell leaves through a side of the box.
KOKKOS_INLINE_FUNCTION Real swept_through_side(const SolidSampler& solid, int axis, const Int3& cell,
                                               int high) {
  const Index p = solid.sdf.layout()(cell[0], cell[1], cell[2]);
  const int body = solid.owner[p];
  if (solid.sdf[p] >= 0 || body < 0) return 0;
  Vec3 x = solid.grid.cell_center(cell[0], cell[1], cell[2]);
  x[axis] += (high - 0.5) * solid.grid.spacing[axis];
  return solid.geometry.velocity(body, x)[axis];
}

void sweep_faces(const SolidSampler& solid, const FaceVector<OpenFraction>& open, const CellList& near,
                 const CutCells& cells) {
  const CutCells target = cells;
  const CellList candidates = near;
  const SolidSampler sampler = solid;
  const FaceVector<OpenFraction> fraction = open;
  for_each(
      "flow::sweep_faces", cells.faces, KOKKOS_LAMBDA(Index n) {
        const Index face = target.face(n);
        const Int3 cell = candidates.cell(face / 3);
        target.swept(face) =
            swept_flux(sampler, fraction, static_cast<int>(face % 3), cell[0], cell[1], cell[2]);
      });
}

void refresh_cut_cells(const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                       const DomainSides& sides, const CellList& near, const Field<int>& marks,
                       const CutCells& cells) {
  sweep_faces(solid, open, near, cells);
  const CutCells target = cells;
  const DomainSides box = sides;
  const Grid grid = solid.grid;
  const FaceVector<OpenFraction> fraction = open;
  const Field<int> mark = marks;
  const SolidSampler sampler = solid;
  for_each(
      "flow::refresh_cut_cells", cells.count, KOKKOS_LAMBDA(Index n) {
        const Layout& layout = mark.layout();
        const Index p = target.cell(n);
        const Int3 cell = cell_of(layout, p);
        Real flux = 0;
        for (int a = 0; a < 3; ++a) {
          const Index next = p + layout.stride(a);
          const Index owner = cell[a] + 1 < grid.cells[a] ? next : next - grid.cells[a] * layout.stride(a);
          const Real low = box.is_side(a, cell[a], grid.cells) ? swept_through_side(sampler, a, cell, 0)
                           : fraction[a][p] < fully_open       ? swept_by_wall(target, mark[p], a)
                                                               : 0.0;
          const Real high = box.is_side(a, cell[a] + 1, grid.cells) ? swept_through_side(sampler, a, cell, 1)
                            : fraction[a][next] < fully_open        ? swept_by_wall(target, mark[owner], a)
                                                                    : 0.0;
          flux += (high - low) / grid.spacing[a];
        }
        target.wall_flux(n) = flux;
      });
}

void impose_values(Index count, const Array<Index>& faces, const Array<Real>& values,
                   const Field<Real>& velocity) {
  const Array<Index> target = faces;
  const Array<Real> source = values;
  const Field<Real> u = velocity;
  for_each("flow::impose_values", count, KOKKOS_LAMBDA(Index n) { u[target(n)] = source(n); });
}

void impose_body_velocity(const BodyFaces& faces, const Field<Real>& velocity) {
  impose_values(faces.count, faces.face, faces.velocity, velocity);
}

}  // namespace peclet::flow
