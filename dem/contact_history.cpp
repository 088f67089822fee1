#include "dem/contact_history.hpp"

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/field_transfer.hpp"
#include "dem/make_room.hpp"

namespace peclet::dem {
namespace {

void write_history(Index count, const Array<Contact>& contacts, Real dt, const ContactHistory& history) {
  for_each(
      "dem::write_history", count, KOKKOS_LAMBDA(Index n) {
        const Contact& c = contacts(n);
        const Real rate = 1 / dt;
        history.force(c.row_entry) = rate * c.normal_impulse;
        history.friction(c.row_entry) = rate * c.tangential_impulse;
        history.normal(c.row_entry) = c.normal;
      });
}

}  // namespace

std::vector<CarriedForce> carried_forces(const ContactHistory& history) {
  if (history.keys.rows == 0) return {};
  const std::vector<ContactKey> keys = copy_to_host(history.keys.keys);
  const std::vector<Real> force = copy_to_host(history.force);
  const std::vector<Vec3> friction = copy_to_host(history.friction), normal = copy_to_host(history.normal);
  std::vector<CarriedForce> carried;
  for (std::size_t n = 0; n < static_cast<std::size_t>(history.keys.count); ++n)
    carried.push_back({keys[n], force[n], friction[n], normal[n]});
  return carried;
}

ContactHistory history_of(std::vector<CarriedForce> carried, Index particles) {
  std::sort(carried.begin(), carried.end(), [](const CarriedForce& p, const CarriedForce& q) {
    return p.key.a != q.key.a ? p.key.a < q.key.a : comes_before(p.key, q.key);
  });
  std::vector<Index> row_begin(static_cast<std::size_t>(particles) + 1, 0);
  std::vector<ContactKey> keys;
  std::vector<Real> force;
  std::vector<Vec3> friction, normal;
  for (const CarriedForce& c : carried) {
    require(c.key.a >= 0 && c.key.a < particles, "contacts",
            "first particles from 0 to below " + std::to_string(particles), c.key.a);
    ++row_begin[static_cast<std::size_t>(c.key.a) + 1];
    keys.push_back(c.key);
    force.push_back(c.force);
    friction.push_back(c.friction);
    normal.push_back(c.normal);
  }
  for (std::size_t n = 1; n < row_begin.size(); ++n) row_begin[n] += row_begin[n - 1];
  ContactHistory history;
  history.keys = {particles, static_cast<Index>(keys.size()), copy_from_host("dem.row_begin", row_begin),
                  copy_from_host("dem.keys", keys)};
  history.force = copy_from_host("dem.history_force", force);
  history.friction = copy_from_host("dem.history_friction", friction);
  history.normal = copy_from_host("dem.history_normal", normal);
  return history;
}

void record_history(ContactKeys& keys, const Array<Contact>& contacts, Real dt, ContactHistory& history) {
  make_room(history.force, "dem.history_force", keys.count);
  make_room(history.friction, "dem.history_friction", keys.count);
  make_room(history.normal, "dem.history_normal", keys.count);
  write_history(keys.count, contacts, dt, history);
  std::swap(keys, history.keys);
}

}  // namespace peclet::dem
