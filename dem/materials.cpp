#include "dem/materials.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace peclet::dem {

void validate(const ContactMaterial& m) {
  require(m.restitution >= 0 && m.restitution <= 1, "restitution_normal", "a number in [0, 1]",
          m.restitution);
  require(m.tangential_restitution >= -1 && m.tangential_restitution <= 1, "restitution_tangent",
          "a number in [-1, 1]", m.tangential_restitution);
  require_non_negative(m.friction, "friction");
}

Materials::Materials() { rebuild(); }

void Materials::require_id(long long id, const char* argument) {
  require(id >= 0 && id < maximum_number_of_ids, argument,
          "material ids from 0 to " + std::to_string(maximum_number_of_ids - 1), id);
}

void Materials::set_default(const ContactMaterial& material) {
  validate(material);
  default_ = material;
  rebuild();
}

void Materials::set_pair(int first, int second, Real restitution, Real friction) {
  require_id(first, "a");
  require_id(second, "b");
  const ContactMaterial material{restitution, default_.tangential_restitution, friction};
  validate(material);
  pairs_[std::minmax(first, second)] = material;
  table_.number_of_ids = std::max(table_.number_of_ids, std::max(first, second) + 1);
  rebuild();
}

void Materials::include(int id) {
  if (id < table_.number_of_ids) return;
  table_.number_of_ids = id + 1;
  rebuild();
}

void Materials::rebuild() {
  const int n = table_.number_of_ids;
  table_.entries = Array<ContactMaterial>("dem.materials", static_cast<std::size_t>(n) * n);
  const auto host = Kokkos::create_mirror_view(table_.entries);
  for (int first = 0; first < n; ++first)
    for (int second = 0; second < n; ++second) {
      const auto found = pairs_.find(std::minmax(first, second));
      ContactMaterial& entry = host(static_cast<std::size_t>(first) * n + second);
      entry = found == pairs_.end() ? default_ : found->second;
      entry.tangential_restitution = default_.tangential_restitution;
    }
  Kokkos::deep_copy(table_.entries, host);
}

}  // namespace peclet::dem
