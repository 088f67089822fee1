#pragma once
// What rigid contacts keep from one substep to the next: the forces they carried.
#include <vector>

#include "dem/contact.hpp"
#include "dem/contact_keys.hpp"

namespace peclet::dem {

/// By place in the rows of the last substep.
struct ContactHistory {
  ContactKeys keys;
  Array<Real> force;
  Array<Vec3> friction, normal;
};

/// Give a contact what it carried in the last substep, unless it has turned too far.
KOKKOS_INLINE_FUNCTION void recall(const ContactHistory& history, const ContactKey& key, Contact& c) {
  constexpr Real same_direction = 0.9;
  FormerPlace former;
  if (c.is_pair())
    former = find_former_pair(history.keys, key.a, key.b, c.normal, history.normal);
  else
    former.place = find_key(history.keys, key);
  if (former.place < 0 || former.sign * dot(history.normal(former.place), c.normal) < same_direction) return;
  c.carried_force = history.force(former.place);
  c.carried_friction = former.sign * history.friction(former.place);
}

/// What one contact carried, on the host.
struct CarriedForce {
  ContactKey key;
  Real force = 0;
  Vec3 friction, normal;
};

/// Sorted by key; empty where the last substep means nothing to the next one.
std::vector<CarriedForce> carried_forces(const ContactHistory& history);
/// The inverse, for so many particles; in any order.
ContactHistory history_of(std::vector<CarriedForce> carried, Index particles);

/// Remember what the closed contacts carry. The keys go into the history; keys gets the old ones as scratch.
void record_history(ContactKeys& keys, const Array<Contact>& contacts, Real dt, ContactHistory& history);

}  // namespace peclet::dem
