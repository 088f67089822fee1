#include "dem/contact_keys.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/field_transfer.hpp"

namespace peclet::dem {
namespace {

ContactKeys keys_of(const std::vector<std::vector<ContactKey>>& rows) {
  std::vector<Index> begin{0};
  std::vector<ContactKey> all;
  for (const auto& row : rows) {
    all.insert(all.end(), row.begin(), row.end());
    begin.push_back(static_cast<Index>(all.size()));
  }
  return {static_cast<Index>(rows.size()), begin.back(), copy_from_host("row_begin", begin),
          copy_from_host("keys", all)};
}

Index place_of(const ContactKeys& keys, const ContactKey& key) {
  const Array<Index> place("place", 1);
  for_each("find_key", 1, KOKKOS_LAMBDA(Index n) { place(n) = find_key(keys, key); });
  return copy_to_host(place)[0];
}

FormerPlace former_place(const ContactKeys& keys, const Array<Vec3>& normals, int a, int b, Vec3 normal) {
  const Array<FormerPlace> place("place", 1);
  for_each(
      "find_former_pair", 1,
      KOKKOS_LAMBDA(Index n) { place(n) = find_former_pair(keys, a, b, normal, normals); });
  return copy_to_host(place)[0];
}

constexpr int here = (128 * 256 + 128) * 256 + 128, beyond_x = (129 * 256 + 128) * 256 + 128;

TEST(ContactKeys, AreFoundOrNot) {
  const std::vector<std::vector<ContactKey>> rows{
      {{0, -2, 0}, {0, -2, 1}, {0, 1, here}}, {}, {{2, 0, here}, {2, 1, here}}};
  const ContactKeys keys = keys_of(rows);
  Index n = 0;
  for (const auto& row : rows)
    for (const ContactKey& key : row) EXPECT_EQ(place_of(keys, key), n++);
  EXPECT_EQ(place_of(keys, {0, -2, 2}), -1);
  EXPECT_EQ(place_of(keys, {1, 0, here}), -1);
  EXPECT_EQ(place_of(keys, {2, 1, beyond_x}), -1);
  EXPECT_EQ(place_of(keys, {7, 1, here}), -1);
}

TEST(ContactKeys, APairIsFoundInEitherOrderAndAtTheImageThatFacesTheSameWay) {
  const ContactKeys keys = keys_of({{}, {{1, 0, here}, {1, 0, beyond_x}}});
  const Array<Vec3> normals = copy_from_host("normals", std::vector<Vec3>{{1, 0, 0}, {-1, 0, 0}});
  const auto found = [&](int a, int b, Vec3 normal) { return former_place(keys, normals, a, b, normal); };
  EXPECT_EQ(found(1, 0, {1, 0, 0}).place, 0);
  EXPECT_EQ(found(1, 0, {-1, 0, 0}).place, 1);
  EXPECT_EQ(found(1, 0, {-1, 0, 0}).sign, 1);
  EXPECT_EQ(found(0, 1, {1, 0, 0}).place, 1);
  EXPECT_EQ(found(0, 1, {1, 0, 0}).sign, -1);
  EXPECT_EQ(found(1, 0, {0, 1, 0}).place, -1);
}

TEST(ContactKeys, ImagesAreShiftsByWholePeriods) {
  Domain domain;
  domain.extent = {3, 5, 7};
  const Vec3 shift = shift_of(domain, (127 * 256 + 128) * 256 + 130);
  EXPECT_EQ(shift.x, -3);
  EXPECT_EQ(shift.y, 0);
  EXPECT_EQ(shift.z, 14);
}

}  // namespace
}  // namespace peclet::dem
