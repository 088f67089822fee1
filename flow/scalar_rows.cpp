#include "flow/scalar_rows.hpp"

#include <cmath>

#include "core/halo.hpp"
#include "flow/cell_volume.hpp"
#include "flow/near_cells.hpp"

namespace peclet::flow {
namespace {

/// Fluid parts below this are none.
constexpr Real negligible_part = 1e-6;
/// Smallest distance, in spacings, of a wall of given value from the centre of a cut cell.
constexpr Real smallest_distance_in_cut_cell = 0.5;

/// What lies in one direction from a cell.
struct Neighbor {
  bool is_link = false, is_wall = false;
  bool is_regular = false;  // a wall, or a link between whole cells
  Real opening = 0;         // of the face between
  Real distance = 1;        // in spacings
  Real value = 0;           // of a wall
  int giver = no_owner;
};

struct RowBuilder {
  ScalarGeometry geometry;
  Field<OpenFraction> state;
  Field<float> volume;
  ScalarRows rows;

  KOKKOS_INLINE_FUNCTION bool at_side(int axis, int high, const Int3& cell) const {
    return !geometry.sides.side[axis][high].is_periodic &&
           cell[axis] == (high ? state.layout().cells[axis] - 1 : 0);
  }

  /// Open part of the face in one direction: the same number seen from both sides.
  KOKKOS_INLINE_FUNCTION Real opening(int axis, int high, const Int3& cell, Index p) const {
    int face[3] = {cell[0], cell[1], cell[2]};
    face[axis] += high;
    if (geometry.sides.side[axis][high].is_periodic && face[axis] == state.layout().cells[axis])
      face[axis] = 0;
    const Index step = state.layout().stride(axis);
    const Field<int>& owner = geometry.solid.owner;
    int low_owner = owner[high ? p : p - step], high_owner = owner[high ? p + step : p];
    if (at_side(axis, high, cell)) low_owner = high_owner = owner[p];
    return face_opening(geometry.solid, axis, face[0], face[1], face[2], low_owner, high_owner).open;
  }

  KOKKOS_INLINE_FUNCTION Neighbor neighbor(int axis, int high, const Int3& cell, Index p) const {
    const bool is_cut = state[p] == cell_state::cut;
    Neighbor result;
    if (at_side(axis, high, cell)) {
      result.opening = is_cut ? opening(axis, high, cell, p) : 1;
      result.giver = side_giver(axis, high);
      result.is_wall = geometry.sides.side[axis][high].condition == ScalarCondition::Value;
      result.is_regular = result.is_wall;
      result.value = geometry.sides.value(axis, high, cell);
      result.distance = 0.5;
      return result;
    }
    const Index q = high ? p + state.layout().stride(axis) : p - state.layout().stride(axis);
    if (state[q] != cell_state::solid) {
      result.is_regular = !is_cut && state[q] == cell_state::whole;
      result.opening = result.is_regular ? 1 : opening(axis, high, cell, p);
      result.is_link = result.opening > 0;
      return result;
    }
    const int owner = geometry.solid.owner[q];
    if (!geometry.gives_value(owner)) return result;
    Vec3 x = geometry.solid.grid.cell_center(cell[0], cell[1], cell[2]), y = x;
    y[axis] += (high ? 1 : -1) * geometry.solid.grid.spacing[axis];
    const Real crossing = wall_crossing(geometry.solid, owner, geometry.solid.owner[p], x, y);
    const Real least = is_cut ? smallest_distance_in_cut_cell : smallest_wall_distance;
    result.is_wall = result.is_regular = true;
    result.opening = is_cut ? opening(axis, high, cell, p) : 1;
    result.distance = crossing > least ? crossing : least;
    result.value = geometry.wall(owner).value;
    result.giver = owner;
    return result;
  }

  /// Coefficients along one axis.
  KOKKOS_INLINE_FUNCTION void fill_axis(Index row, int axis, const Neighbor (&n)[2], Index p) const {
    const Real fluid = state[p] == cell_state::cut ? static_cast<Real>(volume[p]) : 1;
    const bool is_regular = state[p] == cell_state::whole && n[0].is_regular && n[1].is_regular;
    const Real total = Kokkos::fmax(n[0].distance + n[1].distance, narrowest_stencil);
    for (int s = 0; s < 2; ++s) {
      const int d = 2 * axis + s;
      Real coefficient = 0;
      if (is_regular)
        coefficient = 2 / (n[s].distance * total);
      else if (n[s].is_wall || n[s].is_link)
        coefficient = n[s].opening / (n[s].distance * fluid);
      rows.coefficient(row, d) = coefficient;
      rows.links.weight(row, d) = static_cast<float>(coefficient);
      rows.links.owner(row, d) = n[s].giver;
      rows.wall_value(row, d) = n[s].value;
    }
  }

  KOKKOS_INLINE_FUNCTION void fill(Index row, const Int3& cell) const {
    const Grid& grid = geometry.solid.grid;
    const Index p = state.layout()(cell[0], cell[1], cell[2]);
    const Real cell_volume = grid.cell_volume();
    int walls = 0;
    Real wall_area = 0, sum = 0;
    for (int a = 0; a < 3; ++a) {
      const Real area = cell_volume / grid.spacing[a];
      const Neighbor n[2] = {neighbor(a, 0, cell, p), neighbor(a, 1, cell, p)};
      fill_axis(row, a, n, p);
      const Real closed = area * (n[0].opening - n[1].opening);
      wall_area += closed * closed;
      for (int s = 0; s < 2; ++s) {
        const bool is_flux_side = rows.is_side(n[s].giver) && !n[s].is_wall;
        const Real given = is_flux_side ? n[s].value * n[s].opening * area : 0;
        rows.given(row, 2 * a + s) = given;
        sum += given;
        if (n[s].is_wall || is_flux_side) walls |= 1 << (2 * a + s);
      }
    }
    Real from_body = 0, fluid = 1;
    if (state[p] == cell_state::cut) {
      from_body = geometry.wall(geometry.solid.owner[p]).value * Kokkos::sqrt(wall_area);
      fluid = volume[p];
    }
    rows.given(row, ScalarRows::body_slot) = from_body;
    rows.source(row) = (sum + from_body) / (fluid * cell_volume);
    rows.links.face(row) = p;
    rows.links.walls(row) = static_cast<std::uint8_t>(walls);
    rows.links.superseded(row) = 0;
  }
};

/// True where the regular stencil does not hold.
KOKKOS_INLINE_FUNCTION bool needs_row(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                                      const Int3& cell) {
  const Layout& layout = state.layout();
  const Index p = layout(cell[0], cell[1], cell[2]);
  if (state[p] != cell_state::whole) return state[p] == cell_state::cut;
  for (int a = 0; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      const Index q = s ? p + layout.stride(a) : p - layout.stride(a);
      const bool at_side = !geometry.sides.side[a][s].is_periodic && cell[a] == (s ? layout.cells[a] - 1 : 0);
      if (at_side || state[q] != cell_state::whole) return true;
    }
  return false;
}

}  // namespace

void ScalarRows::reserve(Index capacity) {
  links.reserve(capacity);
  const std::size_t size = links.face.extent(0);
  if (source.extent(0) >= size) return;
  coefficient = Kokkos::View<Real* [directions], MemorySpace>("flow::scalar_rows.coefficient", size);
  wall_value = Kokkos::View<Real* [directions], MemorySpace>("flow::scalar_rows.wall_value", size);
  given = Kokkos::View<Real * [directions + 1], MemorySpace>("flow::scalar_rows.given", size);
  source = Array<Real>("flow::scalar_rows.source", size);
}

void classify_cells(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                    const Field<float>& volume) {
  const ScalarGeometry g = geometry;
  const Field<OpenFraction> s = state;
  const Field<float> v = volume;
  const Grid grid = geometry.solid.grid;
  const Real reach = 0.5 * std::sqrt(grid.spacing[0] * grid.spacing[0] + grid.spacing[1] * grid.spacing[1] +
                                     grid.spacing[2] * grid.spacing[2]);
  state.fill(cell_state::solid);
  volume.fill(0);
  for_each_cell(
      "flow::classify_cells", RowRanges(grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = s.layout()(i, j, k);
        const Real distance = g.solid.sdf[p];
        const int owner = g.solid.owner[p];
        OpenFraction kind = distance >= 0 ? cell_state::whole : cell_state::solid;
        Real part = distance >= 0 ? 1 : 0;
        if (distance <= reach && distance >= -reach && owner != no_owner && !g.gives_value(owner)) {
          part = fluid_part_of_cell(g.solid, i, j, k, owner);
          const bool counts = part > negligible_part || is_open_cell(g.open, p);
          kind = counts ? cell_state::cut : cell_state::solid;
          part = counts ? Kokkos::fmax(part, static_cast<Real>(smallest_cell_volume)) : 0;
        }
        s[p] = kind;
        v[p] = static_cast<float>(part);
      });
  const Periodicity periodic = geometry.sides.periodicity();
  fill_periodic_ghosts(state, periodic);
  fill_periodic_ghosts(volume, periodic);
}

void build_scalar_rows(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                       const Field<float>& volume, const Array<Index>& scratch, ScalarRows& rows) {
  const ScalarGeometry g = geometry;
  const Field<OpenFraction> s = state;
  const CellList all = CellList::of_grid(state.layout().cells);
  const Index kept = list_where(
      "flow::list_scalar_rows", all.count, scratch,
      KOKKOS_LAMBDA(Index n) { return needs_row(g, s, all.cell(n)); });
  rows.reserve(kept);
  rows.links.count = kept;
  const RowBuilder builder{geometry, state, volume, rows};
  for_each(
      "flow::build_scalar_rows", kept,
      KOKKOS_LAMBDA(Index row) { builder.fill(row, all.cell(scratch(row))); });
  chain_rows(state.layout(), rows.links);
}

void build_extension(const ScalarGeometry& geometry, const Field<OpenFraction>& state,
                     const Array<Index>& scratch, ExtensionCells& cells) {
  const ScalarGeometry g = geometry;
  const Field<OpenFraction> s = state;
  const CellList all = CellList::of_grid(state.layout().cells);
  const Index kept = list_where(
      "flow::list_extension", all.count, scratch, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = all.cell(n);
        const Index p = s.layout()(cell[0], cell[1], cell[2]);
        if (s[p] != cell_state::solid || g.gives_value(g.solid.owner[p])) return false;
        bool beside = false;
        for (int a = 0; a < 3; ++a)
          beside = beside || s[p - s.layout().stride(a)] || s[p + s.layout().stride(a)];
        return beside;
      });
  const auto size = static_cast<std::size_t>(kept);
  if (cells.cell.extent(0) < size) cells.cell = Array<Index>("flow::extension_cells", size + size / 4);
  cells.count = kept;
  const Array<Index> target = cells.cell;
  for_each(
      "flow::build_extension", kept, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = all.cell(scratch(n));
        target(n) = s.layout()(cell[0], cell[1], cell[2]);
      });
}

void extend_into_solid(const ExtensionCells& cells, const Field<OpenFraction>& state,
                       const Field<Real>& value) {
  const Array<Index> list = cells.cell;
  const Field<OpenFraction> s = state;
  const Field<Real> c = value;
  for_each(
      "flow::extend_into_solid", cells.count, KOKKOS_LAMBDA(Index n) {
        const Index p = list(n);
        Real sum = 0;
        int count = 0;
        for (int d = 0; d < 6; ++d) {
          const Index step = s.layout().stride(d / 2);
          const Index q = d % 2 ? p + step : p - step;
          if (s[q] == cell_state::solid) continue;
          sum += c[q];
          ++count;
        }
        c[p] = sum / count;
      });
}

}  // namespace peclet::flow
