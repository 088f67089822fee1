#include "flow/scalar_transport.hpp"

#include "flow/advection_schemes.hpp"
#include "flow/scalar_fluxes.hpp"

namespace peclet::flow {
namespace {

/// dt / h times div(F c_f) on the regular grid, row by row.
template <class Scheme>
struct AdvectionRow {
  const Real *c, *u, *v, *w;
  const OpenFraction *ox, *oy, *oz;
  Index sy, sz;
  Real fx, fy, fz;  // dt / h, per unit of the open fraction
  Real gx, gy, gz;  // half the mean gradient times spacing

  KOKKOS_FORCEINLINE_FUNCTION static Real flux(const OpenFraction* open, const Real* velocity, const Real* c,
                                               Index n, Index step) {
    const Real carrier = static_cast<Real>(open[n]) * velocity[n];
    return carrier * carried_value<Scheme>(carrier, c[n - 2 * step], c[n - step], c[n], c[n + step]);
  }
  KOKKOS_FORCEINLINE_FUNCTION static Real volume(const OpenFraction* open, const Real* velocity, Index n,
                                                 Index step) {
    return static_cast<Real>(open[n]) * velocity[n] + static_cast<Real>(open[n + step]) * velocity[n + step];
  }
  KOKKOS_FORCEINLINE_FUNCTION Real operator()(int i) const {
    return fx * (flux(ox, u, c, i + 1, 1) - flux(ox, u, c, i, 1) + gx * volume(ox, u, i, 1)) +
           fy * (flux(oy, v, c, i + sy, sy) - flux(oy, v, c, i, sy) + gy * volume(oy, v, i, sy)) +
           fz * (flux(oz, w, c, i + sz, sz) - flux(oz, w, c, i, sz) + gz * volume(oz, w, i, sz));
  }
};

template <class Scheme>
KOKKOS_INLINE_FUNCTION AdvectionRow<Scheme> advection_row(const ScalarTerms& t, const Real* c, Index n) {
  const Layout& layout = t.fields.value.layout();
  const Real scale = t.time_step * open_fraction_unit;
  const Real3& h = t.grid.spacing;
  return {c + n,
          t.carrier.x.data() + n,
          t.carrier.y.data() + n,
          t.carrier.z.data() + n,
          t.open.x.data() + n,
          t.open.y.data() + n,
          t.open.z.data() + n,
          layout.pitch_y,
          layout.pitch_z,
          scale / h[0],
          scale / h[1],
          scale / h[2],
          0.5 * h[0] * t.mean_gradient[0],
          0.5 * h[1] * t.mean_gradient[1],
          0.5 * h[2] * t.mean_gradient[2]};
}

/// c1 = c - dt A(c) + r g
template <class Scheme>
struct Prediction {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  ScalarTerms terms;

  struct Row {
    AdvectionRow<Scheme> advection;
    const OpenFraction* state;
    const Real *value, *gain;
    Real* predicted;
    Real ratio;
    KOKKOS_FORCEINLINE_FUNCTION void operator()(int i) const {
      const Real c = value[i], result = c - advection(i) + ratio * gain[i];
      predicted[i] = state[i] ? result : c;
    }
  };
  KOKKOS_FORCEINLINE_FUNCTION Row row(int j, int k) const {
    const ScalarFields& f = terms.fields;
    const Index n = f.value.layout()(0, j, k);
    return {advection_row<Scheme>(terms, f.value.data(), n),
            f.state.data() + n,
            f.value.data() + n,
            f.gain.data() + n,
            f.predicted.data() + n,
            terms.step_ratio};
  }
};

/// c_a = (c + c1 - r g) / 2 - dt/2 A(c1), and the residual.
template <class Scheme>
struct Residual {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  ScalarTerms terms;
  Real* residual;

  struct Row {
    AdvectionRow<Scheme> advection;
    const OpenFraction* state;
    const Real *value, *previous, *gain, *predicted, *source;
    Real *advected, *residual;
    Index sy, sz;
    Real dx, dy, dz;                           // dt D / h^2
    Real ratio, uniform_source, source_scale;  // source is any field where the scale is 0

    KOKKOS_FORCEINLINE_FUNCTION Real extrapolated(Index n) const {
      return value[n] + 0.5 * ratio * (value[n] - previous[n]);
    }
    KOKKOS_FORCEINLINE_FUNCTION void operator()(int i) const {
      const Real c = value[i];
      const Real a = 0.5 * (c + predicted[i] - ratio * gain[i]) - 0.5 * advection(i);
      const Real diffusion = dx * (extrapolated(i - 1) + extrapolated(i + 1)) +
                             dy * (extrapolated(i - sy) + extrapolated(i + sy)) +
                             dz * (extrapolated(i - sz) + extrapolated(i + sz)) -
                             2 * (dx + dy + dz) * extrapolated(i);
      const Real given = uniform_source + source_scale * source[i];
      const Real result = (a - c) + diffusion + given - ratio * (c - previous[i]);
      advected[i] = a;
      residual[i] = state[i] ? result : 0.0;
    }
  };
  KOKKOS_FORCEINLINE_FUNCTION Row row(int j, int k) const {
    const ScalarFields& f = terms.fields;
    const Layout& layout = f.value.layout();
    const Index n = layout(0, j, k);
    const Real diffusion = terms.time_step * terms.diffusivity;
    const Real3& h = terms.grid.spacing;
    return {advection_row<Scheme>(terms, f.predicted.data(), n),
            f.state.data() + n,
            f.value.data() + n,
            f.previous.data() + n,
            f.gain.data() + n,
            f.predicted.data() + n,
            (terms.source_field.data() ? terms.source_field : f.value).data() + n,
            f.advected.data() + n,
            residual + n,
            layout.pitch_y,
            layout.pitch_z,
            diffusion / (h[0] * h[0]),
            diffusion / (h[1] * h[1]),
            diffusion / (h[2] * h[2]),
            terms.step_ratio,
            terms.time_step * terms.source,
            terms.source_field.data() ? terms.time_step : 0};
  }
};

struct ScalarUpdate {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  ScalarTerms terms;
  const Real* correction;
  Real left_over;

  struct Row {
    const OpenFraction* state;
    const Real *value, *correction, *advected;
    Real *previous, *gain;
    Real ratio, left_over;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      if (!state[i]) return;
      const Real result = value[i] + ratio * (value[i] - previous[i]) + (correction[i] + left_over);
      previous[i] = result;
      gain[i] = result - advected[i];
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const ScalarFields& f = terms.fields;
    const Index n = f.value.layout()(0, j, k);
    return {f.state.data() + n,    f.value.data() + n, correction + n,   f.advected.data() + n,
            f.previous.data() + n, f.gain.data() + n,  terms.step_ratio, left_over};
  }
};

/// c1 of the rows.
template <class Scheme>
void predict_rows(const ScalarTerms& terms, const ScalarRows& rows) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  for_each(
      "flow::predict_scalar_rows", rows.links.count, KOKKOS_LAMBDA(Index row) {
        const Index p = r.links.face(row);
        const ScalarFields& f = t.fields;
        const Real change = advection_at_row<Scheme>(t, f.value, p) / static_cast<Real>(f.volume[p]);
        f.predicted[p] = f.value[p] - t.time_step * change + t.step_ratio * f.gain[p];
      });
}

/// c_a of the rows.
template <class Scheme>
void advect_rows(const ScalarTerms& terms, const ScalarRows& rows) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  for_each(
      "flow::advect_scalar_rows", rows.links.count, KOKKOS_LAMBDA(Index row) {
        const Index p = r.links.face(row);
        const ScalarFields& f = t.fields;
        const Real change = advection_at_row<Scheme>(t, f.predicted, p) / static_cast<Real>(f.volume[p]);
        f.advected[p] =
            0.5 * (f.value[p] + f.predicted[p] - t.step_ratio * f.gain[p]) - 0.5 * t.time_step * change;
      });
}

/// target -= share dt (wall flux) c / V in the cut cells of moving bodies.
void subtract_swept_volume(const ScalarTerms& terms, const CutCells& cut_cells, const Field<Real>& value,
                           Real share, const Field<Real>& target) {
  const ScalarTerms t = terms;
  const CutCells cut = cut_cells;
  const Field<Real> c = value, result = target;
  for_each(
      "flow::subtract_swept_volume", cut_cells.count, KOKKOS_LAMBDA(Index n) {
        const Index p = cut.cell(n);
        if (t.fields.state[p] == cell_state::solid) return;
        result[p] -= share * t.time_step * cut.wall_flux(n) * c[p] / static_cast<Real>(t.fields.volume[p]);
      });
}

/// The residual everywhere in the rows and the cut cells, from what the sweep and the rows left in advected.
void residual_of_rows(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& residual) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  const Field<Real> result = residual;
  for_each(
      "flow::scalar_residual_rows", rows.links.count, KOKKOS_LAMBDA(Index row) {
        const Index p = r.links.face(row);
        const ScalarFields& f = t.fields;
        const Real ratio = t.step_ratio;
        const Real given = t.source + r.source(row) + (t.source_field.data() ? t.source_field[p] : 0.0);
        result[p] = (f.advected[p] - f.value[p]) - ratio * (f.value[p] - f.previous[p]) +
                    t.time_step * (t.diffusivity * laplacian_at_row(t, r, row, 0.5 * ratio) + given);
      });
}

template <class Scheme>
void predict_with(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                  const CutCells& cut_cells) {
  sweep("flow::predict_scalar", plan, Stage{RowRanges(terms.grid.cells), Prediction<Scheme>{terms}});
  predict_rows<Scheme>(terms, rows);
  subtract_swept_volume(terms, cut_cells, terms.fields.value, 1, terms.fields.predicted);
}

template <class Scheme>
void residual_with(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                   const CutCells& cut_cells, const Field<Real>& residual) {
  const ScalarFields& f = terms.fields;
  sweep("flow::scalar_residual", plan,
        Stage{RowRanges(terms.grid.cells), Residual<Scheme>{terms, residual.data()}});
  advect_rows<Scheme>(terms, rows);
  subtract_swept_volume(terms, cut_cells, f.predicted, 0.5, f.advected);
  subtract_swept_volume(terms, cut_cells, f.predicted, 0.5, residual);
  residual_of_rows(terms, rows, residual);
}

}  // namespace

void predict_scalar(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                    const CutCells& cut_cells) {
  switch (terms.scheme) {
    case ScalarScheme::FirstUpwind:
      return predict_with<FirstUpwindScheme>(terms, plan, rows, cut_cells);
    case ScalarScheme::SecondUpwind:
      return predict_with<SecondUpwindScheme>(terms, plan, rows, cut_cells);
    case ScalarScheme::Koren:
      return predict_with<KorenScheme>(terms, plan, rows, cut_cells);
  }
}

void compute_scalar_residual(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                             const CutCells& cut_cells, const Field<Real>& residual) {
  switch (terms.scheme) {
    case ScalarScheme::FirstUpwind:
      return residual_with<FirstUpwindScheme>(terms, plan, rows, cut_cells, residual);
    case ScalarScheme::SecondUpwind:
      return residual_with<SecondUpwindScheme>(terms, plan, rows, cut_cells, residual);
    case ScalarScheme::Koren:
      return residual_with<KorenScheme>(terms, plan, rows, cut_cells, residual);
  }
}

void apply_scalar_correction(const ScalarTerms& terms, const SweepPlan& plan, const Field<Real>& correction,
                             Real left_over) {
  sweep("flow::apply_scalar_correction", plan,
        Stage{RowRanges(terms.grid.cells), ScalarUpdate{terms, correction.data(), left_over}});
}

}  // namespace peclet::flow
