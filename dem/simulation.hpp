#pragma once
// Particles, walls and the box they live in, advanced by substeps.
#include "dem/contact_solver.hpp"
#include "dem/domain.hpp"
#include "dem/materials.hpp"
#include "dem/particles.hpp"
#include "dem/soft_contacts.hpp"
#include "dem/walls.hpp"

namespace peclet::dem {

/// Contacts of the present state.
struct ContactCensus {
  Index number_of_contacts = 0;  // pairs and walls closer than the margin
  Real largest_overlap = 0;      // a length
};

class Simulation {
 public:
  explicit Simulation(Index capacity) : particles_(capacity) {}

  void set_gravity(Vec3 acceleration);
  /// Extent zero: unbounded along that axis.
  void set_domain(Vec3 origin, Vec3 extent);
  void set_periodic(bool x, bool y, bool z);
  void set_iterations(const SolverIterations& iterations);
  /// After the setters of the particles that make the last substep's contacts meaningless.
  void forget_contacts() {
    solver_.forget();
    soft_solver_.forget();
  }

  /// What the contacts of the last substep hand on to the next one.
  std::vector<CarriedForce> carried_forces() const { return solver_.carried_forces(); }
  void set_carried_forces(std::vector<CarriedForce> carried) {
    solver_.set_carried_forces(std::move(carried), particles_.count());
  }

  /// Advance by dt > 0 with rigid contacts. After an error the state is what it was.
  void step(Real dt);
  /// Advance by substeps of length dt > 0 with elastic contacts; the neighbour list reaches skin radii beyond
  /// the surfaces. After an error the state is that of the last substep before it.
  void step_hertz(Real dt, int substeps, Real skin);
  /// What dt has to be short against in step_hertz.
  SoftTimeScales soft_time_scales() const;
  /// Push overlapping particles apart n times; velocities stay, time stands still.
  void relax(int n);

  Particles& particles() { return particles_; }
  const Particles& particles() const { return particles_; }
  Walls& walls() { return walls_; }
  const Walls& walls() const { return walls_; }
  Materials& materials() { return materials_; }
  const Materials& materials() const { return materials_; }
  const Domain& domain() const { return domain_; }
  Vec3 gravity() const { return gravity_; }
  Real time() const { return time_; }
  const SolverIterations& iterations() const { return iterations_; }

  ContactCensus census() const;
  /// How the last substep went, and its contacts.
  const SolverReport& report() const { return report_; }
  const ContactSolver& solver() const { return solver_; }
  /// Contacts of the last substep of step_hertz; null where the last substep was another.
  const SoftContacts* soft_contacts() const { return last_dt_ > 0 ? &soft_solver_.contacts() : nullptr; }
  Real last_soft_dt() const { return last_dt_; }

 private:
  void require_ready(const char* caller) const;
  void require_elasticity() const;
  void advance(Real dt);
  void advance_soft(Real dt, Real skin);
  ContactScene scene(Real dt) const;

  Particles particles_;
  Walls walls_;
  Materials materials_;
  Domain domain_;
  Vec3 gravity_;
  SolverIterations iterations_;
  Real time_ = 0;
  Bodies bodies_;
  ContactSolver solver_;
  SoftContactSolver soft_solver_;
  SolverReport report_;
  Real last_dt_ = 0;  // of step_hertz, where it was the last step
};

}  // namespace peclet::dem
