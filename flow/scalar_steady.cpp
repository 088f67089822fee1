#include "flow/scalar_steady.hpp"

#include <cmath>

#include "core/halo.hpp"
#include "flow/scalar_fluxes.hpp"

namespace peclet::flow {
namespace {

/// A neighbour's part of the linearisation: B e = diagonal e - sum weight e_neighbour, per unit of dt.
struct NeighborWeight {
  Real diagonal = 0, weight = 0;
};

/// Upwind advection: outflow is the volume flux out of the cell through this face over the spacing.
KOKKOS_INLINE_FUNCTION NeighborWeight upwind_weight(Real outflow, bool has_neighbor, bool keeps_own_value) {
  if (outflow >= 0) return {outflow, 0};
  if (keeps_own_value) return {outflow, 0};
  return {0, has_neighbor ? -outflow : 0};
}

/// Direction d of row p, all in one.
KOKKOS_INLINE_FUNCTION NeighborWeight row_weight(const ScalarTerms& t, const ScalarRows& rows, Index row,
                                                 int d) {
  const Index p = rows.links.face(row);
  const Real h = t.grid.spacing[d / 2];
  const ScalarFace face = scalar_face(t, p, d);
  const Index step = t.fields.state.layout().stride(d / 2), q = d % 2 ? p + step : p - step;
  const bool has_neighbor = !face.at_side && t.fields.state[q] != cell_state::solid;
  const Real outflow = (d % 2 ? face.volume_flux : -face.volume_flux) / h;
  NeighborWeight result = upwind_weight(outflow, has_neighbor, face.at_side && !face.has_value);
  const Real volume = t.fields.volume[p];
  const Real diffusion = t.diffusivity * rows.coefficient(row, d) / (h * h);
  result.diagonal = result.diagonal / volume + diffusion;
  result.weight = result.weight / volume + (has_neighbor ? diffusion : 0);
  return result;
}

/// The same for a cell on the regular grid.
KOKKOS_INLINE_FUNCTION NeighborWeight regular_weight(const ScalarTerms& t, Index p, int d) {
  const int axis = d / 2;
  const Real h = t.grid.spacing[axis];
  const Index face = d % 2 ? p + t.fields.state.layout().stride(axis) : p;
  const Real flux = t.open[axis][face] * open_fraction_unit * t.carrier[axis][face] / h;
  NeighborWeight result = upwind_weight(d % 2 ? flux : -flux, true, false);
  const Real diffusion = t.diffusivity / (h * h);
  result.diagonal += diffusion;
  result.weight += diffusion;
  return result;
}

void compute_diagonal(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& diagonal) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  const Field<Real> result = diagonal;
  for_each_cell(
      "flow::steady_diagonal", RowRanges(terms.grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = result.layout()(i, j, k);
        Real sum = 0;
        for (int d = 0; d < ScalarRows::directions; ++d) sum += regular_weight(t, p, d).diagonal;
        result[p] = t.fields.state[p] == cell_state::solid ? 0 : sum;
      });
  for_each(
      "flow::steady_diagonal_rows", rows.links.count, KOKKOS_LAMBDA(Index row) {
        Real sum = 0;
        for (int d = 0; d < ScalarRows::directions; ++d) sum += row_weight(t, r, row, d).diagonal;
        result[r.links.face(row)] = sum;
      });
}

void apply_linearisation(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& diagonal,
                         const Field<Real>& e, const Field<Real>& image) {
  const ScalarTerms t = terms;
  const ScalarRows r = rows;
  const Field<Real> here = diagonal, from = e, result = image;
  for_each_cell(
      "flow::steady_operator", RowRanges(terms.grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = from.layout()(i, j, k);
        Real neighbors = 0;
        for (int d = 0; d < ScalarRows::directions; ++d) {
          const Index step = from.layout().stride(d / 2);
          neighbors += regular_weight(t, p, d).weight * from[d % 2 ? p + step : p - step];
        }
        result[p] =
            t.fields.state[p] == cell_state::solid ? 0 : t.time_step * (here[p] * from[p] - neighbors);
      });
  for_each(
      "flow::steady_operator_rows", rows.links.count, KOKKOS_LAMBDA(Index row) {
        const Index p = r.links.face(row);
        Real neighbors = 0;
        for (int d = 0; d < ScalarRows::directions; ++d) {
          const Real weight = row_weight(t, r, row, d).weight;
          const Index step = from.layout().stride(d / 2);
          if (weight != 0) neighbors += weight * from[d % 2 ? p + step : p - step];
        }
        result[p] = t.time_step * (here[p] * from[p] - neighbors);
      });
}

/// Largest value, at least 0.
Real largest_of(const Field<Real>& field) {
  const Field<Real> values = field;
  return max_cells(
      "flow::steady_largest", RowRanges(field.layout().cells),
      KOKKOS_LAMBDA(int i, int j, int k) { return values(i, j, k); });
}

Real product(const Field<Real>& a, const Field<Real>& b) {
  const Field<Real> x = a, y = b;
  return sum_cells(
      "flow::steady_product", RowRanges(a.layout().cells),
      KOKKOS_LAMBDA(int i, int j, int k) { return x(i, j, k) * y(i, j, k); });
}

/// result = x + a y + b z
void combine(const Field<Real>& result, const Field<Real>& x, Real a, const Field<Real>& y, Real b,
             const Field<Real>& z) {
  const Field<Real> target = result, first = x, second = y, third = z;
  for_each_cell(
      "flow::steady_combine", RowRanges(result.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = target.layout()(i, j, k);
        target[p] = first[p] + a * second[p] + b * third[p];
      });
}

/// result = x / (dt diagonal)
void divide_by_diagonal(const Field<Real>& result, const Field<Real>& x, const Field<Real>& diagonal,
                        Real time_step) {
  const Field<Real> target = result, from = x, here = diagonal;
  for_each_cell(
      "flow::steady_divide", RowRanges(result.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = target.layout()(i, j, k);
        target[p] = here[p] > 0 ? from[p] / (time_step * here[p]) : 0.0;
      });
}

/// gain = value - predicted: dt A(c).
void keep_advection(const ScalarFields& fields) {
  const ScalarFields f = fields;
  for_each_cell(
      "flow::keep_advection", RowRanges(fields.state.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = f.state.layout()(i, j, k);
        f.gain[p] = f.state[p] == cell_state::solid ? 0 : f.value[p] - f.predicted[p];
      });
}

}  // namespace

Real norm_of(const Field<Real>& field) { return std::sqrt(product(field, field)); }

void add_in_fluid(const ScalarFields& fields, const Field<Real>& correction, Real shift) {
  const ScalarFields f = fields;
  const Field<Real> e = correction;
  for_each_cell(
      "flow::add_in_fluid", RowRanges(fields.state.layout().cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = f.state.layout()(i, j, k);
        if (f.state[p] != cell_state::solid) f.value[p] += e[p] + shift;
      });
}

ScalarTerms steady_terms(const ScalarTerms& terms) {
  ScalarTerms steady = terms;
  steady.fields.predicted = terms.fields.value;
  steady.fields.previous = terms.fields.value;
  steady.step_ratio = 1;
  steady.implicit_weight = 0;
  return steady;
}

void compute_steady_residual(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                             const Field<Real>& residual) {
  ScalarTerms first = terms;
  first.step_ratio = 0;
  predict_scalar(first, plan, rows, CutCells());
  keep_advection(terms.fields);
  compute_scalar_residual(steady_terms(terms), plan, rows, CutCells(), residual);
}

SteadySystem::SteadySystem(const Layout& layout)
    : diagonal_("flow::steady_diagonal", layout),
      remainder_("flow::steady_remainder", layout),
      shadow_("flow::steady_shadow", layout),
      search_("flow::steady_search", layout),
      scaled_("flow::steady_scaled", layout),
      image_("flow::steady_image", layout),
      image_of_remainder_("flow::steady_image_of_remainder", layout) {}

Real SteadySystem::set(const ScalarTerms& terms, const ScalarRows& rows) {
  terms_ = terms;
  rows_ = rows;
  compute_diagonal(terms_, rows_, diagonal_);
  const Real largest = largest_of(diagonal_);
  terms_.time_step = largest > 0 ? 1 / largest : 1;
  return terms_.time_step;
}

void SteadySystem::apply(const Field<Real>& e, const Field<Real>& result) const {
  fill_periodic_ghosts(e, terms_.sides.periodicity(), 1);
  apply_linearisation(terms_, rows_, diagonal_, e, result);
}

int SteadySystem::solve(const Field<Real>& residual, const Field<Real>& correction, Real reduction,
                        int limit) const {
  Kokkos::deep_copy(remainder_.array(), residual.array());
  Kokkos::deep_copy(shadow_.array(), residual.array());
  search_.fill(0);
  image_.fill(0);
  correction.fill(0);
  const Real target = reduction * norm_of(residual);
  Real rho = 1, alpha = 1, omega = 1;
  int iterations = 0;
  while (iterations < limit) {
    const Real next = product(shadow_, remainder_);
    const Real beta = next / rho * (alpha / omega);
    if (next == 0 || !std::isfinite(beta)) break;
    rho = next;
    combine(search_, remainder_, beta, search_, -beta * omega, image_);
    divide_by_diagonal(scaled_, search_, diagonal_, terms_.time_step);
    apply(scaled_, image_);
    alpha = rho / product(shadow_, image_);
    if (!std::isfinite(alpha)) break;
    combine(correction, correction, alpha, scaled_, 0, scaled_);
    combine(remainder_, remainder_, -alpha, image_, 0, image_);
    ++iterations;
    if (norm_of(remainder_) <= target) break;
    divide_by_diagonal(scaled_, remainder_, diagonal_, terms_.time_step);
    apply(scaled_, image_of_remainder_);
    const Real squares = product(image_of_remainder_, image_of_remainder_);
    omega = squares > 0 ? product(image_of_remainder_, remainder_) / squares : 0;
    if (omega == 0 || !std::isfinite(omega)) break;
    combine(correction, correction, omega, scaled_, 0, scaled_);
    combine(remainder_, remainder_, -omega, image_of_remainder_, 0, image_of_remainder_);
    if (norm_of(remainder_) <= target) break;
  }
  return iterations;
}

}  // namespace peclet::flow
