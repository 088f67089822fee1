#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene.hpp"

namespace {

using namespace peclet;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

Scene example() {
  Scene scene;
  const std::vector<Real> sphere{1.5}, cone{2, 1, 0.5};
  scene.add_leaf("sphere", sphere, {{1, 2, 3}});
  scene.add_leaf("cone", cone, {{}, {0.1, 0.2, 0.3, 0.9}, 2});
  scene.add_difference(0, 1, {{4, 5, 6}});
  scene.add_instance({.root = 2, .material = 3, .pose = {{7, 8, 9}}, .twist = {{1, 2, 3}, {4, 5, 6}}});
  scene.add_instance({.root = 0, .center = {1, 1, 2}, .center_pinned = true});
  return scene;
}

Scene decode(const Scene::Records& r) {
  return Scene::decode(r.node_ints, r.node_reals, r.instance_ints, r.instance_reals);
}

/// The message after one change to valid records.
template <class Change>
std::string error_after(const Change& change) {
  Scene::Records records = example().encode();
  change(records);
  try {
    decode(records);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SceneRecords, HaveTheDocumentedLayout) {
  const Scene::Records r = example().encode();
  EXPECT_EQ(r.node_ints, (std::vector<int>{1, -1, -1, 7, -1, -1, 34, 0, 1}));
  ASSERT_EQ(r.node_reals.size(), 3u * 16);
  EXPECT_EQ(r.node_reals[0], 1.5);
  EXPECT_EQ(r.node_reals[8], 1);
  EXPECT_EQ(r.node_reals[14], 1);       // w of the identity
  EXPECT_EQ(r.node_reals[16 + 15], 2);  // scale
  EXPECT_EQ(r.node_reals[32], 1);       // column 0 of an operation
  EXPECT_EQ(r.instance_ints, (std::vector<int>{2, 3, 0, -1}));
  ASSERT_EQ(r.instance_reals.size(), 2u * 18);
  EXPECT_EQ(r.instance_reals[6], 1);
  EXPECT_EQ(r.instance_reals[7], 1);
  EXPECT_EQ(r.instance_reals[10], 3);
  EXPECT_EQ(r.instance_reals[11], 4);
  EXPECT_TRUE(std::isnan(r.instance_reals[14]));
  EXPECT_EQ(r.instance_reals[17], 0);
  EXPECT_EQ(r.instance_reals[18 + 16], 2);
  EXPECT_EQ(r.instance_reals[18 + 17], 1);
}

TEST(SceneRecords, SurviveARoundTrip) {
  const Scene::Records before = example().encode(), after = decode(before).encode();
  EXPECT_EQ(before.node_ints, after.node_ints);
  EXPECT_EQ(before.instance_ints, after.instance_ints);
  for (std::size_t n = 0; n < before.node_reals.size(); ++n)
    EXPECT_DOUBLE_EQ(before.node_reals[n], after.node_reals[n]);
  for (std::size_t n = 0; n < before.instance_reals.size(); ++n) {
    if (std::isnan(before.instance_reals[n])) continue;  // a centre that follows
    EXPECT_DOUBLE_EQ(before.instance_reals[n], after.instance_reals[n]);
  }
}

TEST(SceneRecords, OfAnEmptySceneAreEmpty) {
  const Scene::Records r = Scene().encode();
  EXPECT_TRUE(r.node_ints.empty() && r.node_reals.empty() && r.instance_ints.empty() &&
              r.instance_reals.empty());
  EXPECT_EQ(decode(r).number_of_nodes(), 0);
}

TEST(SceneRecords, SeventeenColumnsPinACenterThatIsNotZero) {
  const Scene::Records r = example().encode();
  std::vector<Real> reals(2 * 17, 0.0);
  for (int n = 0; n < 2; ++n) reals[n * 17 + 6] = reals[n * 17 + 7] = 1;
  reals[17 + 15] = 4;
  const Scene scene = Scene::decode(r.node_ints, r.node_reals, r.instance_ints, reals);
  EXPECT_FALSE(scene.instances()[0].center_pinned);
  EXPECT_TRUE(scene.instances()[1].center_pinned);
  EXPECT_EQ(scene.instances()[1].center.y, 4);
}

TEST(SceneRecords, EighteenthColumnDecidesWhetherTheCenterIsPinned) {
  Scene::Records r = example().encode();
  for (int column = 14; column < 17; ++column) r.instance_reals[column] = 0;
  EXPECT_FALSE(decode(r).instances()[0].center_pinned);
  r.instance_reals[17] = 1;
  EXPECT_TRUE(decode(r).instances()[0].center_pinned);
}

TEST(SceneRecords, AnInstanceMayVanishButANodeMayNot) {
  Scene::Records r = example().encode();
  r.instance_reals[7] = 0;
  EXPECT_EQ(decode(r).instances()[0].pose.scale, 0);
  r.node_reals[15] = 0;
  EXPECT_THROW(decode(r), std::invalid_argument);
}

TEST(SceneRecords, ChildrenMayComeLaterButNotContainTheirParent) {
  Scene::Records r = example().encode();
  // node 0 becomes the union of 1 and 1, node 2 the difference of 0 and 1
  r.node_ints[0] = 32;
  r.node_ints[1] = r.node_ints[2] = 1;
  EXPECT_EQ(decode(r).nodes()[0].left, 1);
  r.node_ints[2] = 2;
  EXPECT_THROW(decode(r), std::invalid_argument);
  r.node_ints[2] = 0;
  EXPECT_THROW(decode(r), std::invalid_argument);
}

TEST(SceneRecords, EveryDefectIsNamed) {
  using R = Scene::Records;
  const auto expect = [](const char* part, const std::string& message) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' does not name " << part;
  };
  expect("opcode", error_after([](R& r) { r.node_ints[0] = 10; }));
  expect("child", error_after([](R& r) { r.node_ints[7] = 3; }));
  expect("child", error_after([](R& r) { r.node_ints[8] = -1; }));
  expect("children", error_after([](R& r) { r.node_ints[1] = 1; }));
  expect("parameters", error_after([](R& r) { r.node_reals[0] = -1; }));
  expect("parameters", error_after([](R& r) { r.node_reals[1] = 1; }));
  expect("node 0: translation", error_after([](R& r) { r.node_reals[9] = nan; }));
  expect("node 1: rotation", error_after([](R& r) { std::fill_n(&r.node_reals[16 + 11], 4, 0.0); }));
  expect("scale", error_after([](R& r) { r.node_reals[15] = -1; }));
  expect("node_ints", error_after([](R& r) { r.node_ints.pop_back(); }));
  expect("node_reals", error_after([](R& r) { r.node_reals.pop_back(); }));
  expect("17 or 18", error_after([](R& r) { r.instance_reals.pop_back(); }));
  expect("instance 0: root", error_after([](R& r) { r.instance_ints[0] = 3; }));
  expect("material", error_after([](R& r) { r.instance_ints[1] = -2; }));
  expect("instance 1: rotation", error_after([](R& r) { r.instance_reals[18 + 6] = 0; }));
  expect("scale", error_after([](R& r) { r.instance_reals[7] = -1; }));
  expect("lin_vel", error_after([](R& r) { r.instance_reals[8] = nan; }));
  expect("ang_vel", error_after([](R& r) { r.instance_reals[13] = nan; }));
  expect("center", error_after([](R& r) { r.instance_reals[14] = 0; }));
  expect("center", error_after([](R& r) { r.instance_reals[17] = 1; }));
  expect("column 17", error_after([](R& r) { r.instance_reals[17] = 2; }));
}

}  // namespace
