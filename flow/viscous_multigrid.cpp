#include "flow/viscous_multigrid.hpp"

#include <cmath>

#include "flow/level_transfer.hpp"
#include "flow/viscous_sweeps.hpp"

namespace peclet::flow {
namespace {

/// Sweeps before and after the coarse correction. Even: the stages of a sweep keep pairs of planes together.
constexpr int smoothing_sweeps = 4;
/// What they reduce, as shares of the largest eigenvalue.
constexpr Real smoothed_from = 0.2, smoothed_to = 0.95;

PressureSides box_sides(const DomainSides& sides) {
  PressureSides result;
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high)
      result.side[axis][high] = sides.is_periodic(axis) ? PressureSide::Periodic : PressureSide::Closed;
  return result;
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

  bool exist() const { return points.size() > 0; }

  void restrict_to_inner(const Field<float>& rhs) const {
    const OuterPoints self = *this;
    const Field<float> r = rhs;
    for_each_cell(
        "flow::restrict_outer", points, KOKKOS_LAMBDA(int i, int j, int k) {
          const Index p = self.layout(i, j, k);
          r[p - self.step] += in_fluid(self.open[p], self.tie * r[p]);
        });
  }
  /// They follow the coarse correction of those beside them.
  void add_coarse(const LevelShape& fine, const LevelShape& coarse, const Merging& merging,
                  const Field<float>& coarse_correction, const Field<float>& correction) const {
    const OuterPoints self = *this;
    const Field<float> from = coarse_correction, to = correction;
    const Int3 last{fine.cells[0] - 1, fine.cells[1] - 1, fine.cells[2] - 1};
    const Layout below = coarse.layout;
    const Merging merged = merging;
    for_each_cell(
        "flow::outer_correction", points, KOKKOS_LAMBDA(int i, int j, int k) {
          const Index p = self.layout(i, j, k);
          const int at_x = merged.parent(0, i < last[0] ? i : last[0]);
          const int at_y = merged.parent(1, j < last[1] ? j : last[1]);
          const int at_z = merged.parent(2, k < last[2] ? k : last[2]);
          to[p] += in_fluid(self.open[p], from[below(at_x, at_y, at_z)]);
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

/// out = scale (rhs - A e), zero at solid points.
struct RegularRemainder {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const float *rhs, *e;
  float* out;
  Diffusion<float> d;
  float scale;

  struct Row {
    const OpenFraction* open;
    const float* rhs;
    float* out;
    ProductRow product;
    float scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float value = scale * (rhs[i] - product(i));
      out[i] = is_fluid(open[i]) ? value : 0.0F;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, rhs + n, out + n, ProductRow(layout, e + n, d), scale};
  }
};

/// Scaled as the relative is, and passed on as WallProlongation brings changes back.
struct WallRemainder {
  WallRows rows;
  Field<float> rhs, e, out;
  Diffusion<float> diffusion;
  Merging merging;
  float scale;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const float share = share_of_coarse_change(rows, row, merging);
    const float factor = scale * static_cast<float>(row_factor(rows, row)) * share;
    out[p] = factor * (rhs[p] - wall_product(rows, row, e, diffusion));
  }
};

/// Wall points have got the whole change of their coarse cells and give a part of it back; see OuterPoints
/// for those on the high side.
struct WallProlongation {
  WallRows rows;
  Field<float> e, coarse;
  Merging merging;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const Int3 at = cell_of(e.layout(), p);
    for (int a = 0; a < 3; ++a)
      if (at[a] == e.layout().cells[a]) return;
    const Index q =
        coarse.layout()(merging.parent(0, at[0]), merging.parent(1, at[1]), merging.parent(2, at[2]));
    e[p] -= (1 - share_of_coarse_change(rows, row, merging)) * coarse[q];
  }
};

/// The stages of the finest level.
template <int RatioX>
struct FinestLevel {
  const ViscousSystem& system;
  const BasicMultigrid<true>& multigrid;
  Diffusion<float> diffusion;
  Layout layout;
  float weights[smoothing_sweeps];
  float unit;  // of the relative's coefficients

  FinestLevel(const ViscousSystem& viscous, const BasicMultigrid<true>& levels)
      : system(viscous), multigrid(levels), diffusion(viscous), layout(viscous.layout()) {
    const Real high = bound_spectrum(system).high();
    const Spectrum smoothed{0.5 * high * (smoothed_to + smoothed_from),
                            0.5 * high * (smoothed_to - smoothed_from)};
    for (int m = 0; m < smoothing_sweeps; ++m) weights[m] = chebyshev_weight(m, smoothing_sweeps, smoothed);
    unit = static_cast<float>(std::pow(system.grid.smallest_spacing(), 2) / system.diffusion);
  }

  const LevelFields& fields() const { return multigrid.finest_fields(); }
  const Transfer& transfer() const { return multigrid.finest_transfer(); }
  /// Sweep m reads what the one before wrote; the last one writes the solution.
  const Field<float>& iterate(int m) const { return m % 2 ? fields().solution : fields().scratch; }

  template <class T>
  auto first(const Field<T>& residual) const {
    return first_sweep(system, residual, fields().rhs, iterate(0), weights[0]);
  }
  auto repeated(int m) const {
    return next_sweep(system, fields().rhs, iterate(m + 1), iterate(m), weights[m]);
  }
  /// Of every cell, so that none keeps what another component left there.
  auto restriction() const {
    const LevelFields& f = fields();
    const Transfer& t = transfer();
    const auto wall = [&](const WallRows& rows) {
      return at_walls(rows, WallRemainder{rows, f.rhs, f.solution, f.scratch, diffusion, t.merging, unit});
    };
    return CoarseningStage{
        Stage(RowRanges(layout.cells),
              RegularRemainder{layout, system.open.data(), f.rhs.data(), f.solution.data(), f.scratch.data(),
                               diffusion, unit},
              wall(system.fixed_rows), wall(system.moving_rows)),
        Stage(t.coarse_rows, SumOfChildren<RatioX>{multigrid.finest_shape(), t.coarse_shape, t.merging,
                                                   f.scratch.data(), multigrid.coarse_residual().data()}),
        t.merging.ratio, t.merging.shift};
  }
  auto prolongation() const {
    const Transfer& t = transfer();
    const Field<float>&e = fields().solution, &coarse = multigrid.coarse_correction();
    const auto wall = [&](const WallRows& rows) {
      return at_walls(rows, WallProlongation{rows, e, coarse, t.merging});
    };
    return Stage(t.prolongation_rows,
                 AddToChildren<RatioX, true>{multigrid.finest_shape(), t.coarse_shape, t.merging,
                                             coarse.data(), e.data(), system.open.data()},
                 wall(system.fixed_rows), wall(system.moving_rows), ghosts_of(system, e));
  }

  /// Adds what the coarse levels find and smooths it.
  void correct_from_below(const OuterPoints& outer) const {
    const SweepPlan& plan = *system.plan;
    multigrid.apply_below();
    if (outer.exist()) {
      sweep("flow::viscous_prolong", plan, prolongation());
      outer.add_coarse(multigrid.finest_shape(), transfer().coarse_shape, transfer().merging,
                       multigrid.coarse_correction(), multigrid.correction());
      ghosts_of(system, multigrid.correction()).body.finish();
      sweep("flow::viscous_smooth", plan, repeated(0), repeated(1), repeated(2), repeated(3));
    } else {
      sweep("flow::viscous_prolong", plan, prolongation(), repeated(0), repeated(1), repeated(2),
            repeated(3));
    }
  }
};

}  // namespace

ViscousMultigrid::ViscousMultigrid(const Grid& grid, const DomainSides& sides)
    : sides_(box_sides(sides)),
      links_("flow::viscous_links", Layout(grid.cells)),
      reaction_("flow::viscous_reaction", Layout(grid.cells)) {
  LevelFields finest;
  for (BasicMultigrid<true>& levels : levels_) {
    levels = BasicMultigrid<true>(grid.cells, grid.spacing, sides_, finest);
    levels.share_open_fractions(links_, RowRanges(grid.cells), reaction_);
    finest = levels.finest_fields();
  }
}

bool ViscousMultigrid::fits(const DomainSides& sides) const {
  for (int axis = 0; axis < 3; ++axis)
    if (sides.is_periodic(axis) != sides_.is_periodic(axis)) return false;
  return true;
}

void ViscousMultigrid::set_system(const ViscousSystem& system) {
  Taken& taken = taken_[system.component];
  const bool can_keep = !system.is_advected() && system.revision >= 0;
  const bool has_links = can_keep && taken.revision == system.revision;
  if (has_links && taken.diffusion == system.diffusion) return;
  taken = {can_keep ? system.revision : -1, system.diffusion, largest_exchange(system)};
  BasicMultigrid<true>& levels = levels_[system.component];
  const bool smooths_operator = is_solver(system);
  fill_links(system, taken.exchange, links_, reaction_,
             smooths_operator ? levels.finest_transfer().merging : Merging());
  levels.set_mass(static_cast<float>(std::pow(system.grid.smallest_spacing(), 2) / taken.exchange),
                  smooths_operator);
  if (has_links)
    levels.update_reaction();
  else
    levels.update({Box{{0, 0, 0}, system.grid.cells}});
}

void ViscousMultigrid::apply(const ViscousSystem& system) const {
  if (is_solver(system))
    apply(system, residual(), 1);
  else
    smooth_relative(system);
}

template <class T>
void ViscousMultigrid::apply(const ViscousSystem& system, const Field<T>& residual, int cycles) const {
  if (levels_[0].finest_transfer().merging.ratio[0] == 2)
    smooth_operator<2>(system, residual, cycles);
  else
    smooth_operator<1>(system, residual, cycles);
}
template void ViscousMultigrid::apply(const ViscousSystem&, const Field<Real>&, int) const;

template <int RatioX, class T>
void ViscousMultigrid::smooth_operator(const ViscousSystem& system, const Field<T>& residual,
                                       int cycles) const {
  static_assert(smoothing_sweeps == 4);
  const FinestLevel<RatioX> finest(system, levels_[system.component]);
  const OuterPoints outer(system, taken_[system.component].exchange);
  const SweepPlan& plan = *system.plan;
  sweep("flow::viscous_restrict", plan, finest.first(residual), finest.repeated(1), finest.repeated(2),
        finest.repeated(3), finest.restriction());
  finest.correct_from_below(outer);
  for (int cycle = 1; cycle < cycles; ++cycle) {
    sweep("flow::viscous_restrict", plan, finest.repeated(0), finest.repeated(1), finest.repeated(2),
          finest.repeated(3), finest.restriction());
    finest.correct_from_below(outer);
  }
}

void ViscousMultigrid::smooth_relative(const ViscousSystem& system) const {
  scale_wall_rows(system.fixed_rows, residual());
  scale_wall_rows(system.moving_rows, residual());
  const OuterPoints outer(system, taken_[system.component].exchange);
  outer.restrict_to_inner(residual());
  levels_[system.component].apply();
  outer.prolong_to_outer(residual(), correction());
  ghosts_of(system, correction()).body.finish();
}

std::size_t ViscousMultigrid::bytes() const {
  const std::size_t finest = 3 * sizeof(float) * residual().array().span();
  std::size_t levels = finest;
  for (const BasicMultigrid<true>& each : levels_) levels += each.bytes() - finest;
  return levels + reaction_.array().span() * (sizeof(float) + 3 * sizeof(OpenFraction));
}

}  // namespace peclet::flow
