// Solver: sides of the box, bodies, and what follows when they change.
#include "flow/diagnostics.hpp"
#include "flow/solver.hpp"
#include "flow/stopwatch.hpp"

namespace peclet::flow {

void Solver::set_scene(const Scene& scene, bool periodic_images) {
  bodies_ = Bodies(scene, grid_, periodic_images, sides_.periodicity());
  requested_poses_.assign(static_cast<std::size_t>(bodies_.count()), std::nullopt);
  loads_.clear();
  for (int n = 0; n < scalars_.count(); ++n) scalars_[n].given.clear();
  geometry_stale_ = true;
  built_ = false;
}

void Solver::set_sampled_solid(const Field<Real>& distance) {
  samples_ = distance;
  build_geometry(false);
}

void Solver::build_geometry(bool keep_flow) {
  take_requested_sides();
  take_requested_poses();
  if (samples_.is_allocated()) fill_mirrored_ghosts(samples_, sides_);
  boundary_.build(bodies_, samples_, wall_friction());
  geometry_rebuilt();
  if (!keep_flow) {
    for (int c = 0; c < 3; ++c) velocity_[c].fill(0);
    pressure_.fill(0);
    force_unbalanced_ = true;
    balanced_force_ = {0, 0, 0};
  }
  potential_.fill(0);
  built_ = true;
  geometry_stale_ = false;
  wall_velocity_stale_ = false;
  friction_stale_ = true;
  velocity_changed();
}

WallFriction Solver::wall_friction() const {
  return {settings_.viscosity / settings_.density, settings_.time_step};
}

/// Bodies about to move so far at once that the flow in their slits says nothing about what they uncover.
std::vector<int> Solver::bodies_that_leap() {
  constexpr Real leap = 0.5;  // spacings
  std::vector<int> result;
  for (int b = 0; b < bodies_.count(); ++b) {
    const auto& pose = requested_poses_[static_cast<std::size_t>(b)];
    if (pose &&
        !(bodies_.displacement(b, pose->translation, pose->rotation) <= leap * grid_.smallest_spacing()))
      result.push_back(b);
  }
  return result;
}

void Solver::take_requested_poses() {
  for (int b = 0; b < bodies_.count(); ++b) {
    auto& requested = requested_poses_[static_cast<std::size_t>(b)];
    if (requested) bodies_.set_pose(b, requested->translation, requested->rotation);
    requested.reset();
  }
}

void Solver::geometry_rebuilt() {
  pressure_solver_.set_open_fractions(boundary_.open(), boundary_.rows());
  const Periodicity periodic = sides_.periodicity();
  plan_ = SweepPlan(grid_.cells, boundary_.rows().box, periodic.axis);
  for (int c = 0; c < 3; ++c) {
    velocity_rows_[c] = velocity_rows(boundary_.rows(), sides_, grid_.cells, c);
    velocity_plan_[c] = SweepPlan(grid_.cells, velocity_rows_[c].box, periodic.axis);
  }
  scalars_.geometry_changed();
  for (int c = 0; c < 3; ++c)
    fixed_fluid_points_[c] =
        count_fluid_points(velocity_rows_[c], boundary_.open()[c]) + boundary_.covered_points(c);
  subtract_covered_points();
}

void Solver::subtract_covered_points() {
  for (int c = 0; c < 3; ++c) fluid_points_[c] = fixed_fluid_points_[c] - boundary_.covered_points(c);
}

void Solver::velocity_changed() {
  if (!built_) return;
  mask_solid_points(RowRanges(grid_.cells), boundary_.open(), velocity_);
  fill_outflow_points(velocity_, sides_);
  fill_velocity(velocity_, 1);
  impose_walls(velocity_);
  fill_velocity(velocity_, 1);
  for (int c = 0; c < 3; ++c) Kokkos::deep_copy(previous_[c].array(), velocity_[c].array());
  previous_time_step_ = 0;
}

void Solver::impose_body_motion() {
  for (int c = 0; c < 3; ++c) {
    impose_body_velocity(boundary_.body_faces(c), velocity_[c]);
    impose_body_velocity(boundary_.body_faces(c), previous_[c]);
  }
}

void Solver::impose_walls(const FaceVector<Real>& velocity) const {
  for (int c = 0; c < 3; ++c) {
    impose_body_velocity(boundary_.body_faces(c), velocity[c]);
    impose_wall_velocity(boundary_.slits(c), velocity[c]);
  }
}

void Solver::fill_velocity(const FaceVector<Real>& velocity, int width, bool stops_backflow) const {
  for (int c = 0; c < 3; ++c)
    fill_velocity_ghosts(velocity, c, sides_, width, stops_backflow, boundary_.ghost_axes());
}

void Solver::set_side(int axis, int high, const DomainSide& side) {
  requested_sides_.side[axis][high] = side;
  sides_stale_ = true;
}

void Solver::take_requested_sides() {
  if (!sides_stale_) return;
  requested_sides_.require_pairs();
  if (!requested_sides_.same_kinds(sides_)) {
    boundary_ = ImmersedBoundary(grid_, requested_sides_);
    pressure_solver_ = PressureSolver(grid_, requested_sides_.pressure_sides());
    bodies_.set_domain(requested_sides_.periodicity());
    built_ = false;
  }
  sides_ = requested_sides_;
  sides_stale_ = false;
}

Clock Solver::clock() const {
  Clock clock{time_, previous_time_step_, steps_, force_unbalanced_, {}};
  for (int n = 0; n < scalars_.count(); ++n)
    clock.scalar_time_steps.push_back(scalars_[n].previous_time_step);
  return clock;
}

std::vector<StoredField> Solver::stored_fields() {
  prepare_scalars();
  const Box cells{{0, 0, 0}, grid_.cells};
  const std::string names[3] = {"u", "v", "w"};
  std::vector<StoredField> fields;
  for (int c = 0; c < 3; ++c) {
    Box points = cells;
    points.high[c] += sides_.side[c][1].kind == SideKind::Outflow;
    fields.push_back({names[c], velocity_[c], points});
    fields.push_back({names[c] + "_previous", previous_[c], points});
  }
  fields.push_back({"p", pressure_, cells});
  fields.push_back({"potential", potential_, cells});
  for (int n = 0; n < scalars_.count(); ++n) {
    const ScalarFields& scalar = scalars_[n].fields;
    const std::string name = "scalar_" + scalars_[n].name;
    fields.push_back({name, scalar.value, cells});
    fields.push_back({name + "_previous", scalar.previous, cells});
    fields.push_back({name + "_gain", scalar.gain, cells});
  }
  return fields;
}

void Solver::restore_bodies(const std::vector<BodyMotion>& motions) {
  bool same = has_geometry();
  for (std::size_t b = 0; b < motions.size(); ++b) {
    same = same && motions[b] == bodies_.motion(static_cast<int>(b));
    bodies_.restore(static_cast<int>(b), motions[b]);
    requested_poses_[b].reset();
  }
  if (!same) build_geometry(true);
}

void Solver::restore_clock(const Clock& clock) {
  fill_velocity(velocity_, 1);
  time_ = clock.time;
  previous_time_step_ = clock.previous_time_step;
  steps_ = clock.steps;
  force_unbalanced_ = clock.force_unbalanced;
  balanced_force_ = settings_.body_force;
  for (int n = 0; n < scalars_.count(); ++n)
    scalars_.restore_past(n, clock.scalar_time_steps[static_cast<std::size_t>(n)]);
}

void Solver::set_pose(int body, Vec3 translation, Quaternion rotation) {
  requested_poses_[static_cast<std::size_t>(body)] = Pose{translation, rotation, bodies_[body].pose.scale};
  geometry_stale_ = true;
}

void Solver::set_motion(int body, const Twist& twist, const std::optional<Vec3>& center) {
  const BodyMotion before = bodies_.motion(body);
  bodies_.set_twist(body, twist);
  if (center) bodies_.pin_center(body, *center);
  if (!(bodies_.motion(body) == before)) wall_velocity_stale_ = true;
}

void Solver::promote_moved_bodies() {
  bool promoted = false;
  for (int b = 0; b < bodies_.count(); ++b) {
    if (bodies_[b].dynamic || (!requested_poses_[static_cast<std::size_t>(b)] && !bodies_.moves(b))) continue;
    bodies_.set_dynamic(b);
    promoted = true;
  }
  if (!promoted || !built_) return;
  boundary_.build(bodies_, samples_, wall_friction());
  geometry_rebuilt();
}

void Solver::update_geometry() {
  const Stopwatch watch(geometry_time_);
  take_requested_sides();
  promote_moved_bodies();
  if (!built_) return build_geometry(true);
  // faces about to be uncovered take the velocity of the body that covers them
  if (wall_velocity_stale_) boundary_.refresh_face_velocity(bodies_);
  impose_body_motion();
  const std::vector<int> leaping = bodies_that_leap();
  take_requested_poses();
  for (int c = 0; c < 3; ++c) {
    covered_points_.remember(c, boundary_.moving_rows(c));
    for (const Field<Real>& u : {velocity_[c], previous_[c]})
      to_velocity_with_friction(boundary_.slits(c), u);
  }
  boundary_.update(bodies_, pressure_, wall_friction(), hydrostatic_force());
  pressure_solver_.update_open_fractions(boundary_.changed());
  if (!boundary_.changed().empty()) scalars_.geometry_changed();
  subtract_covered_points();
  for (int c = 0; c < 3; ++c)
    covered_points_.hand_on(c, boundary_.solid(), boundary_.open()[c], bodies_.count(), velocity_[c],
                            previous_[c]);
  for (const int b : leaping)
    for (int c = 0; c < 3; ++c)
      for (const Field<Real>& u : {velocity_[c], previous_[c]})
        impose_wall_velocity_where_uncovered(boundary_.former_slits(c), b, boundary_.open()[c], u);
  for (int c = 0; c < 3; ++c)
    for (const Field<Real>& u : {velocity_[c], previous_[c]})
      to_velocity_without_friction(boundary_.slits(c), u);
  impose_body_motion();
  geometry_stale_ = false;
  wall_velocity_stale_ = false;
  friction_stale_ = true;
}

void Solver::bring_geometry_up_to_date() {
  take_requested_sides();
  if (geometry_stale_ || !built_) update_geometry();
}

void Solver::refresh_wall_velocity() {
  promote_moved_bodies();
  boundary_.refresh_velocity(bodies_);
  impose_body_motion();
  wall_velocity_stale_ = false;
  friction_stale_ = true;
}

}  // namespace peclet::flow
