// What the flow solver does for the scalars that it carries.
#include "core/error.hpp"
#include "flow/solver.hpp"

namespace peclet::flow {

ScalarFlow Solver::scalar_flow(const FaceVector<Real>& carrier) const {
  return {boundary_.solid(), boundary_.open(), carrier, boundary_.cut_cells(), sides_, bodies_.count()};
}

void Solver::carry_scalars(bool old_velocity_counts) {
  if (scalars_.count() == 0) return;
  if (old_velocity_counts) {  // the mean of old and new: second order in time
    extrapolate_velocity(velocity_plan_, velocity_rows_, velocity_, previous_, -1, extrapolated_);
    fill_velocity(extrapolated_, 1);
  }
  scalars_.advance(scalar_flow(old_velocity_counts ? extrapolated_ : velocity_), settings_.time_step);
}

void Solver::prepare_scalars() {
  bring_geometry_up_to_date();
  fill_velocity(velocity_, 1);
  scalars_.prepare(scalar_flow(velocity_));
}

void Solver::advance_scalars() {
  prepare_scalars();
  carry_scalars(false);
}

void Solver::solve_scalar_steady(int scalar) {
  prepare_scalars();
  require_state(boundary_.cut_cells().count == 0,
                "solve_scalar_steady(): expected bodies at rest, found moving ones");
  scalars_.solve_steady(scalar, scalar_flow(velocity_));
}

Real3 Solver::mean_scalar_flux(int scalar) {
  prepare_scalars();
  return scalars_.mean_flux(scalar, scalar_flow(velocity_));
}

}  // namespace peclet::flow
