#pragma once
// Ghosts of a correction during a sweep: one layer, no edges, filled row by row as soon as the values are
// there.
#include "core/sweep_stage.hpp"
#include "flow/domain_sides.hpp"
#include "flow/upwind_advection.hpp"

namespace peclet::flow {

/// What a side of the box makes of the values near it: on the row, plane or column of index at along the
/// axis,
///   e[p + target] = near e[p + source] + next e[p + second].
/// The source is beside the side; where the rule is not exact in single precision, the double sum differs.
struct GhostRule {
  int at = -1;  // none
  Index target = 0, source = 0, second = 0;
  Real near = 0, next = 0;

  KOKKOS_INLINE_FUNCTION Real value(const float* e, Index p) const {
    return near * Real{e[p + source]} + next * Real{e[p + second]};
  }
  KOKKOS_INLINE_FUNCTION bool is_copy() const { return near == 1 && next == 0; }
};

/// Low and high side of each axis: the rules of fill_correction_ghosts.
struct GhostRules {
  GhostRule side[3][2];

  GhostRules() = default;
  /// c: velocity component.
  GhostRules(const Layout& layout, const DomainSides& sides, int c);
};

/// Part of a stage that writes e: fills the ghosts that depend on a row.
struct IterateGhosts {
  Layout layout;
  GhostRules rules;
  float* e;

  KOKKOS_INLINE_FUNCTION void apply(const GhostRule& rule, Index p) const {
    e[p + rule.target] = rule.is_copy() ? e[p + rule.source] : static_cast<float>(rule.value(e, p));
  }

  void finish_row(int j, int k) const {
    const Index row = layout(0, j, k);
    for (const GhostRule& rule : rules.side[0])
      if (rule.at >= 0) apply(rule, row + rule.at);
    const GhostRule(&y)[2] = rules.side[1], (&z)[2] = rules.side[2];
    if (j == y[0].at || j == y[1].at || k == z[0].at || k == z[1].at) finish_row_at_side(row, j, k);
  }

  /// On a device: all sides after a kernel over all rows.
  void finish() const;

 private:
  /// Few rows need it: kept apart, so that the others are short.
  void finish_row_at_side(Index row, int j, int k) const;
};

/// Weight of a ghost in A: of diffusion.
struct DiffusiveWeight {
  Real3 along;

  KOKKOS_INLINE_FUNCTION Real operator()(int axis, const GhostRule&, Index) const { return along[axis]; }
};

/// The same with upwind advection.
struct AdvectiveWeight {
  Real3 along;
  UpwindAdvection<Real> upwind;

  KOKKOS_INLINE_FUNCTION Real operator()(int axis, const GhostRule& rule, Index p) const {
    return along[axis] + upwind.inflow(p + rule.source, 2 * axis + (rule.target > 0));
  }
};

/// Part of a stage after residual -= A e: ghosts that rounding kept from following their rule are put right.
template <class Weight>
struct GhostRounding {
  Layout layout;
  GhostRules rules;
  const float* e;
  Real* residual;
  Weight weight;

  KOKKOS_INLINE_FUNCTION void apply(int axis, const GhostRule& rule, Index p) const {
    residual[p + rule.source] += weight(axis, rule, p) * (rule.value(e, p) - Real{e[p + rule.target]});
  }

  /// A rule is applied on the row of its source.
  void finish_row(int j, int k) const;
  void finish() const;
};

}  // namespace peclet::flow
