#pragma once
// Contacts by name: who touches whom, and through which periodic image.
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "dem/domain.hpp"

namespace peclet::dem {

/// Particle a and particle b (at its periodic image), or wall -1 - b (at its feature number image). Rows are
/// sorted, so that a list depends on the state alone and not on the search.
struct ContactKey {
  int a = 0, b = 0, image = 0;
};

/// Keys in rows: those of particle a are [row_begin(a), row_begin(a + 1)).
struct ContactKeys {
  Index rows = 0, count = 0;
  Array<Index> row_begin;
  Array<ContactKey> keys;
};

/// Order within a row; walls come first.
KOKKOS_INLINE_FUNCTION bool comes_before(const ContactKey& p, const ContactKey& q) {
  return p.b != q.b ? p.b < q.b : p.image < q.image;
}

/// What to add to a position to get that of the image.
KOKKOS_INLINE_FUNCTION Vec3 shift_of(const Domain& domain, int image) {
  return {(image / 65536 - 128) * domain.extent.x, (image / 256 % 256 - 128) * domain.extent.y,
          (image % 256 - 128) * domain.extent.z};
}

/// First place in the row of key.a that does not come before key.
KOKKOS_INLINE_FUNCTION Index lower_bound(const ContactKeys& keys, const ContactKey& key) {
  Index low = keys.row_begin(key.a), high = keys.row_begin(key.a + 1);
  while (low < high) {
    const Index middle = (low + high) / 2;
    if (comes_before(keys.keys(middle), key))
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// Place of a key, or -1.
KOKKOS_INLINE_FUNCTION Index find_key(const ContactKeys& keys, const ContactKey& key) {
  if (key.a >= keys.rows) return -1;
  const Index n = lower_bound(keys, key);
  return n < keys.row_begin(key.a + 1) && !comes_before(key, keys.keys(n)) ? n : -1;
}

/// Where a contact stood in an older list.
struct FormerPlace {
  Index place = -1;
  Real sign = 1;  // -1: the two particles have changed places
};

/// Which of a pair comes first may have changed since, and so may the image, where one of them was wrapped:
/// of all images, the one whose normal has turned least. Normals: normal_at(n).
template <class NormalAt>
KOKKOS_INLINE_FUNCTION FormerPlace find_former_pair(const ContactKeys& keys, int a, int b, Vec3 normal,
                                                    const NormalAt& normal_at) {
  constexpr int before_all_images = -1;
  FormerPlace former;
  Real largest_cosine = 0.9;
  for (int order = 0; order < 2; ++order) {
    const ContactKey first{order == 0 ? a : b, order == 0 ? b : a, before_all_images};
    const Real sign = order == 0 ? 1 : -1;
    if (first.a >= keys.rows) continue;
    for (Index n = lower_bound(keys, first); n < keys.row_begin(first.a + 1) && keys.keys(n).b == first.b;
         ++n) {
      const Real cosine = sign * dot(normal_at(n), normal);
      if (cosine < largest_cosine) continue;
      largest_cosine = cosine;
      former = {n, sign};
    }
  }
  return former;
}

}  // namespace peclet::dem
