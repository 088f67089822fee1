#include "dem/diagnostics.hpp"

#include <algorithm>

namespace peclet::dem {

namespace {

/// Closed contacts of the last substep of step_hertz.
std::vector<ContactRecord> soft_contact_records(const SoftContacts& list, Real dt) {
  std::vector<ContactRecord> records;
  if (list.keys.count == 0) return records;
  const auto contacts = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list.contacts);
  const auto springs = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list.springs);
  const auto loads = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list.loads);
  for (std::size_t n = 0; n < static_cast<std::size_t>(list.keys.count); ++n) {
    const Contact& c = contacts(n);
    const ContactSpring& spring = springs(n);
    if (spring.circle > 0)
      records.push_back({c.a, c.b, -1, spring.normal, dt * loads(n).force,
                         -spring.circle * spring.circle / c.effective_radius()});
  }
  return records;
}

}  // namespace

std::vector<ContactRecord> contact_records(const Simulation& simulation) {
  if (const SoftContacts* soft = simulation.soft_contacts())
    return soft_contact_records(*soft, simulation.last_soft_dt());
  const ContactOrder& order = simulation.solver().order();
  const auto count = static_cast<std::size_t>(order.count);
  std::vector<ContactRecord> records(count);
  if (count == 0) return records;
  const auto contacts =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, simulation.solver().contacts());
  int color = 0;
  for (std::size_t n = 0; n < count; ++n) {
    while (color < order.number_of_colors && static_cast<Index>(n) >= order.color_begin[color + 1]) ++color;
    const Contact& c = contacts(n);
    records[n] = {c.a,
                  c.b,
                  color < order.number_of_colors ? color : -1,
                  c.normal,
                  c.impact_impulse + c.normal_impulse * c.normal + c.tangential_impulse,
                  c.gap};
  }
  return records;
}

std::pair<Index, Index> coloring_conflicts(const Simulation& simulation) {
  if (simulation.soft_contacts()) return {0, 0};
  const ParticleArrays& particles = simulation.particles().arrays();
  const auto mass = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.inverse_mass);
  const auto inertia = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.inverse_inertia);
  std::vector<std::pair<int, int>> visits;  // (color, particle)
  Index uncolored = 0;
  for (const ContactRecord& record : contact_records(simulation)) {
    if (record.color < 0) {
      ++uncolored;
      continue;
    }
    for (const int particle : {record.a, record.b})
      if (particle >= 0 && !is_immovable(mass(particle), inertia(particle)))
        visits.emplace_back(record.color, particle);
  }
  std::sort(visits.begin(), visits.end());
  Index conflicts = 0;
  for (std::size_t n = 1; n < visits.size(); ++n) conflicts += visits[n] == visits[n - 1];
  return {conflicts, uncolored};
}

}  // namespace peclet::dem
