#include "dem/contact_coloring.hpp"

#include <utility>

namespace peclet::dem {
namespace {

constexpr int none = -1;
constexpr int no_color_left = ContactOrder::maximum_colors;

/// Distinct for distinct n < 2^32, and in no relation to their order.
KOKKOS_INLINE_FUNCTION std::uint64_t priority_of(Index n) {
  std::uint64_t hash = static_cast<std::uint64_t>(n) * 0x9E3779B97F4A7C15u;
  hash ^= hash >> 29;
  hash *= 0xBF58476D1CE4E5B9u;
  return (hash & 0xFFFFFFFF00000000u) | static_cast<std::uint64_t>(n);
}

struct Round {
  ContactKeys keys;
  ParticleArrays particles;
  Array<int> colors;
  Array<std::uint64_t> used, best;
  Array<Index> waiting;  // contacts without a color
  Index number_waiting = 0;

  KOKKOS_INLINE_FUNCTION bool moves(int particle) const {
    return particle >= 0 &&
           !is_immovable(particles.inverse_mass(particle), particles.inverse_inertia(particle));
  }
  KOKKOS_INLINE_FUNCTION bool is_exhausted(int particle) const {
    return moves(particle) && used(particle) == ~std::uint64_t{0};
  }
};

void clear(const Round& round) {
  for_each(
      "dem::clear_colors", round.keys.count, KOKKOS_LAMBDA(Index n) {
        round.colors(n) = none;
        round.waiting(n) = n;
      });
  for_each("dem::clear_used_colors", round.keys.rows, KOKKOS_LAMBDA(Index n) { round.used(n) = 0; });
}

/// Contacts of a particle that has used all colors go without.
void bid(const Round& round) {
  for_each("dem::reset_bids", round.keys.rows, KOKKOS_LAMBDA(Index n) { round.best(n) = 0; });
  for_each(
      "dem::bid", round.number_waiting, KOKKOS_LAMBDA(Index m) {
        const Index n = round.waiting(m);
        const ContactKey key = round.keys.keys(n);
        if (round.is_exhausted(key.a) || round.is_exhausted(key.b)) {
          round.colors(n) = no_color_left;
          return;
        }
        if (round.moves(key.a)) Kokkos::atomic_max(&round.best(key.a), priority_of(n) + 1);
        if (round.moves(key.b)) Kokkos::atomic_max(&round.best(key.b), priority_of(n) + 1);
      });
}

/// A contact that is first at both its particles takes the lowest color that neither has used.
void take_colors(const Round& round) {
  for_each(
      "dem::take_colors", round.number_waiting, KOKKOS_LAMBDA(Index m) {
        const Index n = round.waiting(m);
        if (round.colors(n) != none) return;
        const ContactKey key = round.keys.keys(n);
        const bool moves_a = round.moves(key.a), moves_b = round.moves(key.b);
        if (moves_a && round.best(key.a) != priority_of(n) + 1) return;
        if (moves_b && round.best(key.b) != priority_of(n) + 1) return;
        const std::uint64_t used = (moves_a ? round.used(key.a) : 0) | (moves_b ? round.used(key.b) : 0);
        int color = 0;
        while (color < no_color_left && (used >> color & 1u)) ++color;
        round.colors(n) = color;
        const std::uint64_t bit = color < no_color_left ? std::uint64_t{1} << color : 0;
        if (moves_a) round.used(key.a) |= bit;
        if (moves_b) round.used(key.b) |= bit;
      });
}

/// Write those that still wait to next, in the same order; returns their number.
Index collect_waiting(const Round& round, const Array<Index>& kept, const Array<Index>& next) {
  const Index number = list_where(
      "dem::list_waiting", round.number_waiting, kept,
      KOKKOS_LAMBDA(Index m) { return round.colors(round.waiting(m)) == none; });
  for_each("dem::collect_waiting", number, KOKKOS_LAMBDA(Index m) { next(m) = round.waiting(kept(m)); });
  return number;
}

int highest_color(const Round& round) {
  return static_cast<int>(max_each(
      "dem::highest_color", round.keys.count,
      KOKKOS_LAMBDA(Index n) { return static_cast<Real>(round.colors(n)); }));
}

/// Contacts of one color go to begin, begin + 1, ...; returns the end.
Index place_color(const Round& round, int color, Index begin, const Array<Index>& kept,
                  const Array<Index>& place) {
  const Index size = list_where(
      "dem::list_color", round.keys.count, kept, KOKKOS_LAMBDA(Index n) { return round.colors(n) == color; });
  for_each("dem::place_color", size, KOKKOS_LAMBDA(Index m) { place(kept(m)) = begin + m; });
  return begin + size;
}

void keep_places(Index count, const Array<Index>& place) {
  for_each("dem::keep_places", count, KOKKOS_LAMBDA(Index n) { place(n) = n; });
}

}  // namespace

ContactOrder ContactColoring::arrange(const ContactKeys& keys, const ParticleArrays& particles) {
  const auto count = static_cast<std::size_t>(keys.count);
  if (place_.extent(0) < count) {
    place_ = Array<Index>("dem.place", count + count / 4);
    kept_ = Array<Index>("dem.kept", count + count / 4);
    waiting_ = Array<Index>("dem.waiting", count + count / 4);
    colors_ = Array<int>("dem.colors", count + count / 4);
  }
  ContactOrder order;
  order.count = keys.count;
  if (keys.count <= largest_uncolored) {
    keep_places(keys.count, place_);
    return order;
  }
  const auto rows = static_cast<std::size_t>(keys.rows);
  if (used_colors_.extent(0) < rows) {
    used_colors_ = Array<std::uint64_t>("dem.used_colors", rows);
    best_priority_ = Array<std::uint64_t>("dem.best_priority", rows);
  }
  Round round{keys, particles, colors_, used_colors_, best_priority_, waiting_, keys.count};
  clear(round);
  Array<Index> next = place_;
  while (round.number_waiting > 0) {
    bid(round);
    take_colors(round);
    round.number_waiting = collect_waiting(round, kept_, next);
    std::swap(round.waiting, next);
  }

  const int highest = highest_color(round);
  order.number_of_colors = highest < no_color_left ? highest + 1 : no_color_left;
  Index begin = 0;
  for (int color = 0; color <= highest; ++color) {
    begin = place_color(round, color, begin, kept_, place_);
    if (color < order.number_of_colors) order.color_begin[color + 1] = begin;
  }
  return order;
}

}  // namespace peclet::dem
