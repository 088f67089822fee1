#include "flow/domain_sides.hpp"

#include <vector>

#include "core/error.hpp"

namespace peclet::flow {
namespace {

/// Faces of one side: index 0 along the axis.
Box side_faces(const Int3& cells, int axis) {
  Box faces{{0, 0, 0}, cells};
  faces.high[axis] = 1;
  return faces;
}

KOKKOS_INLINE_FUNCTION int other_axis(int axis, int which) {
  const int s = axis == 0 ? 1 : 0, t = axis == 2 ? 1 : 2;
  return which == 0 ? s : t;
}

/// One velocity component beyond both sides of one axis.
struct SideGhosts {
  Field<Real> q;
  int c, axis, width;
  bool is_correction;  // homogeneous: prescribed values are 0
  DomainSide side[2];
  Field<Real> normal;  // velocity along axis; only read to stop backflow
  bool stops_backflow;

  /// Prescribed component c at the place of a tangential or normal point.
  KOKKOS_INLINE_FUNCTION Real prescribed(const DomainSide& at, const int (&cell)[3]) const {
    if (is_correction) return 0;
    const int s_axis = other_axis(axis, 0), t_axis = other_axis(axis, 1);
    const int s = cell[s_axis], t = cell[t_axis];
    const Real here = at.velocity_at(c, s, t);
    if (c == axis) return here;
    return 0.5 * (here + at.velocity_at(c, s - (c == s_axis), t - (c == t_axis)));
  }

  /// Points lie on the side: first is the one there.
  KOKKOS_INLINE_FUNCTION void fill_normal(const DomainSide& at, int high, const int (&cell)[3], Index first,
                                          Index inward) const {
    if (at.kind == SideKind::Outflow) {
      const Real edge = q[first];
      const bool flows_back = stops_backflow && (high ? edge < 0 : edge > 0);
      const int layers = high ? 1 : width;  // beyond the unknown point on the side
      for (int d = 1; d <= layers; ++d) q[first - d * inward] = flows_back ? -edge : edge;
      return;
    }
    const Real edge = at.prescribes_velocity() ? prescribed(at, cell) : 0.0;
    q[first] = edge;
    for (int d = 1; d <= width - high; ++d) q[first - d * inward] = 2 * edge - q[first + d * inward];
  }

  /// Points lie half a cell inside: first is the nearest.
  KOKKOS_INLINE_FUNCTION void fill_tangential(const DomainSide& at, int high, const int (&cell)[3],
                                              Index first, Index inward) const {
    const Index ghost = first - inward, second = ghost - inward;
    const Real inner = q[first];
    Real near = inner, far = inner;
    if (at.prescribes_velocity()) {
      const Real wall = prescribed(at, cell);
      const Real next = q.layout().cells[axis] > 1 ? q[first + inward] : 2 * inner - wall;
      near = (8 * wall - 6 * inner + next) / 3;
      far = 3 * near - 2 * wall;  // upwind extrapolation to the side then gives the prescribed value
    } else if (at.kind == SideKind::Slip) {
      far = q.layout().cells[axis] > 1 ? q[first + inward] : inner;
    } else if (stops_backflow) {
      const Real out = normal[high ? ghost : first];
      if (high ? out < 0 : out > 0) near = far = 0;
    }
    q[ghost] = near;
    if (width > 1) q[second] = far;
  }

  KOKKOS_INLINE_FUNCTION void operator()(int i, int j, int k) const {
    const Layout& layout = q.layout();
    const int n = layout.cells[axis];
    const Index step = layout.stride(axis), low = layout(i, j, k);
    const int cell[3] = {i, j, k};
    if (c == axis) {
      fill_normal(side[0], 0, cell, low, step);
      fill_normal(side[1], 1, cell, low + n * step, -step);
    } else {
      fill_tangential(side[0], 0, cell, low, step);
      fill_tangential(side[1], 1, cell, low + (n - 1) * step, -step);
    }
  }
};

void fill_component_ghosts(const Field<Real>& field, int c, const DomainSides& sides, bool is_correction,
                           const Field<Real>* velocity, bool stops_backflow, int width,
                           const GhostAxes& counting) {
  for (int axis = 0; axis < 3; ++axis) {
    Box layers = ghost_layers(field.layout().cells, axis, width);
    // unknown points on the high side along c have neighbours beyond the other sides
    if (axis < c && sides.side[c][1].kind == SideKind::Outflow) ++layers.high[c];
    if (sides.is_periodic(axis)) {
      if (counting.axis[axis]) fill_periodic_layers(field, axis, layers);
      continue;
    }
    layers.high[axis] = 1;
    SideGhosts ghosts{
        field, c, axis, width, is_correction, {sides.side[axis][0], sides.side[axis][1]}, {}, stops_backflow};
    if (velocity) ghosts.normal = velocity[axis];
    for_each_cell("flow::fill_side_ghosts", layers, KOKKOS_LAMBDA(int i, int j, int k) { ghosts(i, j, k); });
  }
}

/// The faces of one side and the cells behind them.
struct SideFaces {
  DomainSide side;
  Field<Real> sdf;
  int axis, high;

  KOKKOS_INLINE_FUNCTION Index cell(int i, int j, int k) const {
    return sdf.layout()(i, j, k) + (high ? (sdf.layout().cells[axis] - 1) * sdf.layout().stride(axis) : 0);
  }
  /// Prescribed velocity along axis; 0 where the cell behind is solid.
  KOKKOS_INLINE_FUNCTION Real normal_velocity(int i, int j, int k) const {
    const int at[3] = {i, j, k};
    return sdf[cell(i, j, k)] < 0 ? 0.0
                                  : side.velocity_at(axis, at[other_axis(axis, 0)], at[other_axis(axis, 1)]);
  }
};

std::vector<SideFaces> inflow_faces(const DomainSides& sides, const Field<Real>& sdf) {
  std::vector<SideFaces> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high)
      if (sides.side[axis][high].kind == SideKind::Inflow)
        faces.push_back({sides.side[axis][high], sdf, axis, high});
  return faces;
}

}  // namespace

bool DomainSides::any(SideKind kind) const {
  for (const auto& pair : side)
    for (const DomainSide& one : pair)
      if (one.kind == kind) return true;
  return false;
}

void DomainSides::require_pairs() const {
  constexpr char names[] = "xyz";
  for (int axis = 0; axis < 3; ++axis)
    require_state((side[axis][0].kind == SideKind::Periodic) == (side[axis][1].kind == SideKind::Periodic),
                  std::string("domain sides: expected both or neither of -") + names[axis] + " and +" +
                      names[axis] + " periodic, found one");
}

Periodicity DomainSides::periodicity() const {
  Periodicity periodic;
  for (int axis = 0; axis < 3; ++axis) periodic.axis[axis] = is_periodic(axis);
  return periodic;
}

PressureSides DomainSides::pressure_sides() const {
  PressureSides result;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      const SideKind kind = side[axis][high].kind;
      result.side[axis][high] = kind == SideKind::Periodic  ? PressureSide::Periodic
                                : kind == SideKind::Outflow ? PressureSide::Fixed
                                                            : PressureSide::Closed;
    }
  return result;
}

bool DomainSides::same_kinds(const DomainSides& other) const {
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high)
      if (side[axis][high].kind != other.side[axis][high].kind) return false;
  return true;
}

RowRanges velocity_rows(const RowRanges& cells, const DomainSides& sides, const Int3& n, int c) {
  if (sides.side[c][1].kind != SideKind::Outflow || cells.box.high[c] != n[c]) return cells;
  RowRanges rows(cells.box);
  ++rows.box.high[c];
  if (!cells.first.data()) return rows;
  const auto count = static_cast<std::size_t>(rows.number_of_rows());
  rows.first = Array<int>("flow::velocity_rows.first", count);
  rows.last = Array<int>("flow::velocity_rows.last", count);
  const Box from = cells.box, to = rows.box;
  const RowRanges source = cells, target = rows;
  for_each(
      "flow::velocity_rows", rows.number_of_rows(), KOKKOS_LAMBDA(Index row) {
        const Index ny = to.extent(1);
        Index j = row % ny, k = row / ny;
        if (c == 1 && j == from.extent(1)) --j;
        if (c == 2 && k == from.extent(2)) --k;
        const Index old = j + k * from.extent(1);
        const int last = source.last(old);
        target.first(row) = source.first(old);
        target.last(row) = c == 0 && last == n[0] ? last + 1 : last;
      });
  return rows;
}

template <class T>
void fill_mirrored_ghosts(const Field<T>& field, const DomainSides& sides, int width) {
  for (int axis = 0; axis < 3; ++axis) {
    const Box layers = ghost_layers(field.layout().cells, axis, width);
    if (sides.is_periodic(axis))
      fill_periodic_layers(field, axis, layers);
    else
      fill_reflected_layers(field, axis, layers, T(1), T(1));
  }
}

template void fill_mirrored_ghosts(const Field<Real>&, const DomainSides&, int);
template void fill_mirrored_ghosts(const Field<int>&, const DomainSides&, int);

void fill_velocity_ghosts(const FaceVector<Real>& velocity, int c, const DomainSides& sides, int width,
                          bool stops_backflow, const GhostAxes& counting) {
  const Field<Real> components[3] = {velocity.x, velocity.y, velocity.z};
  fill_component_ghosts(velocity[c], c, sides, false, components, stops_backflow, width, counting);
}

void fill_outflow_points(const FaceVector<Real>& velocity, const DomainSides& sides) {
  for (int axis = 0; axis < 3; ++axis) {
    if (sides.side[axis][1].kind != SideKind::Outflow) continue;
    const Field<Real> u = velocity[axis];
    const Index across = (u.layout().cells[axis] - 1) * u.layout().stride(axis);
    const Index step = u.layout().stride(axis);
    for_each_cell(
        "flow::fill_outflow_points", side_faces(u.layout().cells, axis), KOKKOS_LAMBDA(int i, int j, int k) {
          const Index last = u.layout()(i, j, k) + across;
          u[last + step] = u[last];
        });
  }
}

void fill_correction_ghosts(const Field<Real>& correction, int c, const DomainSides& sides, int width,
                            const GhostAxes& counting) {
  fill_component_ghosts(correction, c, sides, true, nullptr, false, width, counting);
}

void fill_open_ghosts(const FaceVector<OpenFraction>& open, const Field<Real>& sdf,
                      const DomainSides& sides) {
  const Int3 cells = sdf.layout().cells;
  for (int c = 0; c < 3; ++c) {
    const Field<OpenFraction> fraction = open[c];
    for (int axis = 0; axis < 3; ++axis) {
      const Box layers = ghost_layers(cells, axis, Layout::ghost_width);
      if (sides.is_periodic(axis)) {
        fill_periodic_layers(fraction, axis, layers);
        continue;
      }
      if (axis != c) {
        fill_reflected_layers(fraction, axis, layers, OpenFraction(1), OpenFraction(1));
        continue;
      }
      const bool low_open = sides.side[axis][0].kind == SideKind::Outflow;
      const bool high_open = sides.side[axis][1].kind == SideKind::Outflow;
      const int n = cells[axis];
      const Index step = sdf.layout().stride(axis);
      Box faces = layers;
      faces.high[axis] = 1;
      for_each_cell(
          "flow::fill_open_ghosts", faces, KOKKOS_LAMBDA(int i, int j, int k) {
            const Index low = sdf.layout()(i, j, k), high = low + n * step;
            fraction[low] = low_open && sdf[low] >= 0 ? fully_open : OpenFraction(0);
            fraction[high] = high_open && sdf[high - step] >= 0 ? fully_open : OpenFraction(0);
            for (int d = 1; d <= Layout::ghost_width; ++d) {
              fraction[low - d * step] = fraction[low + d * step];
              if (d < Layout::ghost_width) fraction[high + d * step] = fraction[high - d * step];
            }
          });
    }
  }
}

Real add_side_flux(const Grid& grid, const DomainSides& sides, const Field<Real>& sdf,
                   const Field<Real>& divergence) {
  const Field<Real> result = divergence;
  Real largest = 0;
  for (const SideFaces& inflow : inflow_faces(sides, sdf)) {
    const SideFaces faces = inflow;
    const Real scale = (faces.high ? 1 : -1) / grid.spacing[faces.axis];
    const Real at_side = max_cells(
        "flow::add_side_flux", RowRanges(side_faces(grid.cells, faces.axis)),
        KOKKOS_LAMBDA(int i, int j, int k) {
          const Index cell = faces.cell(i, j, k);
          if (faces.sdf[cell] < 0) return 0.0;
          result[cell] += scale * faces.normal_velocity(i, j, k);
          return Kokkos::abs(result[cell]);
        });
    largest = at_side > largest ? at_side : largest;
  }
  return largest;
}

Real net_inflow(const Grid& grid, const DomainSides& sides, const Field<Real>& sdf) {
  Real total = 0;
  for (const SideFaces& inflow : inflow_faces(sides, sdf)) {
    const SideFaces faces = inflow;
    const Real area = (faces.high ? -1 : 1) * grid.cell_volume() / grid.spacing[faces.axis];
    total += area * sum_cells(
                        "flow::net_inflow", RowRanges(side_faces(grid.cells, faces.axis)),
                        KOKKOS_LAMBDA(int i, int j, int k) { return faces.normal_velocity(i, j, k); });
  }
  return total;
}

}  // namespace peclet::flow
