#pragma once
// How two touching surfaces answer an impact, and the table of pairs.
#include <map>
#include <span>
#include <utility>

#include "core/types.hpp"

namespace peclet::dem {

struct ContactMaterial {
  Real restitution = 0;             // normal: speed of departure over speed of approach
  Real tangential_restitution = 0;  // of a sticking impact: minus the ratio of the tangential speeds
  Real friction = 0;                // Coulomb coefficient
  Real rolling_friction = 0;        // rolling moment at most this times effective radius and normal force
  Real damping_ratio = 0;           // of soft contacts; filled in by the tables
};

/// Constants of an elastic solid; Young's modulus 0: not given.
struct ElasticMaterial {
  Real young = 0, poisson = 0;
};

/// Throws std::invalid_argument naming the member that is out of range.
void validate(const ContactMaterial& material);

/// Share of critical damping at which a Hertz contact, whose force never attracts, gives this restitution.
/// With zeta = sin(theta) below and cosh(psi) above critical damping,
///     e = exp(-(pi - 2 theta) tan(theta)),  e = exp(-2 psi / tanh(psi)):
/// a Hertz spring whose damping follows delta^(1/4) is a linear one in disguise [AntypovElliott2011], and for
/// that the end of contact is known [SchwagerPoeschel2007]. A restitution below 0.01 counts as 0.01.
Real damping_ratio(Real restitution);

/// Material of each pair of material ids: the default one unless the pair was given its own.
class Materials {
 public:
  static constexpr int maximum_number_of_ids = 1024;

  Materials();

  void set_default(const ContactMaterial& material);
  const ContactMaterial& default_material() const { return default_; }
  /// Symmetric in the ids. The tangential restitution stays that of the default.
  void set_pair(int first, int second, Real restitution, Real friction, Real rolling_friction = 0);
  /// Needed by soft contacts only.
  void set_elastic(int id, const ElasticMaterial& material);
  bool is_elastic(int id) const { return elastic_.contains(id); }
  /// Make room for ids up to and including id.
  void include(int id);
  static void require_id(long long id, const char* argument);

  struct Table {
    Array<ContactMaterial> entries;
    Array<ElasticMaterial> elastic;
    int number_of_ids = 1;
    KOKKOS_INLINE_FUNCTION const ContactMaterial& operator()(int first, int second) const {
      return entries.data()[first * number_of_ids + second];
    }
  };
  const Table& table() const { return table_; }
  /// Changes with every change.
  int revision() const { return revision_; }

 private:
  void rebuild();

  ContactMaterial default_;
  std::map<std::pair<int, int>, ContactMaterial> pairs_;
  std::map<int, ElasticMaterial> elastic_;
  Table table_;
  int revision_ = 0;
};

}  // namespace peclet::dem
