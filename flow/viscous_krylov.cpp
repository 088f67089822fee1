#include "flow/viscous_krylov.hpp"

#include <algorithm>
#include <cmath>

#include "flow/viscous_krylov_stages.hpp"

namespace peclet::flow {
namespace {

PressureSides box_sides(const DomainSides& sides) {
  PressureSides result;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high)
      result.side[axis][high] = sides.is_periodic(axis) ? PressureSide::Periodic : PressureSide::Closed;
  return result;
}

/// Exchange of the points beside the sides of the box with zero on the side, in units of the regular one; see
/// GhostRules.
struct SideExchange {
  Real at[3][2] = {};
  bool is_periodic[3] = {};

  SideExchange(const DomainSides& sides, int c) {
    for (int axis = 0; axis < 3; ++axis) {
      is_periodic[axis] = sides.is_periodic(axis);
      for (int high = 0; high < 2; ++high) {
        const DomainSide& side = sides.side[axis][high];
        if (axis == c)
          at[axis][high] = side.kind == SideKind::Outflow ? 0 : 1;
        else
          at[axis][high] = side.prescribes_velocity() ? 8.0 / 3 : 0;
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
void fill_regular_rows(const ViscousSystem& system, Real volume, Real share,
                       const FaceVector<OpenFraction>& links, const Field<float>& reaction) {
  const Layout layout = system.layout();
  const Field<OpenFraction> open = system.open;
  const FaceVector<OpenFraction> target = links;
  const Field<float> total = reaction;
  const SideExchange exchange(system.sides, system.component);
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

/// Factor of a wall row that bounds its exchange with every fluid neighbour by that of a regular row; it
/// makes the operator nearly symmetric.
KOKKOS_INLINE_FUNCTION Real row_factor(const WallRows& rows, Index row) {
  Real largest = 1;
  for (int d = 0; d < WallRows::directions; ++d)
    if (!rows.is_wall(row, d)) largest = Kokkos::fmax(largest, static_cast<Real>(rows.weight(row, d)));
  return 1 / largest;
}

/// Wall rows, scaled: exchange with the walls, and on the low or high sides the mean with the neighbour's.
struct WallLinks {
  WallRows rows;
  Layout layout;
  FaceVector<OpenFraction> links;
  Field<float> reaction;
  Real3 along;
  Real share;
  bool is_periodic[3];

  KOKKOS_INLINE_FUNCTION void set_reaction(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    Real sum = reaction[p];
    for (int d = 0; d < WallRows::directions; ++d)
      if (rows.is_wall(row, d)) sum += share * along[d / 2] * rows.weight(row, d);
    reaction[p] = static_cast<float>(row_factor(rows, row) * sum);
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

void fill_wall_rows(const ViscousSystem& system, const WallRows& rows, Real share,
                    const FaceVector<OpenFraction>& links, const Field<float>& reaction) {
  WallLinks walls{rows, system.layout(), links, reaction, relative_exchange(system.grid), share, {}};
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
      : upwind(system.upwind<Real>()), open(system.open), exchange(system.sides, system.component) {
    for (int a = 0; a < 3; ++a) unit[a] = largest / (system.grid.spacing[a] * system.grid.spacing[a]);
  }

  KOKKOS_INLINE_FUNCTION Real across(int axis, Index p) const {
    return 0.5 * Kokkos::abs(upwind.carried(axis, p));
  }
};

/// Diffusion that bounds the exchange between any two points.
Real largest_exchange(const ViscousSystem& system) {
  /// of advection where a step carries nothing: the preconditioner divides by the exchange
  constexpr Real least = 1e-6;
  const UpwindExchange exchange(system, 1);
  const Layout layout = system.layout();
  const Real carried = max_cells(
      "flow::upwind_exchange", system.rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = layout(i, j, k);
        Real largest = 0;
        for (int a = 0; a < 3; ++a) {
          const Real across = Kokkos::fmax(exchange.across(a, p), exchange.across(a, p + layout.stride(a)));
          largest = Kokkos::fmax(largest, across / exchange.unit[a]);
        }
        return largest;
      });
  const Real smallest = system.grid.smallest_spacing();
  return system.diffusion + std::max(carried, least * smallest * smallest);
}

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

void scale_wall_rows(const WallRows& rows, const Field<float>& rhs) {
  const WallRows w = rows;
  const Field<float> r = rhs;
  for_each(
      "flow::viscous_scale_rows", rows.count, KOKKOS_LAMBDA(Index row) {
        if (!w.superseded(row)) r[w.face(row)] *= static_cast<float>(row_factor(w, row));
      });
}

/// Unknowns on the high side along the component, which the multigrid does not have, are tied to those beside
/// them; what the tie leaves is divided by the diagonal.
struct OuterPoints {
  Box points;
  Layout layout;
  Field<OpenFraction> open;
  Index step = 0;
  float tie = 0, inverse = 0;

  /// exchange: diffusion whose exchange the multigrid has at most.
  OuterPoints(const ViscousSystem& system, Real exchange) : layout(system.layout()), open(system.open) {
    const int c = system.component;
    if (c < 0 || system.sides.side[c][1].kind != SideKind::Outflow) return;
    points = {{0, 0, 0}, layout.cells};
    points.low[c] = layout.cells[c];
    points.high[c] = layout.cells[c] + 1;
    step = layout.stride(c);
    const Diffusion<Real> diffusion(system.grid, exchange);
    const Real across = diffusion.along(c);
    const Real unit = std::pow(system.grid.smallest_spacing(), 2) / exchange;
    tie = static_cast<float>(across / (1 + across));
    inverse = static_cast<float>(1 / (unit * (diffusion.diagonal - across)));
  }

  void restrict_to_inner(const Field<float>& rhs) const {
    const OuterPoints self = *this;
    const Field<float> r = rhs;
    for_each_cell(
        "flow::restrict_outer", points, KOKKOS_LAMBDA(int i, int j, int k) {
          const Index p = self.layout(i, j, k);
          r[p - self.step] += in_fluid(self.open[p], self.tie * r[p]);
        });
  }
  void prolong_to_outer(const Field<float>& rhs, const Field<float>& correction) const {
    const OuterPoints self = *this;
    const Field<float> r = rhs, z = correction;
    for_each_cell(
        "flow::prolong_outer", points, KOKKOS_LAMBDA(int i, int j, int k) {
          const Index p = self.layout(i, j, k);
          z[p] = in_fluid(self.open[p], self.tie * z[p - self.step] + self.inverse * r[p]);
        });
  }
};

}  // namespace

ViscousKrylov::ViscousKrylov(const Grid& grid, const DomainSides& sides)
    : sides_(box_sides(sides)),
      multigrid_(grid.cells, grid.spacing, sides_),
      links_("flow::viscous_links", Layout(grid.cells)),
      reaction_("flow::viscous_reaction", Layout(grid.cells)),
      shadow_("flow::viscous_shadow", Layout(grid.cells)),
      search_("flow::viscous_search", Layout(grid.cells)),
      product_("flow::viscous_product", Layout(grid.cells)) {
  multigrid_.set_open_fractions(links_, RowRanges(grid.cells), reaction_);
}

bool ViscousKrylov::fits(const DomainSides& sides) const {
  for (int axis = 0; axis < 3; ++axis)
    if (sides.is_periodic(axis) != sides_.is_periodic(axis)) return false;
  return true;
}

void ViscousKrylov::set_system(const ViscousSystem& system) {
  exchange_ = system.is_advected() ? largest_exchange(system) : system.diffusion;
  const Real volume = std::pow(system.grid.smallest_spacing(), 2) / exchange_;
  const Real share = system.diffusion / exchange_;
  fill_regular_rows(system, volume, share, links_, reaction_);
  fill_wall_rows(system, system.fixed_rows, share, links_, reaction_);
  fill_wall_rows(system, system.moving_rows, share, links_, reaction_);
  if (system.is_advected()) add_upwind_exchange(system, exchange_, links_, reaction_);
  for (int a = 0; a < 3; ++a) fill_periodic_ghosts(links_[a], system.sides.periodicity());
  multigrid_.update({Box{{0, 0, 0}, system.grid.cells}});
}

const Field<float>& ViscousKrylov::precondition(const ViscousSystem& system) {
  scale_wall_rows(system.fixed_rows, multigrid_.residual());
  scale_wall_rows(system.moving_rows, multigrid_.residual());
  const OuterPoints outer(system, exchange_);
  outer.restrict_to_inner(multigrid_.residual());
  multigrid_.apply();
  outer.prolong_to_outer(multigrid_.residual(), multigrid_.correction());
  ghosts_of(system, multigrid_.correction()).body.finish();
  return multigrid_.correction();
}

Real ViscousKrylov::multiply(const ViscousSystem& system, const Field<float>& e, const Field<float>& out,
                             const Field<float>& other) {
  const Diffusion<float> diffusion(system);
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  if (system.is_advected()) {
    const UpwindAdvection<float> upwind = system.upwind<float>();
    return sweep("flow::advected_product", *system.plan,
                 Stage(system.rows, RegularProduct{e.layout(), e.data(), out.data(), diffusion},
                       at_walls(fixed, WallProduct{fixed, e, out, diffusion}),
                       at_walls(moving, WallProduct{moving, e, out, diffusion}),
                       AddUpwind<float>{upwind, e.data(), out.data(), 1},
                       at_walls(fixed, AddWallUpwind<float>{fixed, upwind, e, out, 1}),
                       at_walls(moving, AddWallUpwind<float>{moving, upwind, e, out, 1}),
                       MaskedDot{e.layout(), system.open.data(), out.data(), other.data()}))
        .sum;
  }
  return sweep("flow::viscous_product", *system.plan,
               Stage(system.rows, RegularProduct{e.layout(), e.data(), out.data(), diffusion},
                     at_walls(fixed, WallProduct{fixed, e, out, diffusion}),
                     at_walls(moving, WallProduct{moving, e, out, diffusion}),
                     MaskedDot{e.layout(), system.open.data(), out.data(), other.data()}))
      .sum;
}

int ViscousKrylov::solve(const ViscousSystem& system, const Field<Real>& residual, Real largest,
                         Real reduction, int limit, const Field<float>& e, const Field<float>& r) {
  const Layout layout = system.layout();
  const SweepPlan& plan = *system.plan;
  const RowRanges& rows = system.rows;
  const Field<float>& rhs = multigrid_.residual();
  const auto dot_with = [&](const Field<float>& a, const Field<float>& b) { return dot(a, b, rows, plan); };
  const auto advance = [&](const Field<float>& direction, const Field<float>& product, Real step) {
    return sweep("flow::viscous_advance", plan,
                 Stage(rows, AdvanceKrylov{layout, direction.data(), product.data(), e.data(), r.data(),
                                           rhs.data(), static_cast<float>(step)}))
        .largest;
  };

  Real rho = sweep("flow::viscous_begin", plan,
                   Stage(rows, BeginKrylov{layout, system.open.data(), residual.data(), e.data(), r.data(),
                                           shadow_.data(), search_.data(), product_.data(), 1 / largest}))
                 .squares;
  Real beta = 0, omega = 0;
  int iterations = 0;
  while (iterations < limit) {
    sweep("flow::viscous_search", plan,
          Stage(rows, NewSearch{layout, r.data(), product_.data(), search_.data(), rhs.data(),
                                static_cast<float>(beta), static_cast<float>(omega)}));
    ++iterations;
    const Field<float>& direction = precondition(system);
    const Real alpha = rho / multiply(system, direction, product_, shadow_);
    if (!std::isfinite(alpha) || alpha == 0 || advance(direction, product_, alpha) <= reduction) break;
    precondition(system);
    const Real along = multiply(system, direction, rhs, r);
    omega = along / dot_with(rhs, rhs);
    if (!std::isfinite(omega) || omega == 0 || advance(direction, rhs, omega) <= reduction) break;
    const Real next = dot_with(shadow_, r);
    beta = next / rho * (alpha / omega);
    rho = next;
    if (!std::isfinite(beta) || rho == 0) break;
  }
  sweep("flow::viscous_scale", plan,
        Stage(rows, ScaleVector{layout, e.data(), largest}, ghosts_of(system, e)));
  return iterations;
}

std::size_t ViscousKrylov::bytes() const {
  const auto cells = reaction_.array().span();
  return multigrid_.bytes() + cells * (4 * sizeof(float) + 3 * sizeof(OpenFraction));
}

}  // namespace peclet::flow
