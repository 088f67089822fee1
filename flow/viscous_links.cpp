#include "flow/viscous_links.hpp"

#include <algorithm>
#include <cmath>

namespace peclet::flow {
namespace {

/// Exchange of the points beside the sides of the box with zero on the side, in units of the regular one; see
/// GhostRules. From the centres of the cells into which the points merge.
struct SideExchange {
  Real at[3][2] = {};
  bool is_periodic[3] = {};

  SideExchange(const DomainSides& sides, int c, const Merging& merging) {
    for (int axis = 0; axis < 3; ++axis) {
      is_periodic[axis] = sides.is_periodic(axis);
      for (int high = 0; high < 2; ++high) {
        const DomainSide& side = sides.side[axis][high];
        Real exchange = side.prescribes_velocity() ? 8.0 / 3 : 0;
        if (axis == c) exchange = side.kind == SideKind::Outflow ? 0 : 1;
        at[axis][high] = exchange / (1 + exchange * distance_to_coarse_centre(merging, axis));
      }
    }
  }
};

/// Regular exchange along each axis, in units of that along the smallest spacing.
Real3 relative_exchange(const Grid& grid) {
  Real3 along;
  for (int a = 0; a < 3; ++a) along[a] = std::pow(grid.smallest_spacing() / grid.spacing[a], 2);
  return along;
}

/// Links between fluid points by diffusion, and what regular rows have besides. share: of diffusion in the
/// largest exchange, for which fully_open stands.
void fill_regular_rows(const ViscousSystem& system, Real volume, Real share, const Merging& merging,
                       const FaceVector<OpenFraction>& links, const Field<float>& reaction) {
  const Layout layout = system.layout();
  const Field<OpenFraction> open = system.open;
  const FaceVector<OpenFraction> target = links;
  const Field<float> total = reaction;
  const SideExchange exchange(system.sides, system.component, merging);
  const Real3 along = relative_exchange(system.grid);
  const auto link = static_cast<OpenFraction>(share * fully_open);
  const int c = system.component;
  Box cells{{0, 0, 0}, layout.cells};
  for (int a = 0; a < 3; ++a) ++cells.high[a];
  for_each_cell(
      "flow::viscous_links", cells, KOKKOS_LAMBDA(int i, int j, int k) {
        const int at[3] = {i, j, k};
        const Index p = layout(i, j, k);
        const bool in_fluid = is_fluid(open[p]);
        Real sum = volume;
        for (int a = 0; a < 3; ++a) {
          const Index step = layout.stride(a);
          const int n = layout.cells[a];
          const bool at_low = at[a] == 0, at_high = at[a] == n - 1, beyond = at[a] == n;
          const bool closed = !exchange.is_periodic[a] && (at_low || beyond);
          target[a][p] = in_fluid && is_fluid(open[p - step]) && !closed ? link : OpenFraction(0);
          for (int high = 0; high < 2; ++high) {
            // beside a side of the box: tangential points at both ends, normal ones next to the points on it
            const bool is_end = high ? at_high : at[a] == (a == c ? 1 : 0);
            if (!exchange.is_periodic[a] && is_end) sum += share * along[a] * exchange.at[a][high];
          }
        }
        total[p] = in_fluid ? static_cast<float>(sum) : 0.0F;
      });
}

/// Wall rows, scaled: exchange with the walls, from the centres of the coarse cells, and on the low or high
/// sides the mean with the neighbour's.
struct WallLinks {
  WallRows rows;
  Layout layout;
  FaceVector<OpenFraction> links;
  Field<float> reaction;
  Real3 along;
  Real share;
  Merging merging;
  bool is_periodic[3];

  KOKKOS_INLINE_FUNCTION void set_reaction(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const Real factor = row_factor(rows, row);
    Real sum = factor * reaction[p];
    for (int d = 0; d < WallRows::directions; ++d) {
      if (!rows.is_wall(row, d)) continue;
      const Real inverse_distance = factor * rows.weight(row, d);
      const Real further = distance_to_coarse_centre(merging, d / 2);
      sum += share * along[d / 2] * inverse_distance / (1 + inverse_distance * further);
    }
    reaction[p] = static_cast<float>(sum);
  }

  KOKKOS_INLINE_FUNCTION void weaken_links(Index row, int high) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const Int3 cell = cell_of(layout, p);
    const Real factor = row_factor(rows, row);
    for (int a = 0; a < 3; ++a) {
      if (rows.is_wall(row, 2 * a + high)) continue;
      const int n = layout.cells[a];
      const bool wraps = high && cell[a] == n - 1 && is_periodic[a];
      const Index q = p + (high ? (wraps ? 1 - n : 1) : 0) * layout.stride(a);
      const Real missing = 0.5 * share * (1 - factor * rows.weight(row, 2 * a + high));
      const Real left = links[a][q] - fully_open * missing;
      links[a][q] = static_cast<OpenFraction>(left > 0 ? left : 0);
    }
  }
};

void fill_wall_rows(const ViscousSystem& system, const WallRows& rows, Real share, const Merging& merging,
                    const FaceVector<OpenFraction>& links, const Field<float>& reaction) {
  WallLinks walls{rows, system.layout(), links, reaction, relative_exchange(system.grid), share, merging, {}};
  for (int a = 0; a < 3; ++a) walls.is_periodic[a] = system.sides.is_periodic(a);
  for_each("flow::viscous_wall_reaction", rows.count, KOKKOS_LAMBDA(Index row) { walls.set_reaction(row); });
  for (int high = 0; high < 2; ++high)
    for_each(
        "flow::viscous_wall_links", rows.count, KOKKOS_LAMBDA(Index row) { walls.weaken_links(row, high); });
}

/// Half of what advection carries through the faces: the symmetric part of U.
struct UpwindExchange {
  UpwindAdvection<Real> upwind;
  Field<OpenFraction> open;
  SideExchange exchange;
  Real3 unit;  // exchange along each axis that a link of fully_open stands for

  UpwindExchange(const ViscousSystem& system, Real largest)
      : upwind(system.upwind<Real>()),
        open(system.open),
        exchange(system.sides, system.component, Merging()) {
    for (int a = 0; a < 3; ++a) unit[a] = largest / (system.grid.spacing[a] * system.grid.spacing[a]);
  }

  KOKKOS_INLINE_FUNCTION Real across(int axis, Index p) const {
    return 0.5 * Kokkos::abs(upwind.carried(axis, p));
  }
};

/// Adds advection to the links, and to the reaction where what it brings is zero.
void add_upwind_exchange(const ViscousSystem& system, Real largest, const FaceVector<OpenFraction>& links,
                         const Field<float>& reaction) {
  const UpwindExchange exchange(system, largest);
  const Layout layout = system.layout();
  const FaceVector<OpenFraction> target = links;
  const Field<float> total = reaction;
  const Real3 along = relative_exchange(system.grid);
  const int c = system.component;
  for_each_cell(
      "flow::add_upwind_exchange", Box{{0, 0, 0}, layout.cells}, KOKKOS_LAMBDA(int i, int j, int k) {
        const int at[3] = {i, j, k};
        const Index p = layout(i, j, k);
        if (!is_fluid(exchange.open[p])) return;
        Real sum = 0;
        for (int a = 0; a < 3; ++a) {
          const Index step = layout.stride(a);
          const bool closed = !exchange.exchange.is_periodic[a] && at[a] == 0;
          if (is_fluid(exchange.open[p - step]) && !closed) {
            const Real more = fully_open * exchange.across(a, p) / exchange.unit[a];
            const Real link = Real(target[a][p]) + more;
            target[a][p] = static_cast<OpenFraction>(link < fully_open ? link : Real(fully_open));
          }
          for (int high = 0; high < 2; ++high) {
            const Index face = high ? p + step : p;
            const bool at_side =
                !exchange.exchange.is_periodic[a] && a != c && at[a] == (high ? layout.cells[a] - 1 : 0);
            const bool is_zero = at_side ? exchange.exchange.at[a][high] > 0
                                         : !is_fluid(exchange.open[high ? face : p - step]);
            if (is_zero) sum += along[a] * exchange.across(a, face) / exchange.unit[a];
          }
        }
        total[p] += static_cast<float>(sum);
      });
}

}  // namespace

Real largest_exchange(const ViscousSystem& system) {
  if (!system.is_advected()) return system.diffusion;
  /// of advection where a step carries nothing: the preconditioner divides by the exchange
  constexpr Real least = 1e-6;
  const UpwindExchange exchange(system, 1);
  const Layout layout = system.layout();
  const Real carried = max_cells(
      "flow::upwind_exchange", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = layout(i, j, k);
        Real largest = 0;
        for (int a = 0; a < 3; ++a) {
          const Real across = Kokkos::max(exchange.across(a, p), exchange.across(a, p + layout.stride(a)));
          largest = Kokkos::max(largest, across / exchange.unit[a]);
        }
        return largest;
      });
  const Real smallest = system.grid.smallest_spacing();
  return system.diffusion + std::max(carried, least * smallest * smallest);
}

void fill_links(const ViscousSystem& system, Real exchange, const FaceVector<OpenFraction>& links,
                const Field<float>& reaction, const Merging& merging) {
  const Real volume = std::pow(system.grid.smallest_spacing(), 2) / exchange;
  const Real share = system.diffusion / exchange;
  fill_regular_rows(system, volume, share, merging, links, reaction);
  fill_wall_rows(system, system.fixed_rows, share, merging, links, reaction);
  fill_wall_rows(system, system.moving_rows, share, merging, links, reaction);
  if (system.is_advected()) add_upwind_exchange(system, exchange, links, reaction);
  for (int a = 0; a < 3; ++a) fill_periodic_ghosts(links[a], system.sides.periodicity());
}

}  // namespace peclet::flow
