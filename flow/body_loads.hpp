#pragma once
// Force and torque of the fluid on every body: the momentum that the discrete equations of the fluid lost to
// it. Each term that links two fluid points cancels in the sum over the fluid; what remains is, per wall row,
//   viscous    the wall part of nu L (v + theta e), which acts at the wall,
//   pressure   (p at the wall cell) on faces whose neighbour along their own axis is closed,
// and is given to the body that owns the wall. In contact cells the pressure around them pushes two bodies
// apart. Advection hands nothing to walls, see advective_leak(). So
//   sum of forces = f N - rho / dt sum (u_new - u)   over the N fluid points, to rounding.
// What the body force gives to the rest of the fluid's volume comes on top, see flow/volume_defect.hpp.
//
// Torques are moments of the same terms about the centre of rotation, plus that of the transposed part of the
// viscous stress: mu n x Omega on a rigid no-slip wall with the normal n into the fluid. Its integral is
// -2 mu V Omega for a body of volume V in the fluid, and +2 mu V Omega for a cavity full of fluid. It has no
// resultant force on either.
#include <vector>

#include "core/scatter_sum.hpp"
#include "flow/contact_cells.hpp"
#include "flow/momentum.hpp"

namespace peclet::flow {

struct BodyLoad {
  Vec3 force, torque;
  Vec3 pressure_force, viscous_force;  // sum to force
};

/// Collects the loads of one step: viscous parts component by component, then the pressure.
class LoadCollector {
 public:
  void start(int number_of_bodies);
  /// correction: e of component c, ghosts filled.
  void add_momentum(int c, const MomentumTerms& terms, const SolidSampler& solid, const WallRows& fixed_rows,
                    const WallRows& moving_rows, const Field<Real>& correction);
  /// The pressure whose gradient acted in this step is  p + theta mu div F(u*), p the updated one; ghosts
  /// filled.
  void add_pressure(int c, const SolidSampler& solid, const WallRows& fixed_rows, const WallRows& moving_rows,
                    const Field<Real>& pressure, const Field<Real>& divergence, Real implicit_viscosity);
  void add_contact_pressure(int c, const SolidSampler& solid, const ContactCells& fixed_contacts,
                            const ContactCells& moving_contacts, const SurroundingPressure& surrounding);
  /// One load per body.
  std::vector<BodyLoad> finish();

 private:
  ScatterSum sums_;
  int bodies_ = 0;
};

}  // namespace peclet::flow
