#include "dem/materials.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace peclet::dem {

void validate(const ContactMaterial& m) {
  require(m.restitution >= 0 && m.restitution <= 1, "restitution_normal", "a number in [0, 1]",
          m.restitution);
  require(m.tangential_restitution >= -1 && m.tangential_restitution <= 1, "restitution_tangent",
          "a number in [-1, 1]", m.tangential_restitution);
  require_non_negative(m.friction, "friction");
  require_non_negative(m.rolling_friction, "rolling_friction");
}

Real damping_ratio(Real restitution) {
  constexpr Real smallest = 0.01;
  const Real wanted = -std::log(std::max(restitution, smallest));
  const auto is_below_critical = wanted < 2;  // e = exp(-2) at critical damping
  Real low = 0, high = is_below_critical ? std::numbers::pi / 2 : 4;
  for (int k = 0; k < 60; ++k) {
    const Real middle = 0.5 * (low + high);
    const Real found = is_below_critical ? (std::numbers::pi - 2 * middle) * std::tan(middle)
                                         : 2 * middle / std::tanh(middle);
    (found < wanted ? low : high) = middle;
  }
  return is_below_critical ? std::sin(low) : std::cosh(low);
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

void Materials::set_pair(int first, int second, Real restitution, Real friction, Real rolling_friction) {
  require_id(first, "a");
  require_id(second, "b");
  const ContactMaterial material{restitution, default_.tangential_restitution, friction, rolling_friction};
  validate(material);
  pairs_[std::minmax(first, second)] = material;
  table_.number_of_ids = std::max(table_.number_of_ids, std::max(first, second) + 1);
  rebuild();
}

void Materials::set_elastic(int id, const ElasticMaterial& material) {
  require_id(id, "mat");
  require_positive(material.young, "youngs");
  require(material.poisson > -1 && material.poisson <= 0.5, "poisson", "a number in (-1, 0.5]",
          material.poisson);
  elastic_[id] = material;
  table_.number_of_ids = std::max(table_.number_of_ids, id + 1);
  rebuild();
}

void Materials::include(int id) {
  if (id < table_.number_of_ids) return;
  table_.number_of_ids = id + 1;
  rebuild();
}

void Materials::rebuild() {
  const int n = table_.number_of_ids;
  ++revision_;
  table_.elastic = Array<ElasticMaterial>("dem.elastic", static_cast<std::size_t>(n));
  const auto elastic = Kokkos::create_mirror_view(table_.elastic);
  for (const auto& [id, material] : elastic_) elastic(static_cast<std::size_t>(id)) = material;
  Kokkos::deep_copy(table_.elastic, elastic);
  table_.entries = Array<ContactMaterial>("dem.materials", static_cast<std::size_t>(n) * n);
  const auto host = Kokkos::create_mirror_view(table_.entries);
  for (int first = 0; first < n; ++first)
    for (int second = 0; second < n; ++second) {
      const auto found = pairs_.find(std::minmax(first, second));
      ContactMaterial& entry = host(static_cast<std::size_t>(first) * n + second);
      entry = found == pairs_.end() ? default_ : found->second;
      entry.tangential_restitution = default_.tangential_restitution;
      entry.damping_ratio = damping_ratio(entry.restitution);
    }
  Kokkos::deep_copy(table_.entries, host);
}

}  // namespace peclet::dem
