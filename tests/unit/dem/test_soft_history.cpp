#include "dem/soft_history.hpp"

#include <gtest/gtest.h>

namespace peclet::dem {
namespace {

SpringHistory history_of_pair(int a, int b) {
  SpringHistory history;
  history.keys.rows = 2;
  history.keys.count = 1;
  history.keys.row_begin = Array<Index>("row_begin", 3);
  for (int n = 0; n < 3; ++n) history.keys.row_begin(n) = n > a ? 1 : 0;
  history.keys.keys = Array<ContactKey>("keys", 1);
  history.keys.keys(0) = {a, b, 0};
  history.springs = Array<ContactSpring>("springs", 1);
  history.springs(0) = {0.1, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  return history;
}

TEST(SoftHistory, SpringsChangeSignWithTheOrderOfThePair) {
  Contact c;
  c.a = 0;
  c.b = 1;
  c.normal = {-1, 0, 0};
  const ContactSpring spring = recall_spring(history_of_pair(1, 0), {0, 1, 5}, c);
  EXPECT_EQ(spring.circle, 0.1);
  EXPECT_EQ(spring.force.y, -2);
  EXPECT_EQ(spring.moment.z, -3);
  c.normal = {0, 1, 0};
  EXPECT_EQ(recall_spring(history_of_pair(1, 0), {0, 1, 5}, c).circle, 0);
}

TEST(SoftHistory, ASpringIsTakenOnceAndByTheSurfaceThatFacesItsWay) {
  ContactSpring springs[2] = {{0.1, {1, 0, 0}, {}, {}}, {0.2, {0, 1, 0}, {}, {}}};
  EXPECT_EQ(take_spring(springs, 2, normalized(Vec3{0.1, 1, 0})).circle, 0.2);
  EXPECT_EQ(take_spring(springs, 2, {0, 1, 0}).circle, 0);
  EXPECT_EQ(take_spring(springs, 2, {1, 0, 0}).circle, 0.1);
}

}  // namespace
}  // namespace peclet::dem
