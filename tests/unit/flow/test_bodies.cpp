#include "flow/bodies.hpp"

#include <gtest/gtest.h>

#include "bodies_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75 from (-1, 2, 0.5)

std::vector<Real> distances(const BodyGeometry& geometry, int body, const std::vector<Vec3>& points) {
  const Array<Vec3> x = copy_from_host("points", points);
  const Array<Real> d("distances", points.size());
  for_each(
      "distances", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { d(n) = geometry.distance(body, x(n)); });
  return copy_to_host(d);
}

std::vector<Vec3> surface_velocities(const BodyGeometry& geometry, int body, const std::vector<Vec3>& points,
                                     Motion motion = Motion::AtEnd) {
  const Array<Vec3> x = copy_from_host("points", points);
  const Array<Vec3> u("velocities", points.size());
  for_each(
      "surface_velocities", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { u(n) = geometry.velocity(body, x(n), motion); });
  return copy_to_host(u);
}

TEST(Bodies, DistanceIsThatOfTheNearestImage) {
  Bodies bodies(scene_of({{{5.5, 3, 1}, 1.5}}), grid, true, {});
  const std::vector<Vec3> points{{-0.9, 3, 1}, {5.5, 8.5, 1}, {5.5, 3, 7.0}, {5.5, 3, 1}};
  const std::vector<Real> d = distances(bodies.geometry(), 0, points);
  EXPECT_NEAR(d[0], 0.6 - 1.5, 1e-14);    // 7 - 6.4 beyond the edge
  EXPECT_NEAR(d[1], 1.375 - 1.5, 1e-14);  // 6.875 - 5.5
  EXPECT_NEAR(d[2], 0.75 - 1.5, 1e-14);
  EXPECT_NEAR(d[3], -1.5, 1e-14);
}

TEST(Bodies, WithoutImagesTheEdgeHidesThem) {
  Bodies bodies(scene_of({{{5.5, 3, 1}, 1.5}}), grid, false, {});
  EXPECT_NEAR(distances(bodies.geometry(), 0, {{-0.9, 3, 1}})[0], 6.4 - 1.5, 1e-14);
}

TEST(Bodies, WideBodiesSeeAllTheirImages) {
  Scene scene;
  SceneInstance bar;
  bar.root = scene.add_leaf("box", std::vector<Real>{3.3, 0.5, 0.5});
  bar.pose.translation = {2.5, 5, 3};
  scene.add_instance(bar);
  Bodies bodies(scene, grid, true, {});
  // 0.4 is left between the bar and its image: at most 0.2 away from one of them
  const std::vector<Real> d = distances(bodies.geometry(), 0, {{-0.95, 5, 3}, {5.85, 5, 3}, {6.0, 5, 3}});
  EXPECT_NEAR(d[0], 0.15, 1e-14);
  EXPECT_NEAR(d[1], 0.05, 1e-14);
  EXPECT_NEAR(d[2], 0.2, 1e-14);
}

TEST(Bodies, VanishedBodiesAreFarAway) {
  Scene scene = scene_of({{{2, 5, 3}, 1.0}});
  Scene::Records records = scene.encode();
  records.instance_reals[7] = 0;  // scale
  const Scene vanished =
      Scene::decode(records.node_ints, records.node_reals, records.instance_ints, records.instance_reals);
  Bodies bodies(vanished, grid, true, {});
  EXPECT_EQ(distances(bodies.geometry(), 0, {{2, 5, 3}})[0], far_away);
  EXPECT_EQ(bodies.region(0, 2).size(), 0);
}

TEST(Bodies, SurfaceVelocityIsRigidAroundTheNearestImage) {
  Bodies bodies(scene_of({{{5.5, 3, 1}, 1.5, {{0.1, 0.2, 0.3}, {0, 0, 2}}}}), grid, true, {});
  const std::vector<Vec3> u = surface_velocities(bodies.geometry(), 0, {{5.5, 4, 1}, {-0.5, 3, 1}});
  EXPECT_NEAR(u[0].x, 0.1 - 2, 1e-14);
  EXPECT_NEAR(u[0].y, 0.2, 1e-14);
  EXPECT_NEAR(u[1].x, 0.1, 1e-14);
  EXPECT_NEAR(u[1].y, 0.2 + 2, 1e-14);  // the arm is 1, not -6
  EXPECT_NEAR(u[1].z, 0.3, 1e-14);
}

TEST(Bodies, CenterFollowsThePoseUntilItIsPinned) {
  Bodies bodies(scene_of({{{2, 5, 3}, 1.0}}), grid, true, {});
  bodies.set_pose(0, {3, 5, 3}, {});
  EXPECT_EQ(bodies[0].center.x, 3);
  EXPECT_FALSE(bodies.center_pinned(0));
  bodies.pin_center(0, {0, 0, 1});
  bodies.set_pose(0, {4, 5, 3}, {});
  EXPECT_EQ(bodies[0].center.x, 0);
  EXPECT_TRUE(bodies.center_pinned(0));
}

TEST(Bodies, KnowWhetherTheyMove) {
  Bodies bodies(scene_of({{{2, 5, 3}, 1.0}, {{4, 5, 3}, 0.5}}), grid, true, {});
  EXPECT_FALSE(bodies.any_moves());
  bodies.set_twist(1, {{0, 0, 0}, {0, 1e-3, 0}});
  EXPECT_FALSE(bodies.moves(0));
  EXPECT_TRUE(bodies.moves(1));
  EXPECT_TRUE(bodies.any_moves());
}

TEST(Bodies, RegionContainsTheBodyAndItsMargin) {
  Bodies bodies(scene_of({{{2.2, 5.1, 3.3}, 1.0}}), grid, true, {});
  const Box region = bodies.region(0, 2);
  const Vec3 low = grid.corner(region.low[0], region.low[1], region.low[2]);
  const Vec3 high = grid.corner(region.high[0], region.high[1], region.high[2]);
  const Vec3 center{2.2, 5.1, 3.3};
  for (int a = 0; a < 3; ++a) {
    EXPECT_LE(low[a], center[a] - 1 - 2 * grid.spacing[a]);
    EXPECT_GE(high[a], center[a] + 1 + 2 * grid.spacing[a]);
    EXPECT_LE(region.extent(a) * grid.spacing[a], 2 + 6 * grid.spacing[a]);  // and not much more
  }
}

TEST(Bodies, RegionStartsInsideTheBoxWhereverTheBodyIs) {
  for (const Real periods : {-3.0, 0.0, 2.0}) {
    Bodies bodies(scene_of({{{5.8 + 7 * periods, 5.1, 3.3}, 1.0}}), grid, true, {});
    const Box region = bodies.region(0, 2);
    EXPECT_GE(region.low[0], 0);
    EXPECT_LT(region.low[0], grid.cells[0]);
    EXPECT_GT(region.high[0], grid.cells[0]);  // reaches across the edge
  }
}

TEST(Bodies, RegionIsClippedWhereThereAreNoImages) {
  Bodies bodies(scene_of({{{5.8, 5.1, 3.3}, 1.0}, {{20, 5.1, 3.3}, 1.0}}), grid, false, {});
  EXPECT_EQ(bodies.region(0, 2).high[0], grid.cells[0]);
  EXPECT_EQ(bodies.region(1, 2).size(), 0);
}

TEST(SampleAllBodies, TheNearestBodyOwnsACell) {
  Bodies bodies(scene_of({{{1, 5, 3}, 1.0}, {{4, 5, 3}, 0.5}}), grid, true, {});
  const Field<Real> distance("distance", Layout(grid.cells));
  const Field<int> owner("owner", Layout(grid.cells));
  sample_all_bodies(grid, bodies.geometry(), 2, {}, distance, owner);
  const std::vector<Real> d = host_values(distance);
  const std::vector<int> who = host_values(owner);
  std::vector<Vec3> centers;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) centers.push_back(grid.cell_center(i, j, k));
  const std::vector<Real> first = distances(bodies.geometry(), 0, centers);
  const std::vector<Real> second = distances(bodies.geometry(), 1, centers);
  for (std::size_t n = 0; n < d.size(); ++n) {
    EXPECT_EQ(d[n], std::min(first[n], second[n]));
    EXPECT_EQ(who[n], second[n] < first[n] ? 1 : 0);
  }
}

TEST(CountImageOverlap, FindsImagesThatReachIntoTheBox) {
  Scene scene;
  const int slab = scene.add_leaf("box", std::vector<Real>{4.5, 5, 5});
  SceneInstance instance;
  instance.root = scene.add_difference(slab, scene.add_leaf("box", std::vector<Real>{2.9, 2.9, 2.9}));
  instance.pose.translation = {2.5, 5.4375, 3.875};
  scene.add_instance(instance);
  Bodies tank(scene, grid, true, {});
  EXPECT_GT(count_image_overlap(grid, tank.geometry(), 1), 0);  // 4.5 + 2.9 > 7
  Bodies sphere(scene_of({{{5.8, 5.1, 3.3}, 1.0}}), grid, true, {});
  EXPECT_EQ(count_image_overlap(grid, sphere.geometry(), 1), 0);
}

TEST(Bodies, MeanTwistLiesBetweenTheFormerAndThePresentOne) {
  Bodies bodies(scene_of({{{5.5, 3, 1}, 1.5, {{0.4, 0, 0}, {0, 0, 0.8}}}}), grid, true, {});
  const std::vector<Vec3> point{{5.5, 4, 1}};
  const auto mean_velocity = [&] { return surface_velocities(bodies.geometry(), 0, point, Motion::Mean)[0]; };
  EXPECT_FALSE(bodies.any_accelerates());
  bodies.set_twist(0, {{0.4, 0.8, 0}, {0, 0, 1.6}});
  EXPECT_TRUE(bodies.any_accelerates());
  bodies.average_twists(0.25);
  EXPECT_NEAR(mean_velocity().x, 0.4 - 1.0, 1e-14);  // spin 0.8 + (1.6 - 0.8) / 4
  EXPECT_NEAR(mean_velocity().y, 0.2, 1e-14);
  bodies.end_step();
  EXPECT_FALSE(bodies.any_accelerates());
  bodies.average_twists(0.25);
  EXPECT_EQ(mean_velocity().x, 0.4 - 1.6);
  EXPECT_EQ(mean_velocity().y, 0.8);
}

}  // namespace
