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
};

/// Throws std::invalid_argument naming the member that is out of range.
void validate(const ContactMaterial& material);

/// Material of each pair of material ids: the default one unless the pair was given its own.
class Materials {
 public:
  static constexpr int maximum_number_of_ids = 1024;

  Materials();

  void set_default(const ContactMaterial& material);
  const ContactMaterial& default_material() const { return default_; }
  /// Symmetric in the ids. The tangential restitution stays that of the default.
  void set_pair(int first, int second, Real restitution, Real friction);
  /// Make room for ids up to and including id.
  void include(int id);
  static void require_id(long long id, const char* argument);

  struct Table {
    Array<ContactMaterial> entries;
    int number_of_ids = 1;
    KOKKOS_INLINE_FUNCTION const ContactMaterial& operator()(int first, int second) const {
      return entries.data()[first * number_of_ids + second];
    }
  };
  const Table& table() const { return table_; }

 private:
  void rebuild();

  ContactMaterial default_;
  std::map<std::pair<int, int>, ContactMaterial> pairs_;
  Table table_;
};

}  // namespace peclet::dem
