#pragma once
// Colors for contacts, such that no two of a color move the same particle.
#include "dem/contact_detection.hpp"

namespace peclet::dem {

class ContactColoring {
 public:
  /// Up to this many contacts are visited one by one, which needs no colors.
  static constexpr Index largest_uncolored = 64;

  /// place(n) tells where contact n of the keys goes so that colors are contiguous. The result depends on the
  /// keys only: rounds in which each particle picks the first of its contacts in a fixed random order
  /// [JonesPlassmann1993].
  ContactOrder arrange(const ContactKeys& keys, const ParticleArrays& particles);
  const Array<Index>& place() const { return place_; }

 private:
  Array<Index> place_, kept_, waiting_;
  Array<int> colors_;                                 // -1: none yet
  Array<std::uint64_t> used_colors_, best_priority_;  // per particle
};

}  // namespace peclet::dem
