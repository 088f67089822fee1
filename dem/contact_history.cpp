#include "dem/contact_history.hpp"

#include <utility>

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

void record_history(ContactKeys& keys, const Array<Contact>& contacts, Real dt, ContactHistory& history) {
  make_room(history.force, "dem.history_force", keys.count);
  make_room(history.friction, "dem.history_friction", keys.count);
  make_room(history.normal, "dem.history_normal", keys.count);
  write_history(keys.count, contacts, dt, history);
  std::swap(keys, history.keys);
}

}  // namespace peclet::dem
