#include "flow/solver.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "flow/diagnostics.hpp"
#include "flow/projection.hpp"
#include "flow/stopwatch.hpp"

namespace peclet::flow {
namespace {

/// Share of the rotational pressure update that a flow bears at any viscosity: all of it in a closed box,
/// less with Outflow sides, and the less the more axes have them, because of the edges where they meet
/// [GuermondMinevShen2006]. Slits are openings too, whose flow viscosity does not see: with the whole term
/// the cells beside them are unstable above nu dt = h^2.
Real viscous_rotational_share(const DomainSides& sides, bool has_slits) {
  int openings = has_slits;
  for (const auto& side : sides.side)
    openings += side[0].kind == SideKind::Outflow || side[1].kind == SideKind::Outflow;
  return 1.0 / (1 + openings);
}

/// Courant number from which implicit advection, extrapolated in time, needs damping.
constexpr Real extrapolation_limit = 0.5;
/// Divergence that counts as zero, relative to velocity / spacing: what rounding leaves.
constexpr Real divergence_rounding = 1e-13;
/// Largest divergence after the projection, relative to velocity / spacing.
constexpr Real divergence_limit = 3e-9;

/// Residual of the pressure that balances the body force, times the share of the force that it leaves to
/// drive the fluid: where there is none, all stays at rest to rounding.
constexpr Real balance_tolerance = 1e-6, rest_tolerance = 1e-12;
/// Velocity that counts as rest, relative to what the body force would give the fluid in a step if no
/// pressure balanced it: the tolerance of the viscous solve then is above what rounding leaves of the two.
constexpr Real rest_velocity = 1e-6;

}  // namespace

Solver::Solver(const Grid& grid)
    : grid_(grid),
      boundary_(grid, sides_),
      velocity_("flow::velocity", Layout(grid.cells)),
      previous_("flow::previous_velocity", Layout(grid.cells)),
      extrapolated_("flow::extrapolated_velocity", Layout(grid.cells)),
      pressure_("flow::pressure", Layout(grid.cells)),
      potential_("flow::potential", Layout(grid.cells)),
      divergence_("flow::divergence", Layout(grid.cells)),
      residual_("flow::residual", Layout(grid.cells)),
      viscous_solver_(Layout(grid.cells)),
      pressure_solver_(grid, PressureSides{}),
      scalars_(grid) {}

void Solver::change_settings(const Settings& settings) { settings_ = settings; }

MomentumTerms Solver::momentum_terms() const {
  MomentumTerms terms;
  terms.grid = grid_;
  terms.extrapolated = extrapolated_;
  terms.velocity = velocity_;
  terms.previous = previous_;
  terms.pressure = pressure_;
  terms.time_step = settings_.time_step;
  terms.density = settings_.density;
  terms.kinematic_viscosity = settings_.viscosity / settings_.density;
  if (previous_time_step_ > 0) {
    const Real ratio = settings_.time_step / previous_time_step_;
    const Real share = extrapolation_share() * share_of_past(ratio);
    terms.step_ratio = share * ratio;
    terms.implicit_weight = 1 - share * (1 - second_order_weight);
    if (settings_.prescribed_motion) terms.wall_weight = 0.5 * share + terms.implicit_weight * (1 - share);
  }
  for (int c = 0; c < 3; ++c) terms.acceleration[c] = settings_.body_force[c] / settings_.density;
  terms.scheme = settings_.advection;
  return terms;
}

/// How much of the second-order extrapolation a step takes: all of it in explicit runs and at small Courant
/// numbers; less beyond, towards Euler's method, so that the deferred correction damps all waves.
Real Solver::extrapolation_share() const {
  if (!is_advection_implicit()) return 1;
  const Real courant = courant_number();
  return courant > extrapolation_limit ? extrapolation_limit / courant : 1;
}

void Solver::step() {
  double time_of_step = geometry_time_;
  times_ = {};
  {
    const Stopwatch watch(time_of_step);
    advance();
  }
  times_.geometry = geometry_time_;
  times_.rest = time_of_step - times_.sum();
  geometry_time_ = 0;
}

void Solver::advance() {
  if (boundary_.has_moving_walls() && boundary_.friction() != wall_friction()) geometry_stale_ = true;
  bring_geometry_up_to_date();
  if (wall_velocity_stale_) refresh_wall_velocity();

  scalars_.prepare(scalar_flow(velocity_));
  balance_body_force();
  MomentumTerms terms = momentum_terms();
  bodies_.average_twists(terms.wall_weight);
  if (friction_stale_) boundary_.refresh_friction(bodies_);
  const Real velocity_scale = extrapolate_velocity(velocity_plan_, velocity_rows_, velocity_, previous_,
                                                   terms.step_ratio, extrapolated_);
  impose_walls(extrapolated_);
  courant_number_bound_ =
      velocity_scale * terms.time_step * (1 / grid_.spacing[0] + 1 / grid_.spacing[1] + 1 / grid_.spacing[2]);
  // viscosity that reaches further than a cell in a step keeps backflow in check by itself
  const Real cell = grid_.smallest_spacing();
  const bool is_viscous = terms.kinematic_viscosity * terms.time_step >= cell * cell;
  const bool stops_backflow = terms.scheme != AdvectionScheme::None && !is_viscous;
  fill_velocity(extrapolated_, 2, stops_backflow);
  fill_pressure_ghosts(pressure_, sides_.pressure_sides(), 1, boundary_.ghost_axes());

  return_advective_leak(terms);

  predict_velocity(terms, velocity_scale);
  std::swap(velocity_, previous_);  // velocity_ is now the predicted one
  project_velocity(velocity_scale, is_viscous, terms.implicit_weight);
  impose_body_motion();
  fill_velocity(velocity_, 1);
  carry_scalars(terms.step_ratio > 0 && boundary_.cut_cells().count == 0);

  friction_stale_ = bodies_.any_accelerates();
  bodies_.end_step();
  previous_time_step_ = settings_.time_step;
  time_ += settings_.time_step;
  ++steps_;
}

/// The pressure that starts a flow: what of the body force is a gradient accelerates nothing, so that a
/// closed tank stays at rest. psi from  div(o grad psi) = div(o f),  p += psi. Later the same for what the
/// force changes by along axes with sides; along periodic ones it drives the flow.
void Solver::balance_body_force() {
  Real3 force{0, 0, 0};
  for (int a = 0; a < 3; ++a)
    if (force_unbalanced_ || !sides_.is_periodic(a))
      force[a] = settings_.body_force[a] - (force_unbalanced_ ? 0 : balanced_force_[a]);
  force_unbalanced_ = false;
  balanced_force_ = settings_.body_force;
  if (force[0] == 0 && force[1] == 0 && force[2] == 0) return;
  const Stopwatch watch(times_.pressure);
  const Real largest =
      compute_force_divergence(grid_, boundary_.rows(), boundary_.open(), force, divergence_);
  if (largest == 0) return;
  PressureSettings limits;
  limits.max_iterations = settings_.pressure_iteration_limit;
  limits.relative_tolerance = balance_tolerance;
  pressure_solver_.solve(divergence_, potential_, limits);
  const Real driving_share =
      largest_driving_force(grid_, boundary_.rows(), boundary_.open(), force, potential_) /
      std::hypot(force[0], force[1], force[2]);
  if (driving_share < 1) {
    limits.relative_tolerance = std::max(rest_tolerance, balance_tolerance * driving_share);
    pressure_solver_.solve(divergence_, potential_, limits);
  }
  add_potential(boundary_.rows(), potential_, pressure_);
  potential_.fill(0);
}

/// Gradient of the pressure in fluid at rest: the balanced force along axes with sides.
Real3 Solver::hydrostatic_force() const {
  Real3 force{0, 0, 0};
  for (int a = 0; a < 3; ++a)
    if (!sides_.is_periodic(a)) force[a] = balanced_force_[a];
  return force;
}

void Solver::return_advective_leak(MomentumTerms& terms) {
  const Stopwatch watch(times_.momentum);
  for (int c = 0; c < 3; ++c) {
    const Real leak = advective_leak(c, terms, boundary_.fixed_rows(c), boundary_.moving_rows(c));
    if (leak != 0) terms.acceleration[c] += leak / fluid_points(c);
  }
}

void Solver::predict_velocity(const MomentumTerms& terms, Real largest_velocity) {
  load_collector_.start(bodies_.count());
  Real velocity_scale = largest_velocity;
  for (const Real force : settings_.body_force)
    velocity_scale =
        std::max(velocity_scale, rest_velocity * std::abs(force) * terms.time_step / terms.density);
  velocity_report_ = {};
  for (int c = 0; c < 3; ++c) {
    const WallRows &fixed_rows = boundary_.fixed_rows(c), &moving_rows = boundary_.moving_rows(c);
    const Field<Real>& correction = divergence_;  // free until the projection
    ViscousSystem system{grid_,
                         sides_,
                         c,
                         terms.implicit_weight * terms.time_step * terms.kinematic_viscosity,
                         &velocity_plan_[c],
                         velocity_rows_[c],
                         boundary_.open()[c],
                         fixed_rows,
                         moving_rows};
    system.revision = boundary_.revision();
    if (is_advection_implicit()) {
      system.carrier = terms.extrapolated;
      system.advection_step = terms.time_step;
    }
    {
      const Stopwatch watch(times_.momentum);
      compute_momentum_residual(c, terms, velocity_plan_[c], velocity_rows_[c], fixed_rows, moving_rows,
                                residual_);
      compute_slit_residual(c, terms, boundary_.slits(c), residual_);
      if (scalars_.has_buoyancy()) scalars_.add_buoyancy(c, terms.time_step, velocity_rows_[c], residual_);
      predict_slits(boundary_.slits(c), velocity_[c], residual_);
    }
    Real left_over = 0;
    {
      const Stopwatch watch(times_.viscous);
      const SolverReport report =
          viscous_solver_.solve(system, residual_, correction, settings_.velocity_tolerance, velocity_scale,
                                settings_.velocity_iteration_limit, left_over);
      require_state(
          std::isfinite(left_over),
          "step(): the momentum solve met a value that is not finite; the time step may be too large");
      velocity_report_.iterations = std::max(velocity_report_.iterations, report.iterations);
      velocity_report_.residual = std::max(velocity_report_.residual, report.residual);
      velocity_report_.converged = velocity_report_.converged && report.converged;
    }
    {
      const Stopwatch watch(times_.loads);
      fill_correction_ghosts(correction, c, sides_, 1, boundary_.ghost_axes());
      load_collector_.add_momentum(c, terms, boundary_.solid(), fixed_rows, moving_rows, correction);
    }
    apply_correction(velocity_plan_[c], velocity_rows_[c], terms.step_ratio, velocity_[c], correction,
                     left_over == 0 ? 0 : left_over / fluid_points(c), previous_[c]);
  }
}

void Solver::project_velocity(Real velocity_scale, bool is_viscous, Real implicit_weight) {
  for (int c = 0; c < 3; ++c) {
    impose_body_velocity(boundary_.body_faces(c), velocity_[c]);
    impose_predicted_velocity(boundary_.slits(c), velocity_[c]);
  }
  fill_velocity(velocity_, 1);
  require_balanced_inflow(velocity_scale);
  const Real largest =
      compute_divergence(grid_, plan_, boundary_.rows(), boundary_.open(), boundary_.cut_cells(), sides_,
                         boundary_.solid().sdf, velocity_, divergence_);
  {
    const Stopwatch watch(times_.pressure);
    const Real scale = std::max(velocity_scale / grid_.smallest_spacing(), largest);
    PressureSettings limits;
    limits.max_iterations = settings_.pressure_iteration_limit;
    limits.relative_tolerance = settings_.pressure_tolerance;
    limits.residual_limit = divergence_limit * scale;
    if (largest * limits.relative_tolerance < divergence_rounding * scale)
      limits.relative_tolerance = largest > 0 ? std::min(0.9, divergence_rounding * scale / largest) : 0.9;
    const SolveReport report = pressure_solver_.solve(divergence_, potential_, limits);
    require_state(std::isfinite(report.residual),
                  "step(): the pressure solve met a value that is not finite");
    pressure_report_ = {report.iterations, report.residual, report.converged};
  }
  ProjectionUpdate update;
  update.density_over_time_step = settings_.density / settings_.time_step;
  update.implicit_viscosity = implicit_weight * settings_.viscosity;
  if (is_viscous) {
    update.implicit_viscosity *= viscous_rotational_share(sides_, boundary_.has_slits());
    // cells that a moving body is about to uncover would be unstable
    update.weighs_open_part = !bodies_.any_dynamic();
  }
  update.potential = potential_;
  update.divergence = divergence_;
  apply_projection(grid_, plan_, boundary_.rows(), boundary_.open(), sides_, update, velocity_, pressure_);
  fill_pressure_ghosts(pressure_, sides_.pressure_sides(), 1, boundary_.ghost_axes());
  fill_pressure_ghosts(divergence_, sides_.pressure_sides(), 1, boundary_.ghost_axes());
  {
    const Stopwatch watch(times_.loads);
    const SurroundingPressure surrounding{grid_,
                                          sides_,
                                          boundary_.open(),
                                          pressure_,
                                          divergence_,
                                          update.implicit_viscosity,
                                          hydrostatic_force()};
    for (int c = 0; c < 3; ++c) {
      load_collector_.add_pressure(c, boundary_.solid(), boundary_.fixed_rows(c), boundary_.moving_rows(c),
                                   pressure_, divergence_, update.implicit_viscosity);
      load_collector_.add_contact_pressure(c, boundary_.solid(), boundary_.fixed_contacts(c),
                                           boundary_.moving_contacts(c), surrounding);
    }
    loads_ = load_collector_.finish();
    add_force_on_defects();
    for (const BodyLoad& load : loads_)
      require_state(std::isfinite(dot(load.force, load.force) + dot(load.torque, load.torque)),
                    "step(): a load on a body is not finite; the time step may be too small or too large");
  }
}

void Solver::add_force_on_defects() {
  force_on_defects_ = {};
  const Vec3 force{settings_.body_force[0], settings_.body_force[1], settings_.body_force[2]};
  if (dot(force, force) == 0) return;
  const std::vector<VolumeDefect>& defects = volume_defects_.find(boundary_, sides_, bodies_.count());
  for (std::size_t b = 0; b < defects.size(); ++b) {
    const VolumeDefect& defect = defects[b];
    const Vec3 share{force.x * defect.volume.x, force.y * defect.volume.y, force.z * defect.volume.z};
    force_on_defects_ += share;
    if (b == loads_.size()) continue;
    loads_[b].force += share;
    loads_[b].pressure_force += share;
    for (int c = 0; c < 3; ++c) loads_[b].torque += force[c] * defect.leverage[c];
  }
}

const std::vector<BodyLoad>& Solver::loads() const {
  require_state(steps_ > 0, "hydro_force_torque_reaction(): call step() first");
  return loads_;
}

Real Solver::largest_open_divergence() {
  bring_geometry_up_to_date();
  fill_velocity(velocity_, 1);
  compute_divergence(grid_, plan_, boundary_.rows(), boundary_.open(), boundary_.cut_cells(), sides_,
                     boundary_.solid().sdf, velocity_, divergence_);
  return divergence_in_open_cells(boundary_.rows(), boundary_.open(), divergence_);
}

Vec3 Solver::momentum_change() const {
  require_state(previous_time_step_ > 0, "momentum_change(): call step() first");
  const Real scale = settings_.density * grid_.cell_volume() / previous_time_step_;
  Vec3 change;
  for (int c = 0; c < 3; ++c)
    change[c] = scale * sum_of_change(velocity_rows_[c], boundary_.open()[c], velocity_[c], previous_[c]);
  return change;
}

Real Solver::courant_number() const {
  return settings_.time_step * largest_courant_rate(boundary_.rows(), boundary_.open(), velocity_,
                                                    grid_.spacing, scalars_.count() > 0);
}

void Solver::require_balanced_inflow(Real velocity_scale) const {
  if (!sides_.any(SideKind::Inflow) || sides_.any(SideKind::Outflow)) return;
  const Real net = net_inflow(grid_, sides_, boundary_.solid().sdf);
  const Real largest_area = grid_.cell_volume() * static_cast<Real>(grid_.number_of_cells()) /
                            std::min({grid_.extent(0), grid_.extent(1), grid_.extent(2)});
  constexpr Real rounding = 1e-10;
  require_state(
      std::abs(net) <= rounding * velocity_scale * largest_area,
      "step(): expected an outflow side, or inflows that balance each other, found a net inflow of " +
          std::to_string(net));
}

Real Solver::largest_velocity() const { return largest_component(boundary_.rows(), velocity_); }

void Solver::sample_distance(const Field<Real>& distance, const Field<int>& owner) {
  sample_all_bodies(grid_, bodies_.geometry(), bodies_.count(), samples_, distance, owner);
}

Index Solver::image_overlap_cells() {
  return count_image_overlap(grid_, bodies_.geometry(), bodies_.count());
}

std::size_t Solver::bytes() const {
  const std::size_t cells = velocity_.x.array().extent(0);
  return cells * (9 + 4) * sizeof(Real) + viscous_solver_.bytes() + pressure_solver_.bytes() +
         boundary_.bytes() + scalars_.bytes();
}

}  // namespace peclet::flow
