#pragma once
// Incompressible flow around fixed and moving bodies on a staggered grid: owns the fields, and step() reads
// as the scheme of flow/README.md.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flow/bodies.hpp"
#include "flow/body_loads.hpp"
#include "flow/covered_points.hpp"
#include "flow/domain_sides.hpp"
#include "flow/immersed_boundary.hpp"
#include "flow/momentum.hpp"
#include "flow/pressure_solver.hpp"
#include "flow/scalars.hpp"
#include "flow/settings.hpp"
#include "flow/viscous_solver.hpp"
#include "flow/volume_defect.hpp"

namespace peclet::flow {

/// Wall time of the parts of the last step, in seconds. Geometry counts from the end of the step before.
struct StepTimes {
  double geometry = 0, momentum = 0, viscous = 0, pressure = 0, loads = 0, rest = 0;

  double sum() const { return geometry + momentum + viscous + pressure + loads + rest; }
};

/// Where the time scheme stands.
struct Clock {
  double time = 0;
  Real previous_time_step = 0;  // 0: the next step has no past
  long steps = 0;
  bool force_unbalanced = true;
  std::vector<Real> scalar_time_steps;  // previous_time_step of every scalar
};

/// A field of the state and the points of it that are unknowns.
struct StoredField {
  std::string name;
  Field<Real> field;
  Box box;
};

class Solver {
 public:
  explicit Solver(const Grid& grid);

  const Grid& grid() const { return grid_; }
  const Settings& settings() const { return settings_; }
  void change_settings(const Settings& settings);

  // sides of the box, all periodic at first
  void set_side(int axis, int high, const DomainSide& side);
  const DomainSides& requested_sides() const { return requested_sides_; }

  // geometry
  void set_scene(const Scene& scene, bool periodic_images);
  void set_sampled_solid(const Field<Real>& distance);
  /// Sample everything anew; keep_flow: keep velocity and pressure where a point stays fluid.
  void build_geometry(bool keep_flow);
  void set_pose(int body, Vec3 translation, Quaternion rotation);
  void set_motion(int body, const Twist& twist, const std::optional<Vec3>& center);
  void update_geometry();
  /// Sides and bodies have been sampled and are up to date.
  bool has_geometry() const { return built_ && !geometry_stale_ && !sides_stale_; }
  void refresh_wall_velocity();
  int number_of_bodies() const { return bodies_.count(); }
  const Bodies& bodies() const { return bodies_; }

  // time
  void step();
  double time() const { return time_; }
  long number_of_steps() const { return steps_; }

  // scalars
  Scalars& scalars() { return scalars_; }
  const Scalars& scalars() const { return scalars_; }
  /// Advance the scalars alone, carried by the present velocity; step() does this with the flow.
  void advance_scalars();
  /// Walls, states and ghosts of the scalars as the present geometry wants them.
  void prepare_scalars();
  Real3 mean_scalar_flux(int scalar);
  /// The steady state of a scalar in the present velocity; bodies must rest.
  void solve_scalar_steady(int scalar);

  // results
  const std::vector<BodyLoad>& loads() const;
  const SolverReport& velocity_report() const { return velocity_report_; }
  const SolverReport& pressure_report() const { return pressure_report_; }
  const StepTimes& times() const { return times_; }
  Real largest_open_divergence();
  /// Largest over the cells of dt sum_a |u_a| / h_a.
  Real courant_number() const;
  /// Not less than courant_number() was before the last step.
  Real courant_number_bound() const { return courant_number_bound_; }
  Real largest_velocity() const;
  /// Density / dt times the velocity change in the last step, summed over the fluid points, times the cell
  /// volume.
  Vec3 momentum_change() const;
  /// What the body force gave in the last step to the fluid beyond that at fluid points.
  Vec3 force_on_defects() const { return force_on_defects_; }
  /// Number of fluid points of velocity component c.
  Real fluid_points(int c) const { return fluid_points_[c]; }

  const FaceVector<Real>& velocity() const { return velocity_; }
  const Field<Real>& pressure() const { return pressure_; }
  const FaceVector<OpenFraction>& open() const { return boundary_.open(); }
  /// Signed distance and nearest body of every cell, evaluated from the scene.
  void sample_distance(const Field<Real>& distance, const Field<int>& owner);
  /// Cells that only a periodic image other than the unshifted one makes solid.
  Index image_overlap_cells();

  /// The pressure was written from outside: it balances the body force.
  void pressure_changed() {
    force_unbalanced_ = false;
    balanced_force_ = settings_.body_force;
  }
  /// State that a run needs to go on as if it had not stopped.
  Clock clock() const;
  std::vector<StoredField> stored_fields();
  /// Puts the bodies back and samples them; then the stored fields are to be overwritten, and last
  /// restore_clock() called.
  void restore_bodies(const std::vector<BodyMotion>& motions);
  void restore_clock(const Clock& clock);

  /// The velocity fields were written from outside.
  void velocity_changed();
  std::size_t bytes() const;

 private:
  void advance();
  void balance_body_force();
  Real3 hydrostatic_force() const;
  void return_advective_leak(MomentumTerms& terms);
  void predict_velocity(const MomentumTerms& terms, Real largest_velocity);
  void add_force_on_defects();
  void project_velocity(Real velocity_scale, bool is_viscous, Real implicit_weight);
  /// Closed faces in the state move with their body.
  void impose_body_motion();
  /// nu dt, on which the slits depend.
  WallFriction wall_friction() const;
  /// All faces whose centre is solid move with their body.
  void impose_walls(const FaceVector<Real>& velocity) const;
  void take_requested_sides();
  void bring_geometry_up_to_date();
  void require_balanced_inflow(Real velocity_scale) const;
  void fill_velocity(const FaceVector<Real>& velocity, int width, bool stops_backflow = false) const;
  std::vector<int> bodies_that_leap();
  void take_requested_poses();
  void promote_moved_bodies();
  void geometry_rebuilt();
  void subtract_covered_points();
  MomentumTerms momentum_terms() const;
  bool is_advection_implicit() const {
    return settings_.implicit_advection && settings_.advection != AdvectionScheme::None;
  }
  Real extrapolation_share() const;
  ScalarFlow scalar_flow(const FaceVector<Real>& carrier) const;
  void carry_scalars(bool old_velocity_counts);

  Grid grid_;
  DomainSides sides_, requested_sides_;
  Settings settings_;
  Bodies bodies_;
  std::vector<std::optional<Pose>> requested_poses_;
  ImmersedBoundary boundary_;
  SweepPlan plan_;
  RowRanges velocity_rows_[3];  // points of each component
  SweepPlan velocity_plan_[3];
  Real fluid_points_[3] = {0, 0, 0}, fixed_fluid_points_[3] = {0, 0, 0};  // without moving bodies
  Real3 balanced_force_{0, 0, 0};  // the body force for which balance_body_force() was last called
  bool geometry_stale_ = true, force_unbalanced_ = true, sides_stale_ = false, wall_velocity_stale_ = false,
       friction_stale_ = true, built_ = false;

  FaceVector<Real> velocity_, previous_, extrapolated_;
  Field<Real> pressure_, potential_, divergence_, residual_, samples_;
  ViscousSolver viscous_solver_;
  PressureSolver pressure_solver_;
  Scalars scalars_;
  LoadCollector load_collector_;
  CoveredPoints covered_points_;
  std::vector<BodyLoad> loads_;
  VolumeDefects volume_defects_;
  Vec3 force_on_defects_;
  SolverReport velocity_report_, pressure_report_;
  StepTimes times_;
  double geometry_time_ = 0;  // since the last step
  double time_ = 0;
  long steps_ = 0;
  Real previous_time_step_ = 0, courant_number_bound_ = 0;
};

}  // namespace peclet::flow
