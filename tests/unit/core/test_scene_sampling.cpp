#include "core/scene_sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/scene_program.hpp"

namespace {

using namespace peclet;

Scene two_spheres() {
  Scene scene;
  const std::vector<Real> radius{1};
  scene.add_leaf("sphere", radius);
  scene.add_instance({.root = 0, .pose = {{-3, 0, 0}}});
  scene.add_instance({.root = 0, .pose = {{4, 0, 0}, {}, 2}});
  return scene;
}

TEST(SceneSampling, WorldIsTheNearestInstance) {
  const std::vector<Real> points{0, 0, 0, -3, 0, 0, 4, 0, 5};
  std::vector<Real> found(3);
  sample_scene(two_spheres(), points, found);
  EXPECT_EQ(found, (std::vector<Real>{2, -1, 3}));
}

TEST(SceneSampling, WithoutInstancesEverythingIsFarAway) {
  Scene scene;
  std::vector<Real> found(1);
  sample_scene(scene, std::vector<Real>{0, 0, 0}, found);
  EXPECT_EQ(found[0], far_away);
}

TEST(SceneSampling, LatticeHasXFastest) {
  const Lattice lattice{{2, 3, 4}, {0, 0, 0}, {1, 10, 100}};
  std::vector<float> found(24);
  sample_root(two_spheres(), 0, lattice, found);
  EXPECT_FLOAT_EQ(found[0], -1);
  EXPECT_FLOAT_EQ(found[1], 0);
  EXPECT_FLOAT_EQ(found[2], 9);
  EXPECT_FLOAT_EQ(found[6], 99);
}

TEST(SceneSampling, GradientsComeAsTriples) {
  const std::vector<Real> points{0, 2, 0, 0, 0, -5};
  std::vector<Real> found(2), gradients(6);
  sample_root(two_spheres(), 0, points, found, gradients);
  EXPECT_EQ(found, (std::vector<Real>{1, 4}));
  EXPECT_EQ(gradients, (std::vector<Real>{0, 1, 0, 0, 0, -1}));
}

}  // namespace
