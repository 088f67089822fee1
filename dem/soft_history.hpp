#pragma once
// What soft contacts keep when their list is made anew: the springs.
#include "dem/contact_keys.hpp"
#include "dem/hertz.hpp"

namespace peclet::dem {

struct SpringHistory {
  ContactKeys keys;
  Array<ContactSpring> springs;
};

struct SpringNormals {
  const Array<ContactSpring>& springs;
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index n) const { return springs(n).normal; }
};

/// Spring of a contact in the former list; open if it was not there.
KOKKOS_INLINE_FUNCTION ContactSpring recall_spring(const SpringHistory& history, const ContactKey& key,
                                                   const Contact& c) {
  FormerPlace former;
  if (c.is_pair())
    former = find_former_pair(history.keys, key.a, key.b, c.normal, SpringNormals{history.springs});
  else
    former.place = find_key(history.keys, key);
  if (former.place < 0) return {};
  ContactSpring spring = history.springs(former.place);
  spring.normal = former.sign * spring.normal;
  spring.force = former.sign * spring.force;
  spring.moment = former.sign * spring.moment;
  return spring;
}

/// Of count springs of one particle and one wall, take the one whose surface faced the same way; open if
/// there is none. What is taken is open afterwards.
KOKKOS_INLINE_FUNCTION ContactSpring take_spring(ContactSpring* springs, int count, Vec3 normal) {
  constexpr Real same_direction = 0.9;
  int best = -1;
  Real largest = same_direction;
  for (int k = 0; k < count; ++k) {
    const Real cosine = dot(springs[k].normal, normal);
    if (springs[k].circle == 0 || cosine < largest) continue;
    best = k;
    largest = cosine;
  }
  if (best < 0) return {};
  const ContactSpring spring = springs[best];
  springs[best] = {};
  return spring;
}

}  // namespace peclet::dem
