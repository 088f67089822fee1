#include "core/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>

namespace {

using namespace peclet;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

int add(Scene& scene, const std::string& kind, std::vector<Real> parameters, const Pose& pose = {}) {
  return scene.add_leaf(kind, parameters, pose);
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Scene, NumbersNodesAndInstancesFromZero) {
  Scene scene;
  EXPECT_EQ(add(scene, "sphere", {1}), 0);
  EXPECT_EQ(add(scene, "box", {1, 2, 3}), 1);
  EXPECT_EQ(scene.add_union(0, 1), 2);
  EXPECT_EQ(scene.add_reframed(2, {{1, 0, 0}}), 3);
  EXPECT_EQ(scene.add_instance({.root = 2}), 0);
  EXPECT_EQ(scene.add_instance({.root = 0}), 1);
}

TEST(Scene, UnknownKindListsTheKinds) {
  Scene scene;
  const std::string message = message_of([&] { add(scene, "ball", {1}); });
  for (const char* name : {"ball", "sphere", "hollow_cylinder", "hollow_cylinder_shell", "superquadric"})
    EXPECT_NE(message.find(name), std::string::npos) << message;
}

TEST(Scene, RejectsWrongParametersAndStaysAsItWas) {
  Scene scene;
  EXPECT_THROW(add(scene, "sphere", {}), std::invalid_argument);
  EXPECT_THROW(add(scene, "sphere", {1, 2}), std::invalid_argument);
  EXPECT_THROW(add(scene, "sphere", {0}), std::invalid_argument);
  EXPECT_THROW(add(scene, "box", {1, -1, 1}), std::invalid_argument);
  EXPECT_THROW(add(scene, "box", {1, nan, 1}), std::invalid_argument);
  EXPECT_THROW(add(scene, "hollow_cylinder", {1, 1, 1.5}), std::invalid_argument);
  EXPECT_THROW(add(scene, "hollow_cylinder_shell", {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(add(scene, "cone", {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(add(scene, "superquadric", {1, 1, 1}), std::invalid_argument);
  EXPECT_EQ(scene.number_of_nodes(), 0);
}

TEST(Scene, RejectsWrongPoses) {
  Scene scene;
  EXPECT_THROW(add(scene, "sphere", {1}, {{nan, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(add(scene, "sphere", {1}, {{}, {0, 0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(add(scene, "sphere", {1}, {{}, {}, 0}), std::invalid_argument);
  EXPECT_THROW(add(scene, "sphere", {1}, {{}, {}, -1}), std::invalid_argument);
  add(scene, "sphere", {1});
  EXPECT_THROW(scene.add_reframed(0, {{}, {}, 0}), std::invalid_argument);
  EXPECT_THROW(scene.add_instance({.pose = {{}, {}, 0}}), std::invalid_argument);
  EXPECT_EQ(scene.number_of_nodes() + scene.number_of_instances(), 1);
}

TEST(Scene, RejectsNodesThatDoNotExist) {
  Scene scene;
  add(scene, "sphere", {1});
  EXPECT_THROW(scene.add_union(0, 1), std::invalid_argument);
  EXPECT_THROW(scene.add_difference(-1, 0), std::invalid_argument);
  EXPECT_THROW(scene.add_reframed(5, {}), std::invalid_argument);
  EXPECT_THROW(scene.add_instance({.root = 1}), std::invalid_argument);
  EXPECT_THROW(scene.bounds(1), std::invalid_argument);
}

TEST(Scene, NormalisesQuaternions) {
  Scene scene;
  add(scene, "box", {1, 2, 3}, {{}, {0, 0, 0, 2}});
  add(scene, "box", {1, 2, 3}, {{}, {3e200, 0, 0, 4e200}});
  EXPECT_DOUBLE_EQ(scene.nodes()[0].pose.rotation.w, 1);
  EXPECT_DOUBLE_EQ(scene.nodes()[1].pose.rotation.x, 0.6);
}

TEST(Scene, CenterOfRotationFollowsUnlessPinned) {
  SceneInstance instance;
  instance.pose.translation = {1, 2, 3};
  instance.center = {7, 8, 9};
  EXPECT_EQ(instance.center_of_rotation().y, 2);
  instance.center_pinned = true;
  EXPECT_EQ(instance.center_of_rotation().y, 8);
}

TEST(SceneBounds, FollowTheOperations) {
  Scene scene;
  const int a = add(scene, "box", {1, 1, 1}), b = add(scene, "box", {1, 1, 1}, {{1.5, 0, 0}});
  const int far = add(scene, "sphere", {1}, {{10, 0, 0}});
  EXPECT_EQ(scene.bounds(scene.add_union(a, b)).high.x, 2.5);
  EXPECT_EQ(scene.bounds(scene.add_intersection(a, b)).low.x, 0.5);
  EXPECT_EQ(scene.bounds(scene.add_difference(a, b)).high.x, 1);
  const int nothing = scene.add_intersection(a, far);
  EXPECT_TRUE(scene.bounds(nothing).is_empty());
  EXPECT_EQ(scene.bounds(scene.add_union(nothing, b)).low.x, 0.5);
}

TEST(SceneBounds, ApplyThePoseOfNodeAndInstance) {
  Scene scene;
  const int a = add(scene, "box", {1, 2, 3}, {{1, 0, 0}});
  const int moved = scene.add_union(a, a, {{0, 5, 0}, normalized(Quaternion{0, 0, 1, 1}), 2});
  const Scene::Bounds box = scene.bounds(moved, {{0, 0, 100}, {}, 0.5});
  // the quarter turn maps (x, y) to (-y, x)
  EXPECT_NEAR(box.low.x, -2, 1e-14);
  EXPECT_NEAR(box.high.y, 2.5 + 2, 1e-14);
  EXPECT_NEAR(box.high.z, 103, 1e-14);
}

TEST(SceneFlatten, RefusesToRepeatTooManyLeaves) {
  Scene scene;
  int node = add(scene, "sphere", {1});
  for (int n = 0; n < 15; ++n) node = scene.add_union(node, node);
  EXPECT_EQ(flatten(scene.nodes(), node).leaves.size(), 32768u);
  node = scene.add_union(node, node);
  EXPECT_THROW(flatten(scene.nodes(), node), std::invalid_argument);
  for (int n = 0; n < 60; ++n) node = scene.add_union(node, node);
  EXPECT_THROW(flatten(scene.nodes(), node), std::invalid_argument);
}

TEST(SceneFlatten, NeedsLittleStackForLongChains) {
  Scene scene;
  int left = add(scene, "sphere", {1}), right = left;
  const int leaf = left;
  for (int n = 0; n < 10000; ++n)
    left = scene.add_union(left, leaf), right = scene.add_difference(leaf, right);
  for (int root : {left, right}) {
    int depth = 0, deepest = 0;
    for (int step : flatten(scene.nodes(), root).steps) {
      depth += step >= 0 ? 1 : -1;
      deepest = std::max(deepest, depth);
    }
    EXPECT_EQ(depth, 1);
    EXPECT_EQ(deepest, 2);
  }
}

}  // namespace
