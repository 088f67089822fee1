#include "flow/scalars.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/field_transfer.hpp"
#include "core/halo.hpp"
#include "flow/scalar_steady.hpp"
#include "flow/time_weights.hpp"

namespace peclet::flow {
namespace {

/// The walls of the scalar for kernels, as ScalarGeometry wants them.
const Array<ScalarWall>& walls_of(Scalar& scalar, int bodies) {
  std::vector<ScalarWall> walls(static_cast<std::size_t>(bodies) + 2, scalar.wall);
  for (std::size_t b = 0; b < scalar.walls.size() && b < static_cast<std::size_t>(bodies); ++b)
    if (scalar.walls[b]) walls[b + 2] = *scalar.walls[b];
  if (scalar.wall_of_owner.extent(0) != walls.size())
    scalar.wall_of_owner = Array<ScalarWall>("flow::scalar_walls", walls.size());
  const Kokkos::View<const ScalarWall*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host(walls.data(),
                                                                                         walls.size());
  Kokkos::deep_copy(scalar.wall_of_owner, host);
  return scalar.wall_of_owner;
}

/// Cells that became fluid have no past; solid cells of walls of given value take that value.
void start_cells(const ScalarGeometry& geometry, const Field<OpenFraction>& old_state,
                 const ScalarFields& fields) {
  const ScalarGeometry g = geometry;
  const Field<OpenFraction> old = old_state;
  const ScalarFields f = fields;
  for_each_cell(
      "flow::start_scalar_cells", RowRanges(geometry.solid.grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = f.state.layout()(i, j, k);
        if (f.state[p] == cell_state::solid) {
          const int owner = g.solid.owner[p];
          if (g.gives_value(owner)) f.value[p] = g.wall(owner).value;
        }
        if (f.state[p] != cell_state::solid && old[p] != cell_state::solid) return;
        f.previous[p] = f.value[p];
        f.gain[p] = 0;
      });
}

bool any_value_given(const ScalarRows& rows) {
  const ScalarRows r = rows;
  return max_each(
             "flow::any_value_given", rows.links.count, KOKKOS_LAMBDA(Index row) {
               bool any = false;
               for (int d = 0; d < ScalarRows::directions; ++d)
                 any = any || (r.links.is_wall(row, d) && r.coefficient(row, d) != 0);
               return any ? 1.0 : 0.0;
             }) > 0;
}

}  // namespace

void add_buoyant_change(const ScalarFields& fields, int axis, Real strength, Real ratio, Real reference,
                        const RowRanges& rows, const Field<Real>& residual) {
  const Field<Real> value = fields.value, previous = fields.previous, target = residual;
  for_each_cell(
      "flow::add_buoyancy", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = value.layout()(i, j, k), q = p - value.layout().stride(axis);
        const Real mean = 0.5 * (value[p] + value[q]);
        const Real change = mean - 0.5 * (previous[p] + previous[q]);
        target[p] += strength * (mean + ratio * change - reference);
      });
}

int Scalars::find(const std::string& name) const {
  for (int n = 0; n < count(); ++n)
    if ((*this)[n].name == name) return n;
  return -1;
}

int Scalars::add(const std::string& name, const ScalarSettings& settings) {
  const Layout layout(grid_.cells);
  if (scalars_.empty()) {
    predicted_ = Field<Real>("flow::scalar_predicted", layout);
    advected_ = Field<Real>("flow::scalar_advected", layout);
    residual_ = Field<Real>("flow::scalar_residual", layout);
    correction_ = Field<Real>("flow::scalar_correction", layout);
    old_state_ = Field<OpenFraction>("flow::scalar_old_state", layout);
    scratch_ = Array<Index>("flow::scalar_scratch", static_cast<std::size_t>(grid_.number_of_cells()));
    diffusion_solver_.emplace(layout);
    plan_ = SweepPlan(grid_.cells, Box{{0, 0, 0}, grid_.cells}, {true, true, true});
  }
  Scalar scalar;
  scalar.name = name;
  scalar.settings = settings;
  ScalarFields& f = scalar.fields;
  f.value = Field<Real>("flow::scalar_value", layout);
  f.previous = Field<Real>("flow::scalar_previous", layout);
  f.gain = Field<Real>("flow::scalar_gain", layout);
  f.predicted = predicted_;
  f.advected = advected_;
  f.state = Field<OpenFraction>("flow::scalar_state", layout);
  f.volume = Field<float>("flow::scalar_volume", layout);
  scalars_.push_back(scalar);
  return count() - 1;
}

void Scalars::set_wall(int n, const std::optional<int>& body, const ScalarWall& wall) {
  Scalar& scalar = (*this)[n];
  if (!body) {
    scalar.wall = wall;
    scalar.walls.clear();
  } else {
    const auto b = static_cast<std::size_t>(*body);
    if (scalar.walls.size() <= b) scalar.walls.resize(b + 1);
    scalar.walls[b] = wall;
  }
  scalar.geometry_stale = true;
}

void Scalars::geometry_changed() {
  for (Scalar& scalar : scalars_) scalar.geometry_stale = true;
}

void Scalars::take_sides(Scalar& scalar, const DomainSides& sides) const {
  constexpr const char* names[3][2] = {{"-x", "+x"}, {"-y", "+y"}, {"-z", "+z"}};
  for (int a = 0; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      ScalarSide& side = scalar.sides.side[a][s];
      const bool is_periodic = sides.is_periodic(a);
      if (side.is_periodic != is_periodic) scalar.geometry_stale = true;
      side.is_periodic = is_periodic;
      const bool needs_value = sides.side[a][s].kind == SideKind::Inflow;
      require_state(!needs_value || (side.is_given && side.condition == ScalarCondition::Value),
                    "step(): expected the value of scalar '" + scalar.name + "' on the inflow side '" +
                        names[a][s] + "', found none: call set_scalar_bc() with 'dirichlet'");
    }
}

void Scalars::fill(const Scalar& scalar, const Field<Real>& value) const {
  fill_scalar_ghosts(value, scalar.sides);
  if (scalar.extension.count == 0) return;
  extend_into_solid(scalar.extension, scalar.fields.state, value);
  fill_scalar_ghosts(value, scalar.sides);
}

void Scalars::prepare(const ScalarFlow& flow) {
  for (Scalar& scalar : scalars_) take_sides(scalar, flow.sides);
  for (Scalar& scalar : scalars_) {
    prepare(scalar, flow);
    const Real3& g = scalar.settings.mean_gradient;
    require_state(scalar.is_conservative || (g[0] == 0 && g[1] == 0 && g[2] == 0),
                  "step(): expected walls and sides of given flux only for scalar '" + scalar.name +
                      "', which has a mean gradient, found one of given value");
  }
}

void Scalars::prepare(Scalar& scalar, const ScalarFlow& flow) {
  if (!scalar.geometry_stale && !scalar.value_changed) return;
  ScalarFields& f = scalar.fields;
  if (scalar.geometry_stale) {
    const ScalarGeometry geometry{flow.solid, flow.open, scalar.sides, walls_of(scalar, flow.bodies)};
    Kokkos::deep_copy(old_state_.array(), f.state.array());
    classify_cells(geometry, f.state, f.volume);
    start_cells(geometry, old_state_, f);
    build_scalar_rows(geometry, f.state, f.volume, scratch_, scalar.rows);
    build_extension(geometry, f.state, scratch_, scalar.extension);
    scalar.is_conservative = !any_value_given(scalar.rows);
    scalar.geometry_stale = false;
  }
  if (scalar.value_changed) {
    Kokkos::deep_copy(f.previous.array(), f.value.array());
    f.gain.fill(0);
    scalar.previous_time_step = 0;
    scalar.value_changed = false;
  }
  fill(scalar, f.value);
  fill(scalar, f.previous);
}

void Scalars::restore_past(int n, Real previous_time_step) {
  Scalar& scalar = (*this)[n];
  scalar.previous_time_step = previous_time_step;
  scalar.value_changed = false;
  fill(scalar, scalar.fields.value);
  fill(scalar, scalar.fields.previous);
}

ScalarTerms Scalars::terms(const Scalar& scalar, const ScalarFlow& flow, Real time_step) const {
  ScalarTerms terms;
  terms.grid = grid_;
  terms.fields = scalar.fields;
  terms.carrier = flow.carrier;
  terms.open = flow.open;
  terms.sides = scalar.sides;
  terms.sdf = flow.solid.sdf;
  terms.scheme = scalar.settings.scheme;
  terms.time_step = time_step;
  if (scalar.previous_time_step > 0) {
    const Real ratio = time_step / scalar.previous_time_step, share = share_of_past(ratio);
    terms.step_ratio = share * ratio;
    terms.implicit_weight = 1 - share * (1 - second_order_weight);
  }
  terms.diffusivity = scalar.settings.diffusivity;
  terms.source = scalar.settings.source;
  terms.source_field = scalar.source_field;
  terms.mean_gradient = scalar.settings.mean_gradient;
  return terms;
}

void Scalars::advance(const ScalarFlow& flow, Real time_step) {
  prepare(flow);
  for (Scalar& scalar : scalars_) advance(scalar, flow, time_step);
}

void Scalars::advance(Scalar& scalar, const ScalarFlow& flow, Real time_step) {
  const ScalarTerms t = terms(scalar, flow, time_step);
  predict_scalar(t, plan_, scalar.rows, flow.cut_cells);
  fill(scalar, predicted_);
  compute_scalar_residual(t, plan_, scalar.rows, flow.cut_cells, residual_);
  Real left_over = 0;
  const bool has_diffusion = scalar.settings.diffusivity > 0;
  if (has_diffusion) left_over = solve_diffusion(scalar, t, correction_);
  const Field<Real>& correction = has_diffusion ? correction_ : residual_;
  fill_periodic_ghosts(correction, scalar.sides.periodicity(), 1);
  sums_.reset(flow.bodies + givers_besides_bodies);
  add_wall_exchange(t, scalar.rows, correction, flow.solid.owner, flow.bodies, sums_);
  scalar.given = sums_.totals();
  apply_scalar_correction(t, plan_, correction, left_over);
  std::swap(scalar.fields.value, scalar.fields.previous);
  fill(scalar, scalar.fields.value);
  scalar.previous_time_step = time_step;
}

Real Scalars::solve_diffusion(Scalar& scalar, const ScalarTerms& t, const Field<Real>& correction) {
  const ScalarFields& f = scalar.fields;
  DomainSides sides;  // the rows express the sides
  for (int a = 0; a < 3; ++a)
    for (int high = 0; high < 2; ++high)
      if (!scalar.sides.side[a][high].is_periodic) sides.side[a][high].kind = SideKind::Slip;
  constexpr int cell_values = -1;
  const ViscousSystem system{grid_,       sides,
                             cell_values, t.implicit_weight * t.time_step * t.diffusivity,
                             &plan_,      RowRanges(grid_.cells),
                             f.state,     scalar.rows.links,
                             {}};
  const Real scale = scalar_spread(f, f.value).largest;
  const Real balance = scalar.is_conservative ? sum_in_fluid(f, residual_) : 0;
  Real residual_sum = 0;
  scalar.report = diffusion_solver_->solve(system, residual_, correction, scalar.settings.tolerance, scale,
                                           scalar.settings.iteration_limit, residual_sum);
  require_state(std::isfinite(residual_sum), "step(): scalar '" + scalar.name +
                                                 "' met a value that is not finite; the time step may be "
                                                 "too large");
  if (!scalar.is_conservative) return 0;
  return (balance - sum_in_fluid(f, correction)) / sum_in_fluid(f, Field<Real>());
}

void Scalars::add_buoyancy(int c, Real time_step, const RowRanges& rows, const Field<Real>& residual) const {
  const Real strength = -time_step * buoyancy_.expansion * buoyancy_.gravity[c];
  if (strength == 0) return;
  const Scalar& scalar = (*this)[buoyancy_.scalar];
  const Real ratio = scalar.previous_time_step > 0 ? 0.5 * time_step / scalar.previous_time_step : 0;
  add_buoyant_change(scalar.fields, c, strength, ratio, buoyancy_.reference, rows, residual);
}

void Scalars::solve_steady(int n, const ScalarFlow& flow) {
  /// Passes over the limited fluxes, and how far each solves the equations that it has made linear.
  constexpr int most_passes = 100;
  constexpr Real reduction_per_pass = 1e-3;
  constexpr Real rounding = 1e-6, imbalance = 1e-7, smallest = 1e-300;
  prepare(flow);
  Scalar& scalar = (*this)[n];
  ScalarFields& f = scalar.fields;
  ScalarTerms t = terms(scalar, flow, 1);
  SteadySystem system(f.value.layout());
  t.time_step = system.set(t, scalar.rows);
  const Real volume = sum_in_fluid(f, Field<Real>());
  scalar.report = {};
  const Real root = std::sqrt(static_cast<Real>(grid_.number_of_cells()));
  Real first = 0;
  for (int pass = 0;; ++pass) {
    compute_steady_residual(t, plan_, scalar.rows, residual_);
    const Real norm = norm_of(residual_);
    require_state(std::isfinite(norm),
                  "solve_scalar_steady(): scalar '" + scalar.name + "' met a value that is not finite");
    const ScalarSpread spread = scalar_spread(f, f.value);
    first = std::max(first, norm);
    const Real size = std::max({first, root * (spread.largest + rounding * std::abs(spread.mean)), smallest});
    require_state(!scalar.is_conservative || std::abs(sum_in_fluid(f, residual_)) <= imbalance * root * size,
                  "solve_scalar_steady(): expected sources and fluxes of scalar '" + scalar.name +
                      "' that balance, or a value on a wall or side, found neither: no steady state");
    scalar.report.residual = norm / size;
    scalar.report.converged = scalar.report.residual <= scalar.settings.tolerance;
    if (scalar.report.converged || pass == most_passes || norm == 0) break;
    scalar.report.iterations +=
        system.solve(residual_, correction_, reduction_per_pass, scalar.settings.iteration_limit);
    add_in_fluid(f, correction_, scalar.is_conservative ? -sum_in_fluid(f, correction_) / volume : 0);
    fill(scalar, f.value);
  }
  correction_.fill(0);
  sums_.reset(flow.bodies + givers_besides_bodies);
  add_wall_exchange(steady_terms(t), scalar.rows, correction_, flow.solid.owner, flow.bodies, sums_);
  scalar.given = sums_.totals();
  scalar.value_changed = true;
}

Real3 Scalars::mean_flux(int n, const ScalarFlow& flow) const {
  return mean_scalar_flux(terms((*this)[n], flow, 1), (*this)[n].rows);
}

std::size_t Scalars::bytes() const {
  if (scalars_.empty()) return 0;
  const std::size_t cells = predicted_.array().extent(0);
  std::size_t total =
      cells * (4 * sizeof(Real) + sizeof(OpenFraction) + sizeof(Index)) + diffusion_solver_->bytes();
  for (const Scalar& scalar : scalars_) {
    const std::size_t rows = scalar.rows.source.extent(0);
    total += cells * (3 * sizeof(Real) + sizeof(OpenFraction) + sizeof(float)) +
             rows * (3 * ScalarRows::directions + 2) * sizeof(Real) +
             static_cast<std::size_t>(scalar.rows.links.bytes());
    if (scalar.source_field.is_allocated()) total += cells * sizeof(Real);
  }
  return total;
}

}  // namespace peclet::flow
