#pragma once
// From positions to the list of contacts that may close within a substep.
#include "dem/contact.hpp"
#include "dem/neighbor_search.hpp"
#include "dem/particles.hpp"
#include "dem/walls.hpp"

namespace peclet::dem {

/// A contact by name. Rows are sorted, so that a list depends on the state alone and not on the search.
struct ContactKey {
  int a = 0, b = 0, image = 0;
};

/// Keys in rows: those of particle a are [row_begin(a), row_begin(a + 1)).
struct ContactKeys {
  Index rows = 0, count = 0;
  Array<Index> row_begin;
  Array<ContactKey> keys;
};

/// What closed contacts of the last substep carried, by place in the rows.
struct ContactHistory {
  ContactKeys keys;
  Array<Real> force;
  Array<Vec3> friction, normal;
};

/// What a search starts from; copied by value into kernels.
struct ContactScene {
  ParticleArrays particles;
  Real shape_radius = 0;
  WallArrays walls;
  Materials::Table materials;
  Domain domain;
  Real dt = 0;
  Array<Real> reaches;  // distance from each centre at which a contact begins
};

/// Gap, in units of the mean radius, up to which neighbours are contacts even if nothing moves.
inline constexpr Real contact_margin = 0.1;

class ContactFinder {
 public:
  /// Pairs and walls closer than the margin plus what free motion (Body::velocity, acceleration) covers in
  /// dt. A sphere that covers more than four radii in one substep may miss what it passes. Sets
  /// scene.reaches.
  void find(ContactScene& scene, const Bodies& bodies, ContactKeys& keys);

 private:
  NeighborSearch search_;
  Array<Real> reaches_;
  Array<Index> row_sizes_;
  Array<ContactKey> kept_;
};

/// contacts(place(n)) becomes contact n of the keys, with what it carried in the last substep.
void build_contacts(const ContactScene& scene, const ContactKeys& keys, const Array<Index>& place,
                    const ContactHistory& history, Array<Contact>& contacts);

/// Remember what the closed contacts carry. The keys go into the history; keys gets the old ones as scratch.
void record_history(ContactKeys& keys, const Array<Contact>& contacts, Real dt, ContactHistory& history);

}  // namespace peclet::dem
