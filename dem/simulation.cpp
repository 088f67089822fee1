#include "dem/simulation.hpp"

#include <string>

#include "core/error.hpp"
#include "dem/contact_laws.hpp"
#include "dem/integrator.hpp"

namespace peclet::dem {
namespace {

/// For a census, where nothing moves.
void place_bodies_at_rest(const ParticleArrays& particles, const Bodies& bodies) {
  for_each(
      "dem::place_bodies_at_rest", particles.count, KOKKOS_LAMBDA(Index n) {
        Body body;
        body.position = particles.position(n);
        bodies(n) = body;
      });
}

void write_identity(Index count, const Array<Index>& place) {
  for_each("dem::write_identity", count, KOKKOS_LAMBDA(Index n) { place(n) = n; });
}

Real largest_overlap(const Array<Contact>& contacts, Index count) {
  return max_each("dem::largest_overlap", count, KOKKOS_LAMBDA(Index n) { return -contacts(n).gap; });
}

void require_finite_vector(Vec3 v, const char* argument) {
  for (int axis = 0; axis < 3; ++axis) require_finite(v[axis], argument);
}

}  // namespace

void Simulation::set_gravity(Vec3 acceleration) {
  require_finite_vector(acceleration, "gravity");
  gravity_ = acceleration;
}

void Simulation::set_domain(Vec3 origin, Vec3 extent) {
  require_finite_vector(origin, "origin");
  for (int axis = 0; axis < 3; ++axis) require_non_negative(extent[axis], "extent");
  domain_.origin = origin;
  domain_.extent = extent;
}

void Simulation::set_periodic(bool x, bool y, bool z) {
  domain_.periodic[0] = x;
  domain_.periodic[1] = y;
  domain_.periodic[2] = z;
}

void Simulation::set_iterations(const SolverIterations& iterations) {
  require(iterations.position >= 0, "pos", "a count of at least 0", iterations.position);
  require(iterations.velocity >= 0, "vel", "a count of at least 0", iterations.velocity);
  iterations_ = iterations;
}

ContactScene Simulation::scene(Real dt) const {
  return {
      particles_.arrays(), particles_.shape_radius(), walls_.arrays(), materials_.table(), domain_, dt, {}};
}

void Simulation::require_ready(const char* caller) const {
  particles_.require_valid_state();
  constexpr char names[] = {'x', 'y', 'z'};
  const Real diameter = 2 * particles_.largest_radius();
  for (int axis = 0; axis < 3; ++axis) {
    if (!domain_.periodic[axis]) continue;
    const std::string message = std::string(caller) + ": periodic along " + names[axis];
    require_state(domain_.extent[axis] > 0, message + ", but the domain has no extent there (set_domain)");
    require_state(diameter <= domain_.extent[axis],
                  message + ", expected an extent of at least the largest diameter " +
                      std::to_string(diameter) + ", found " + std::to_string(domain_.extent[axis]));
  }
}

void Simulation::advance(Real dt) {
  const ParticleArrays& particles = particles_.arrays();
  if (bodies_.extent(0) < particles.position.extent(0))
    bodies_ = Bodies("dem.bodies", particles.position.extent(0));
  wrap_positions(particles, domain_);
  predict_motion(particles, gravity_, dt, bodies_);
  ContactScene contact_scene = scene(dt);
  report_ = solver_.solve(contact_scene, bodies_, iterations_);
  const bool is_finite = is_finite_motion(bodies_, particles.count);
  if (!is_finite) solver_.forget();
  require_state(is_finite, "step: expected finite positions and velocities, found others; is dt = " +
                               std::to_string(dt) + " too large for the forces?");
  accept_motion(bodies_, domain_, dt == 0, particles);
  soft_solver_.forget();
  last_dt_ = 0;
}

void Simulation::require_elasticity() const {
  const int of_particles = find_material_without_elasticity(scene(0));
  const int id = of_particles >= 0 ? of_particles : walls_.find_material_without_elasticity(materials_);
  require_state(id < 0,
                "step_hertz: material " + std::to_string(id) +
                    " has no Young's modulus (set_hertz_material); planes have material 0, and so have "
                    "scene walls until set_wall_material_id");
}

SoftTimeScales Simulation::soft_time_scales() const {
  require_ready("soft_time_scales");
  require_elasticity();
  return dem::soft_time_scales(scene(0));
}

void Simulation::advance_soft(Real dt, Real skin) {
  const ParticleArrays& particles = particles_.arrays();
  if (bodies_.extent(0) < particles.position.extent(0))
    bodies_ = Bodies("dem.bodies", particles.position.extent(0));
  place_at_middle(particles, gravity_, dt, bodies_);
  ContactScene soft_scene = scene(dt);
  soft_scene.margin = skin;
  const ListOrigin origin{particles_.revision(), walls_.revision(), materials_.revision(), skin, domain_};
  const ParticleLoads loads = soft_solver_.solve(soft_scene, origin, bodies_);
  predict_motion(particles, gravity_, loads, dt, bodies_);
  const bool is_finite = is_finite_motion(bodies_, particles.count);
  if (!is_finite) soft_solver_.forget();
  require_state(is_finite, "step_hertz: expected finite positions and velocities, found others; is dt = " +
                               std::to_string(dt) + " too large for the forces?");
  accept_motion(bodies_, Domain{}, false, particles);
  last_dt_ = dt;
  time_ += dt;
}

void Simulation::step_hertz(Real dt, int substeps, Real skin) {
  require_positive(dt, "dt");
  require(substeps >= 0, "substeps", "a count of at least 0", substeps);
  require(skin > 0 && skin <= 2, "skin_frac", "a number above 0, at most 2", skin);
  const SoftTimeScales scales = soft_time_scales();
  require(
      dt <= scales.rayleigh, "dt",
      "at most the Rayleigh time of the smallest and stiffest particle, " + std::to_string(scales.rayleigh),
      dt);
  solver_.forget();
  for (int k = 0; k < substeps; ++k) advance_soft(dt, skin);
  wrap_positions(particles_.arrays(), domain_);
}

void Simulation::step(Real dt) {
  require_positive(dt, "dt");
  require_ready("step");
  advance(dt);
  time_ += dt;
}

void Simulation::relax(int n) {
  require(n >= 0, "n", "a count of at least 0", n);
  require_ready("relax");
  for (int k = 0; k < n; ++k) advance(0);
}

ContactCensus Simulation::census() const {
  require_ready("contacts");
  const ParticleArrays& particles = particles_.arrays();
  if (particles.count == 0) return {};
  wrap_positions(particles, domain_);
  const Bodies bodies("dem.bodies", static_cast<std::size_t>(particles.count));
  place_bodies_at_rest(particles, bodies);
  ContactScene contact_scene = scene(0);
  ContactFinder finder;
  ContactKeys keys;
  finder.find(contact_scene, bodies, keys);
  const Array<Index> place("dem.place", static_cast<std::size_t>(keys.count));
  write_identity(keys.count, place);
  Array<Contact> contacts;
  build_contacts(contact_scene, keys, place, {}, contacts);
  return {keys.count, largest_overlap(contacts, keys.count)};
}

}  // namespace peclet::dem
