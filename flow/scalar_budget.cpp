// Ghosts of scalars, and what scalars exchange: with walls, with sides, and on average.
#include "core/halo.hpp"
#include "flow/scalar_fluxes.hpp"
#include "flow/scalar_transport.hpp"

namespace peclet::flow {
namespace {

/// Ghosts beyond the two sides of an axis that is not periodic.
void fill_side_ghosts(const Field<Real>& value, const ScalarSides& sides, int axis) {
  const Int3 n = value.layout().cells;
  Box layer{{0, 0, 0}, n};
  layer.high[axis] = 1;
  const ScalarSides s = sides;
  const Field<Real> c = value;
  for_each_cell(
      "flow::scalar_ghosts", layer, KOKKOS_LAMBDA(int i, int j, int k) {
        const Int3 cell{i, j, k};
        const Index step = c.layout().stride(axis);
        for (int high = 0; high < 2; ++high) {
          const Index first = c.layout()(i, j, k) + (high ? (n[axis] - 1) * step : 0);
          const Index outward = high ? step : -step;
          const bool has_value = s.side[axis][high].condition == ScalarCondition::Value;
          const Real given = s.value(axis, high, cell);
          for (int depth = 0; depth < Layout::ghost_width; ++depth) {
            const Real mirrored = c[first - (depth < n[axis] ? depth : n[axis] - 1) * outward];
            c[first + (1 + depth) * outward] = has_value ? 2 * given - mirrored : mirrored;
          }
        }
      });
}

/// Flux of c through the face of a row in direction d, mean of both stages of the step.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real stage_mean_flux(const ScalarTerms& t, Index p, int d) {
  const ScalarFace face = scalar_face(t, p, d);
  return 0.5 * (advective_flux<Scheme>(t, t.fields.value, p, d, face) +
                advective_flux<Scheme>(t, t.fields.predicted, p, d, face));
}

/// Amount per time that the wall or side in direction d of a row gives by diffusion, w = v + theta e.
KOKKOS_INLINE_FUNCTION Real diffusive_exchange(const ScalarTerms& t, const ScalarRows& rows, Index row, int d,
                                               const Field<Real>& correction) {
  if (rows.coefficient(row, d) == 0) return 0;
  const ScalarFields& f = t.fields;
  const Real ratio = 0.5 * t.step_ratio, theta = t.implicit_weight, h = t.grid.spacing[d / 2];
  const Index p = rows.links.face(row);
  const Real volume = f.volume[p];
  const Real e = correction[p];
  Real sum = volume * rows.coefficient(row, d) *
             (scalar_difference(t, rows, row, d, f.value, f.previous, ratio) - theta * e);
  const int across = d ^ 1;
  if (f.state[p] == cell_state::whole && !rows.links.is_wall(row, across) &&
      rows.coefficient(row, across) != 0) {
    // the stencil of a wall weighs the neighbour across more than that neighbour weighs this cell
    const Index step = f.value.layout().stride(d / 2), q = across % 2 ? p + step : p - step;
    if (f.state[q] == cell_state::whole)
      sum +=
          (rows.coefficient(row, across) - 1) *
          (scalar_difference(t, rows, row, across, f.value, f.previous, ratio) + theta * (correction[q] - e));
  }
  return t.diffusivity * sum * t.grid.cell_volume() / (h * h);
}

template <class Scheme>
void add_exchange_with(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& correction,
                       int bodies, const Field<int>& owner, ScatterSum& sums) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  const Field<Real> e = correction;
  const Field<int> owners = owner;
  const Bins bins = sums.bins();
  for_each_scattered(
      "flow::add_wall_exchange", rows.links.count, sums, KOKKOS_LAMBDA(Index row, int chunk) {
        const Index p = r.links.face(row);
        for (int d = 0; d < ScalarRows::directions; ++d) {
          const int giver = r.links.owner(row, d);
          if (giver == no_owner) continue;
          const Real area = t.grid.cell_volume() / t.grid.spacing[d / 2];
          Real amount = r.given(row, d) - (d % 2 ? 1 : -1) * area * stage_mean_flux<Scheme>(t, p, d);
          if (r.links.is_wall(row, d)) amount += diffusive_exchange(t, r, row, d, e);
          bins.add(chunk, giver_index(giver, bodies), amount);
        }
        const Real from_body = r.given(row, ScalarRows::body_slot);
        if (from_body != 0) bins.add(chunk, giver_index(owners[p], bodies), from_body);
      });
}

/// Flux along axis through the low face of cell p, of c - D dc/dx, per area of the whole face.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real low_face_flux(const ScalarTerms& t, int axis, Index p) {
  const ScalarFields& f = t.fields;
  const Index q = p - f.value.layout().stride(axis);
  const Real h = t.grid.spacing[axis], slope = t.mean_gradient[axis];
  if (f.state[p] == cell_state::solid) return 0;
  const Real flux = advective_flux<Scheme>(t, f.value, p, 2 * axis, scalar_face(t, p, 2 * axis));
  const bool is_regular = f.state[p] == cell_state::whole && f.state[q] == cell_state::whole;
  return is_regular ? flux - t.diffusivity * ((f.value[p] - f.value[q]) / h + slope) : flux;
}

/// What the diffusive flux through the low face of a row adds that low_face_flux leaves out.
KOKKOS_INLINE_FUNCTION Real cut_face_flux(const ScalarTerms& t, const ScalarRows& rows, int axis, Index row) {
  const ScalarFields& f = t.fields;
  const Index p = rows.links.face(row), q = p - f.value.layout().stride(axis);
  const bool is_regular = f.state[p] == cell_state::whole && f.state[q] == cell_state::whole;
  const int d = 2 * axis;
  const bool is_side = rows.links.owner(row, d) < sampled_solid;
  if ((is_regular && !is_side) || rows.coefficient(row, d) == 0) return 0;
  const Real opening = rows.coefficient(row, d) * static_cast<Real>(f.volume[p]);
  return t.diffusivity * opening * scalar_difference(t, rows, row, d, f.value, f.previous, 0) /
         t.grid.spacing[axis];
}

template <class Scheme>
Real3 mean_flux_with(const ScalarTerms& terms, const ScalarRows& rows) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  Real3 mean;
  for (int a = 0; a < 3; ++a) {
    const Real regular = sum_cells(
        "flow::mean_scalar_flux", RowRanges(terms.grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
          return low_face_flux<Scheme>(t, a, t.fields.value.layout()(i, j, k));
        });
    const Real cut = sum_each(
        "flow::mean_scalar_flux_rows", rows.links.count,
        KOKKOS_LAMBDA(Index row) { return cut_face_flux(t, r, a, row); });
    mean[a] = (regular + cut) / static_cast<Real>(terms.grid.number_of_cells());
  }
  return mean;
}

}  // namespace

Real sum_in_fluid(const ScalarFields& fields, const Field<Real>& value) {
  const ScalarFields f = fields;
  const Field<Real> c = value;
  const bool counts = !value.is_allocated();
  return sum_cells(
      "flow::sum_in_fluid", RowRanges(fields.state.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = f.state.layout()(i, j, k);
        if (f.state[p] == cell_state::solid) return 0.0;
        return static_cast<Real>(f.volume[p]) * (counts ? 1 : c[p]);
      });
}

ScalarSpread scalar_spread(const ScalarFields& fields, const Field<Real>& value) {
  const Real volume = sum_in_fluid(fields, Field<Real>());
  ScalarSpread spread;
  if (volume == 0) return spread;
  const Real mean = sum_in_fluid(fields, value) / volume;
  const Field<OpenFraction> state = fields.state;
  const Field<Real> c = value;
  spread.mean = mean;
  spread.largest = max_cells(
      "flow::scalar_spread", RowRanges(state.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        return state(i, j, k) == cell_state::solid ? 0.0 : Kokkos::abs(c(i, j, k) - mean);
      });
  return spread;
}

void fill_scalar_ghosts(const Field<Real>& value, const ScalarSides& sides) {
  fill_periodic_ghosts(value, sides.periodicity());
  for (int a = 0; a < 3; ++a)
    if (!sides.side[a][0].is_periodic) fill_side_ghosts(value, sides, a);
}

void add_wall_exchange(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& correction,
                       const Field<int>& owner, int bodies, ScatterSum& sums) {
  switch (terms.scheme) {
    case ScalarScheme::FirstUpwind:
      return add_exchange_with<FirstUpwindScheme>(terms, rows, correction, bodies, owner, sums);
    case ScalarScheme::SecondUpwind:
      return add_exchange_with<SecondUpwindScheme>(terms, rows, correction, bodies, owner, sums);
    case ScalarScheme::Koren:
      return add_exchange_with<KorenScheme>(terms, rows, correction, bodies, owner, sums);
  }
}

Real3 mean_scalar_flux(const ScalarTerms& terms, const ScalarRows& rows) {
  switch (terms.scheme) {
    case ScalarScheme::FirstUpwind:
      return mean_flux_with<FirstUpwindScheme>(terms, rows);
    case ScalarScheme::SecondUpwind:
      return mean_flux_with<SecondUpwindScheme>(terms, rows);
    case ScalarScheme::Koren:
      break;
  }
  return mean_flux_with<KorenScheme>(terms, rows);
}

}  // namespace peclet::flow
