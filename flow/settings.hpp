#pragma once
// What a user chooses: fluid properties, schemes, tolerances.
#include "core/types.hpp"

namespace peclet::flow {

/// Value of the transported velocity on a control-volume face.
enum class AdvectionScheme {
  None,          // Stokes flow
  SecondUpwind,  // linear extrapolation from the upwind side
  Koren,         // third-order upwind-biased, limited [Koren1993]
  Central,       // mean of both sides
};

struct Settings {
  Real density = 1;
  Real viscosity = 0.1;  // dynamic
  Real time_step = 50;
  Real3 body_force{0, 0, 0};  // per unit volume
  AdvectionScheme advection = AdvectionScheme::None;
  bool implicit_advection = false;
  bool prescribed_motion = false;  // of all bodies: friction follows their mean velocity in the step
  Real velocity_tolerance = 1e-8;  // largest momentum residual over largest velocity
  int velocity_iteration_limit = 200;
  Real pressure_tolerance = 1e-6;  // residual over divergence before the projection, 2-norms
  int pressure_iteration_limit = 200;
};

/// What the friction of walls depends on besides the geometry.
struct WallFriction {
  Real viscosity = 0;  // kinematic
  Real time_step = 0;

  /// nu dt
  Real area() const { return viscosity * time_step; }
  bool operator==(const WallFriction&) const = default;
};

/// How one implicit solve went.
struct SolverReport {
  int iterations = 0;
  Real residual = 0;  // relative, as the tolerance it is compared with
  bool converged = true;
};

}  // namespace peclet::flow
