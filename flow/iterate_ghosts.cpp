#include "flow/iterate_ghosts.hpp"

namespace peclet::flow {
namespace {

/// Points on the side: prescribed ones are zero, on an Outflow the derivative beyond is.
GhostRule normal_rule(SideKind kind, int high, int n, Index step) {
  const Index beyond = high ? step : -step;
  if (kind == SideKind::Outflow) return {high ? n : 0, beyond, 0, 0, 1, 0};
  return {high ? n - 1 : 0, high ? step : 0, 0, 0, 0, 0};
}

/// Points half a cell inside: where the side prescribes the velocity, the parabola through zero on the side.
GhostRule tangential_rule(const DomainSide& side, int high, int n, Index step) {
  const Index beyond = high ? step : -step;
  if (!side.prescribes_velocity()) return {high ? n - 1 : 0, beyond, 0, 0, 1, 0};
  if (n == 1) return {0, beyond, 0, 0, -4.0 / 3, 0};
  if (high) return {n - 1, step, 0, -step, -2, 1.0 / 3};
  return {1, -2 * step, -step, 0, -2, 1.0 / 3};
}

/// Where a rule is applied; one cell more along the other axes, as there may be unknowns on a high side.
Box places_of(const GhostRule& rule, const Layout& layout, int axis) {
  Box cells{{0, 0, 0}, layout.cells};
  for (int a = 0; a < 3; ++a) ++cells.high[a];
  cells.low[axis] = rule.at;
  cells.high[axis] = rule.at + 1;
  return cells;
}

void apply_on_side(const IterateGhosts& ghosts, int axis, const GhostRule& rule) {
  if (rule.at < 0) return;
  const IterateGhosts target = ghosts;
  const GhostRule applied = rule;
  for_each_cell(
      "flow::iterate_ghosts", places_of(rule, ghosts.layout, axis),
      KOKKOS_LAMBDA(int i, int j, int k) { target.apply(applied, target.layout(i, j, k)); });
}

bool is_exact(const GhostRule& rule) { return rule.at < 0 || (rule.near * rule.near <= 1 && rule.next == 0); }

/// Where on the axis the source is.
int source_index(const GhostRule& rule, Index step) { return rule.at + static_cast<int>(rule.source / step); }

template <class Weight>
void put_right_on_side(const GhostRounding<Weight>& rounding, int axis, const GhostRule& rule) {
  if (is_exact(rule)) return;
  const GhostRounding<Weight> target = rounding;
  const GhostRule applied = rule;
  for_each_cell(
      "flow::ghost_rounding", places_of(rule, rounding.layout, axis),
      KOKKOS_LAMBDA(int i, int j, int k) { target.apply(axis, applied, target.layout(i, j, k)); });
}

}  // namespace

template <class Weight>
void GhostRounding<Weight>::finish_row(int j, int k) const {
  const Index row = layout(0, j, k), last = row + layout.cells[0];
  for (const GhostRule& rule : rules.side[0])
    if (!is_exact(rule)) apply(0, rule, row + rule.at);
  for (int axis = 1; axis < 3; ++axis)
    for (const GhostRule& rule : rules.side[axis]) {
      if (is_exact(rule) || source_index(rule, layout.stride(axis)) != (axis == 1 ? j : k)) continue;
      PECLET_INDEPENDENT_ITERATIONS
      for (Index p = row; p <= last; ++p) apply(axis, rule, p - rule.source);
    }
}

template <class Weight>
void GhostRounding<Weight>::finish() const {
  for (int axis = 0; axis < 3; ++axis)
    for (const GhostRule& rule : rules.side[axis]) put_right_on_side(*this, axis, rule);
}

template struct GhostRounding<DiffusiveWeight>;
template struct GhostRounding<AdvectiveWeight>;

GhostRules::GhostRules(const Layout& layout, const DomainSides& sides, int c) {
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      const int n = layout.cells[axis];
      const Index step = layout.stride(axis);
      const DomainSide& one = sides.side[axis][high];
      if (sides.is_periodic(axis))
        side[axis][high] = {high ? n - 1 : 0, high ? -n * step : n * step, 0, 0, 1, 0};
      else
        side[axis][high] =
            axis == c ? normal_rule(one.kind, high, n, step) : tangential_rule(one, high, n, step);
    }
}

void IterateGhosts::finish_row_at_side(Index row, int j, int k) const {
  const Index last = row + layout.cells[0];  // one more: on a high side there may be unknowns beyond
  for (int axis = 1; axis < 3; ++axis)
    for (const GhostRule& rule : rules.side[axis]) {
      if (rule.at != (axis == 1 ? j : k)) continue;
      PECLET_INDEPENDENT_ITERATIONS
      for (Index p = row; p <= last; ++p) apply(rule, p);
    }
}

void IterateGhosts::finish() const {
  for (int axis = 0; axis < 3; ++axis)
    for (const GhostRule& rule : rules.side[axis]) apply_on_side(*this, axis, rule);
}

}  // namespace peclet::flow
