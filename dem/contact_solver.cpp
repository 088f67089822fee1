#include "dem/contact_solver.hpp"

#include "dem/contact_laws.hpp"

namespace peclet::dem {
namespace {

constexpr Real velocity_tolerance = 1e-6;  // change in a sweep, over the largest speed
constexpr Real position_tolerance = 1e-6;  // overlap over radius

/// Speed that velocities are judged by.
Real largest_speed(const Bodies& bodies, Index count, Real dt) {
  return max_each(
      "dem::largest_speed", count, KOKKOS_LAMBDA(Index n) {
        return Kokkos::max(norm(bodies(n).velocity), norm(bodies(n).acceleration) * dt);
      });
}

void resolve_impacts(const Sweep& sweep, const ContactOrder& order, const ImpactRule& rule) {
  for_each_contact(
      "dem::resolve_impacts", order, KOKKOS_LAMBDA(Index n) {
        sweep.residuals(n) = resolve_impact(sweep.contacts(n), sweep.bodies, rule) ? 1 : 0;
      });
}

void close_contacts(const Sweep& sweep, Index count, Real dt) {
  for_each(
      "dem::close_contacts", count,
      KOKKOS_LAMBDA(Index n) { close_contact(sweep.contacts(n), sweep.bodies, dt); });
}

void apply_carried_forces(const Sweep& sweep, const ContactOrder& order) {
  for_each_contact(
      "dem::apply_carried_forces", order,
      KOKKOS_LAMBDA(Index n) { apply_carried_force(sweep.contacts(n), sweep.bodies); });
}

void update_sustained_forces(const Sweep& sweep, const ContactOrder& order, Real dt) {
  for_each_contact(
      "dem::update_sustained_forces", order, KOKKOS_LAMBDA(Index n) {
        sweep.residuals(n) = update_sustained_force(sweep.contacts(n), sweep.bodies, dt);
      });
}

void separate_overlaps(const Sweep& sweep, const ContactOrder& order) {
  for_each_contact(
      "dem::separate_overlaps", order,
      KOKKOS_LAMBDA(Index n) { sweep.residuals(n) = separate(sweep.contacts(n), sweep.bodies); });
}

Real largest_residual(const Sweep& sweep, Index count) {
  const Array<Real> residuals = sweep.residuals;
  return max_each("dem::largest_residual", count, KOKKOS_LAMBDA(Index n) { return residuals(n); });
}

/// First the impacts, one after the other until none is left, then the forces of closed contacts all
/// together.
void solve_velocities(const Sweep& sweep, const ContactOrder& order, Real speed, Real dt, int sweeps,
                      SolverReport& report) {
  const ImpactRule rule{dt, 1e-9 * speed};
  bool has_impacts = true;
  while (has_impacts && report.impact_sweeps < sweeps) {
    resolve_impacts(sweep, order, rule);
    ++report.impact_sweeps;
    has_impacts = largest_residual(sweep, order.count) > 0;
  }
  close_contacts(sweep, order.count, dt);
  apply_carried_forces(sweep, order);
  report.velocity_residual = 1;
  while (report.velocity_residual > velocity_tolerance && report.force_sweeps < sweeps) {
    update_sustained_forces(sweep, order, dt);
    ++report.force_sweeps;
    report.velocity_residual = speed > 0 ? largest_residual(sweep, order.count) / speed : 0;
  }
}

void solve_positions(const Sweep& sweep, const ContactOrder& order, int sweeps, SolverReport& report) {
  report.position_residual = 1;
  while (report.position_residual > position_tolerance && report.position_sweeps < sweeps) {
    separate_overlaps(sweep, order);
    ++report.position_sweeps;
    report.position_residual = largest_residual(sweep, order.count);
  }
}

}  // namespace

void ContactSolver::forget() { history_.keys.rows = 0; }

Sweep ContactSolver::prepare(ContactScene& scene, const Bodies& bodies) {
  finder_.find(scene, bodies, keys_);
  order_ = coloring_.arrange(keys_, scene.particles);
  build_contacts(scene, keys_, coloring_.place(), history_, contacts_);
  if (residuals_.extent(0) < contacts_.extent(0))
    residuals_ = Array<Real>("dem.residuals", contacts_.extent(0));
  return {contacts_, bodies, residuals_};
}

SolverReport ContactSolver::solve(ContactScene& scene, const Bodies& bodies,
                                  const SolverIterations& iterations) {
  SolverReport report;
  Kokkos::Timer timer;
  const Sweep sweep = prepare(scene, bodies);
  Kokkos::fence("dem::solve");
  report.search_seconds = timer.seconds();
  if (order_.count > 0 && scene.dt > 0 && iterations.velocity > 0) {
    const Real speed = largest_speed(bodies, scene.particles.count, scene.dt);
    solve_velocities(sweep, order_, speed, scene.dt, iterations.velocity, report);
  }
  report.velocity_seconds = timer.seconds() - report.search_seconds;
  if (order_.count > 0) solve_positions(sweep, order_, iterations.position, report);
  report.position_seconds = timer.seconds() - report.search_seconds - report.velocity_seconds;
  if (scene.dt > 0) record_history(keys_, contacts_, scene.dt, history_);
  return report;
}

}  // namespace peclet::dem
