#pragma once
// Particles, walls and the box they live in, advanced by substeps.
#include "dem/contact_solver.hpp"
#include "dem/domain.hpp"
#include "dem/materials.hpp"
#include "dem/particles.hpp"
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
  void forget_contacts() { solver_.forget(); }

  /// Advance by dt > 0. After an error the state is what it was.
  void step(Real dt);
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

 private:
  void require_ready(const char* caller) const;
  void advance(Real dt);
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
  SolverReport report_;
};

}  // namespace peclet::dem
