#include "dem/walls.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "dem/wall_features.hpp"
#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

/// Box of half extents (3, 4, 5) around the origin; inverted it is a room.
int add_box(Walls& walls, bool invert) {
  Scene scene;
  const Real half[] = {3, 4, 5};
  scene.add_leaf("box", half);
  const Scene::Records records = scene.encode();
  return walls.add_scene(records.node_ints, records.node_reals, 0, invert, 0, 0);
}

/// Contacts of one sphere of radius 1 after a step that does not move it.
int contacts_at(Simulation& simulation, Vec3 x) {
  simulation.particles().set_positions(testing::flat({x}), 3);
  return static_cast<int>(simulation.census().number_of_contacts);
}

TEST(Walls, ARoomTouchesASphereAtAsManyFacesAsItSitsAt) {
  Simulation simulation(1);
  simulation.particles().set_shape_radius(1);
  add_box(simulation.walls(), true);
  EXPECT_EQ(contacts_at(simulation, {0, 0, 0}), 0);
  EXPECT_EQ(contacts_at(simulation, {1.98, 0, 0}), 1);
  EXPECT_EQ(contacts_at(simulation, {1.98, -2.97, 0}), 2);
  EXPECT_EQ(contacts_at(simulation, {1.98, -2.97, 3.99}), 3);
}

TEST(Walls, ABoxTouchesASphereOnceAtItsEdgesAndCorners) {
  Simulation simulation(1);
  simulation.particles().set_shape_radius(1);
  add_box(simulation.walls(), false);
  EXPECT_EQ(contacts_at(simulation, {3.99, 0, 0}), 1);
  EXPECT_EQ(contacts_at(simulation, {3.7, 4.7, 0}), 1);
  EXPECT_EQ(contacts_at(simulation, {3.57, 4.57, 5.57}), 1);
  EXPECT_EQ(contacts_at(simulation, {4.2, 0, 0}), 0);
}

TEST(Walls, DistancesFollowTheTransformAndTheSide) {
  Walls walls;
  const int box = add_box(walls, false), room = add_box(walls, true);
  const std::vector<Real> point{4, 0, 0};
  EXPECT_DOUBLE_EQ(walls.distances(box, point)[0], 1);
  EXPECT_DOUBLE_EQ(walls.distances(room, point)[0], -1);
  walls.set_transform(box, {1, 0, 0}, {0, 0, 1, 1});  // a quarter turn about z: the long side lies along x
  EXPECT_NEAR(walls.distances(box, point)[0], -1, 1e-15);
  EXPECT_DOUBLE_EQ(walls.distances(room, point)[0], -1);
}

TEST(Walls, RefuseWhatMakesNoSense) {
  Walls walls;
  add_box(walls, false);
  EXPECT_THROW(walls.add_plane({0, 0, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(walls.set_transform(1, {0, 0, 0}, {}), std::invalid_argument);
  EXPECT_THROW(walls.set_transform(0, {0, 0, 0}, {0, 0, 0, 0}), std::invalid_argument);
  const std::vector<int> ints{1, -1, -1};
  EXPECT_THROW(walls.add_scene(ints, std::vector<Real>(5), 0, false, 0, 0), std::invalid_argument);
  EXPECT_EQ(walls.number_of_scenes(), 1);
}

}  // namespace
}  // namespace peclet::dem
