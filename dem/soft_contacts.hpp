#pragma once
// Hertz-Mindlin contacts of elastic spheres: a neighbour list that serves many substeps, springs that outlive
// it, and the sum of all contact forces on each particle.
#include "dem/contact_detection.hpp"
#include "dem/hertz.hpp"
#include "dem/soft_history.hpp"

namespace peclet::dem {

/// Copied by value into kernels. The contacts of a particle with one wall stand one after the other; each
/// serves as a slot for one of the places where they touch.
struct SoftContacts {
  ContactKeys keys;
  Array<Contact> contacts;
  Array<ElasticPair> elastic;
  Array<ContactSpring> springs;
  Array<SoftLoad> loads;
  Array<Index> incident_begin, incident;  // contacts in which a particle is b, ascending
};

/// What the contact list was made from.
struct ListOrigin {
  int particles = -1, walls = -1, materials = -1;  // revisions
  Real skin = 0;
  Domain domain;
};

class SoftContactSolver {
 public:
  /// Loads by all contacts of bodies that stand at the middle of a substep. scene.margin is the skin of the
  /// neighbour list, in radii. Particles may be moved by whole periods.
  ParticleLoads solve(ContactScene& scene, const ListOrigin& origin, const Bodies& bodies);
  /// All contacts open; springs mean nothing any more.
  void forget();

  const SoftContacts& contacts() const { return list_; }

 private:
  bool serves(const ContactScene& scene, const ListOrigin& origin, const Bodies& bodies) const;
  void rebuild(ContactScene& scene, const Bodies& bodies);

  ContactFinder finder_;
  SoftContacts list_;
  SpringHistory history_;
  ListOrigin origin_;
  Array<Vec3> listed_positions_;
  Array<Index> place_, incident_sizes_;
  ParticleLoads loads_;
};

/// Substeps have to be short against both.
struct SoftTimeScales {
  Real rayleigh = 0;  // of a wave on a particle [ThorntonRandall1988]; infinite without particles that move
  Real impact = 0;    // duration of an impact at the present speeds [Johnson1985]; infinite at rest
};

SoftTimeScales soft_time_scales(const ContactScene& scene);

/// Largest material id of a particle that has no elastic constants, or -1.
int find_material_without_elasticity(const ContactScene& scene);

}  // namespace peclet::dem
