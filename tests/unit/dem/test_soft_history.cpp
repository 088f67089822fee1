#include "dem/soft_history.hpp"

#include <gtest/gtest.h>

#include "core/field_transfer.hpp"

namespace peclet::dem {
namespace {

/// Of two particles, of which a names the pair.
SpringHistory history_of_pair(int a, int b) {
  const std::vector<Index> row_begin{0, a == 0 ? 1 : 0, 1};
  const std::vector<ContactSpring> springs{{0.1, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
  return {{2, 1, copy_from_host("row_begin", row_begin),
           copy_from_host("keys", std::vector<ContactKey>{{a, b, 0}})},
          copy_from_host("springs", springs)};
}

ContactSpring recalled(const SpringHistory& history, const ContactKey& key, const Contact& c) {
  const Array<ContactSpring> spring("spring", 1);
  for_each("recall_spring", 1, KOKKOS_LAMBDA(Index n) { spring(n) = recall_spring(history, key, c); });
  return copy_to_host(spring)[0];
}

TEST(SoftHistory, SpringsChangeSignWithTheOrderOfThePair) {
  Contact c;
  c.a = 0;
  c.b = 1;
  c.normal = {-1, 0, 0};
  const ContactSpring spring = recalled(history_of_pair(1, 0), {0, 1, 5}, c);
  EXPECT_EQ(spring.circle, 0.1);
  EXPECT_EQ(spring.force.y, -2);
  EXPECT_EQ(spring.moment.z, -3);
  c.normal = {0, 1, 0};
  EXPECT_EQ(recalled(history_of_pair(1, 0), {0, 1, 5}, c).circle, 0);
}

TEST(SoftHistory, ASpringIsTakenOnceAndByTheSurfaceThatFacesItsWay) {
  ContactSpring springs[2] = {{0.1, {1, 0, 0}, {}, {}}, {0.2, {0, 1, 0}, {}, {}}};
  EXPECT_EQ(take_spring(springs, 2, normalized(Vec3{0.1, 1, 0})).circle, 0.2);
  EXPECT_EQ(take_spring(springs, 2, {0, 1, 0}).circle, 0);
  EXPECT_EQ(take_spring(springs, 2, {1, 0, 0}).circle, 0.1);
}

}  // namespace
}  // namespace peclet::dem
