#include "dem/contact_keys.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace peclet::dem {
namespace {

ContactKeys keys_of(const std::vector<std::vector<ContactKey>>& rows) {
  ContactKeys keys;
  keys.rows = static_cast<Index>(rows.size());
  keys.row_begin = Array<Index>("row_begin", rows.size() + 1);
  for (std::size_t a = 0; a < rows.size(); ++a) {
    keys.row_begin(a) = keys.count;
    keys.count += static_cast<Index>(rows[a].size());
  }
  keys.row_begin(rows.size()) = keys.count;
  keys.keys = Array<ContactKey>("keys", static_cast<std::size_t>(keys.count));
  Index n = 0;
  for (const auto& row : rows)
    for (const ContactKey& key : row) keys.keys(n++) = key;
  return keys;
}

constexpr int here = (128 * 256 + 128) * 256 + 128, beyond_x = (129 * 256 + 128) * 256 + 128;

TEST(ContactKeys, AreFoundOrNot) {
  const ContactKeys keys =
      keys_of({{{0, -2, 0}, {0, -2, 1}, {0, 1, here}}, {}, {{2, 0, here}, {2, 1, here}}});
  for (Index n = 0; n < keys.count; ++n) EXPECT_EQ(find_key(keys, keys.keys(n)), n);
  EXPECT_EQ(find_key(keys, {0, -2, 2}), -1);
  EXPECT_EQ(find_key(keys, {1, 0, here}), -1);
  EXPECT_EQ(find_key(keys, {2, 1, beyond_x}), -1);
  EXPECT_EQ(find_key(keys, {7, 1, here}), -1);
}

TEST(ContactKeys, APairIsFoundInEitherOrderAndAtTheImageThatFacesTheSameWay) {
  const ContactKeys keys = keys_of({{}, {{1, 0, here}, {1, 0, beyond_x}}});
  Array<Vec3> normals("normals", 2);
  normals(0) = {1, 0, 0};
  normals(1) = {-1, 0, 0};
  const auto found = [&](int a, int b, Vec3 normal) { return find_former_pair(keys, a, b, normal, normals); };
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
