#pragma once
// One place where a sphere touches, or may touch within the substep, another sphere or a wall.
#include "core/loop.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "dem/body.hpp"
#include "dem/materials.hpp"

namespace peclet::dem {

struct Contact {
  int a = 0, b = -1;  // particles; b < 0: wall -1 - b
  int row_entry = 0;  // index among the contacts sorted by (a, b, image)
  Vec3 offset;  // pair: add to the position of b; wall: point of its tangent plane at the end of the substep
  Vec3 normal;  // from b to a
  Vec3 end_normal;  // the same at the end of the substep
  Vec3 wall_velocity;
  Real reach = 0;  // distance of the centres (of centre and wall) at touch
  Real share = 1;  // of the reach that is the radius of a
  Real gap = 0;    // at the start of the substep
  ContactMaterial material;
  Real carried_force = 0;   // normal force in the last substep
  Vec3 carried_friction;    // tangential force on a in the last substep
  Real closed_time = 0;     // length of the last part of the substep in which the contact is closed; 0: open
  Real closed_length = 0;   // distance of the centres (of centre and wall) in the middle of that time
  Real normal_impulse = 0;  // of the force while closed, so far
  Vec3 tangential_impulse;  // of the friction on a while closed, so far
  Vec3 rolling_couple;      // of the rolling resistance on a while closed, so far
  Vec3 impact_impulse;      // on a, by the impacts of this substep

  KOKKOS_INLINE_FUNCTION bool is_pair() const { return b >= 0; }
  /// 1/R* = 1/R_a + 1/R_b
  KOKKOS_INLINE_FUNCTION Real effective_radius() const {
    return is_pair() ? share * (1 - share) * reach : reach;
  }
};

/// The order in which contacts are visited: color after color, then the rest one by one. No two contacts of a
/// color share a particle, so that they can be treated at the same time, with the same result for any
/// number of threads.
struct ContactOrder {
  static constexpr int maximum_colors = 64;
  int number_of_colors = 0;
  Index color_begin[maximum_colors + 1] = {0};  // color c is [color_begin[c], color_begin[c + 1])
  Index count = 0;                              // the rest is [color_begin[number_of_colors], count)
};

enum class Direction { Forward, Backward };

template <class Function>
void for_each_contact(const std::string& label, const ContactOrder& order, const Function& body) {
  for (int color = 0; color < order.number_of_colors; ++color)
    for_each_from(label, order.color_begin[color], order.color_begin[color + 1], body);
  for_each_in_order(label, order.color_begin[order.number_of_colors], order.count, body);
}

}  // namespace peclet::dem
