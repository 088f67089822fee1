#pragma once
// From positions to the list of contacts that may close within a substep.
#include "dem/contact_history.hpp"
#include "dem/neighbor_search.hpp"
#include "dem/particles.hpp"
#include "dem/walls.hpp"

namespace peclet::dem {

/// Gap, in units of the mean radius, up to which neighbours are contacts of rigid spheres even if nothing
/// moves.
inline constexpr Real contact_margin = 0.1;

/// What a search starts from; copied by value into kernels.
struct ContactScene {
  ParticleArrays particles;
  Real shape_radius = 0;
  WallArrays walls;
  Materials::Table materials;
  Domain domain;
  Real dt = 0;
  Array<Real> reaches;           // distance from each centre at which a contact begins
  Real margin = contact_margin;  // gap, in units of the mean radius
};

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

}  // namespace peclet::dem
