#pragma once
// Impulses and forces at all contacts of one substep, then removal of what overlap is left.
#include "dem/contact_coloring.hpp"
#include "dem/contact_detection.hpp"

namespace peclet::dem {

/// Caps on the sweeps over all contacts; a tolerance ends them earlier.
struct SolverIterations {
  int position = 20;
  int velocity = 50;  // 0: contacts leave velocities alone
};

struct SolverReport {
  int impact_sweeps = 0, force_sweeps = 0, position_sweeps = 0;
  Real velocity_residual = 0;  // change of the relative velocity in the last sweep, over the largest speed
  Real position_residual = 0;  // largest overlap before the last sweep, in radii
  Real search_seconds = 0, velocity_seconds = 0, position_seconds = 0;
};

/// What a sweep over all contacts works on.
struct Sweep {
  Array<Contact> contacts;
  Bodies bodies;
  Array<Real> residuals;  // of each contact in the last sweep
};

class ContactSolver {
 public:
  /// Finds the contacts of a substep and lets them act on the bodies.
  SolverReport solve(ContactScene& scene, const Bodies& bodies, const SolverIterations& iterations);
  /// What the last substep carried means nothing to the next one.
  void forget();
  std::vector<CarriedForce> carried_forces() const { return dem::carried_forces(history_); }
  void set_carried_forces(std::vector<CarriedForce> carried, Index particles) {
    history_ = history_of(std::move(carried), particles);
  }

  /// Of the last substep, in solving order.
  const Array<Contact>& contacts() const { return contacts_; }
  const ContactOrder& order() const { return order_; }

 private:
  Sweep prepare(ContactScene& scene, const Bodies& bodies);

  ContactFinder finder_;
  ContactColoring coloring_;
  ContactKeys keys_;
  ContactHistory history_;
  Array<Contact> contacts_;
  Array<Real> residuals_;
  ContactOrder order_;
};

}  // namespace peclet::dem
