#include "dem/contact_laws.hpp"

#include <gtest/gtest.h>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

Contact pair_at(Real reach) {
  Contact c;
  c.a = 0;
  c.b = 1;
  c.reach = reach;
  c.share = 0.5;
  c.normal = {1, 0, 0};
  return c;
}

TEST(ContactLaws, FindTheMomentOfTouchOfAGlancingParabola) {
  const Contact c = pair_at(1);
  const RelativeMotion start{{1.2, 0.4, 0.1}, {-1, 0.2, -0.1}, {0.3, -2, 0.5}};
  const Real dt = 0.6;
  const RelativeMotion end{start.distance + dt * start.velocity + (0.5 * dt * dt) * start.acceleration,
                           start.velocity + dt * start.acceleration, start.acceleration};
  ASSERT_LT(gap_of(c, end.distance), 0);
  ASSERT_GT(gap_of(c, start.distance), 0);
  const Real s = find_closed_time(c, end, 0, dt);
  EXPECT_GT(s, 0);
  EXPECT_LT(s, dt);
  EXPECT_NEAR(gap_of(c, end.before(s).distance), 0, 1e-14);
}

TEST(ContactLaws, ASphereThatStartsInsideWasClosedAllTheTime) {
  const Contact c = pair_at(1);
  const RelativeMotion end{{0.8, 0, 0}, {-0.1, 0, 0}, {}};
  EXPECT_EQ(find_closed_time(c, end, 0, 0.5), 0.5);
}

TEST(ContactLaws, SpheresThatPassThroughEachOtherWithinAStepAreNoticed) {
  const Contact c = pair_at(1);
  const RelativeMotion end{{-3, 0.5, 0}, {-6, 0, 0}, {}};
  EXPECT_GT(time_of_overlap(c, end, true, 1.0), 0);
  EXPECT_LT(time_of_overlap(c, end, true, 0.2), 0);
  EXPECT_LT(time_of_overlap(c, end, false, 1.0), 0);
}

TEST(ContactLaws, LimitedShortensOnlyWhatIsTooLong) {
  EXPECT_EQ(limited({3, 4, 0}, 5).y, 4);
  EXPECT_NEAR(norm(limited({3, 4, 0}, 2)), 2, 1e-15);
  EXPECT_EQ(norm(limited({3, 4, 0}, 0)), 0);
}

}  // namespace
}  // namespace peclet::dem
