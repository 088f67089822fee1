#pragma once
// Reading out the contacts of the last substep.
#include <utility>
#include <vector>

#include "dem/simulation.hpp"

namespace peclet::dem {

struct ContactRecord {
  int a = 0, b = 0;  // particles; b < 0: wall -1 - b, in the order in which planes and scenes were added
  int color = -1;    // -1: visited one by one
  Vec3 normal;       // from b to a
  Vec3 impulse;      // on a, over the substep
  Real gap = 0;      // at the start of the substep
};

/// Contacts of the last substep. Of step: all within its margin, open ones without an impulse. Of step_hertz:
/// the closed ones, with the gap in the middle of the substep.
std::vector<ContactRecord> contact_records(const Simulation& simulation);

/// Pairs of contacts of one color that share a movable particle (none, if all is well), and the number of
/// contacts without a color.
std::pair<Index, Index> coloring_conflicts(const Simulation& simulation);

}  // namespace peclet::dem
