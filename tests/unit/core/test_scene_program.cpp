#include "core/scene_program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/field_transfer.hpp"
#include "core/loop.hpp"

namespace {

using namespace peclet;

const Pose tilted{{0.3, -0.2, 0.5}, normalized(Quaternion{0.1, -0.4, 0.2, 0.7}), 1.7};
const Pose shifted{{-0.5, 0.4, 0.1}, normalized(Quaternion{0.3, 0.2, -0.6, 0.1}), 0.6};

int add(Scene& scene, const std::string& kind, std::vector<Real> parameters, const Pose& pose = {}) {
  return scene.add_leaf(kind, parameters, pose);
}

std::vector<Vec3> random_points(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<Real> coordinate(-3, 3);
  std::vector<Vec3> points;
  for (int n = 0; n < count; ++n)
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return points;
}

std::vector<Real> distances(const SceneProgram& program, int slot, const Pose& pose,
                            const std::vector<Vec3>& points) {
  const Array<Vec3> x = copy_from_host("x", points);
  const Array<Real> d("d", points.size());
  for_each(
      "distances", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { d(n) = program.distance(slot, pose, x(n)); });
  return copy_to_host(d);
}

std::vector<Vec3> gradients(const SceneProgram& program, int slot, const Pose& pose,
                            const std::vector<Vec3>& points) {
  const Array<Vec3> x = copy_from_host("x", points);
  const Array<Vec3> g("g", points.size());
  for_each(
      "gradients", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { g(n) = program.gradient(slot, pose, x(n)); });
  return copy_to_host(g);
}

std::vector<Real> distances(const Scene& scene, int root, const std::vector<Vec3>& points) {
  return distances(SceneProgram(scene, {root}), 0, {}, points);
}

void expect_equal(const std::vector<Real>& a, const std::vector<Real>& b, Real tolerance = 1e-14) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n], b[n], tolerance);
}

TEST(SceneProgram, SphereIsExactOnTheLattice) {
  Scene scene;
  const SceneProgram program(scene, {add(scene, "sphere", {4})});
  const Pose at_eight{{8, 8, 8}};
  EXPECT_EQ(distances(program, 0, at_eight, {{8, 8, 8}, {4, 8, 8}, {8, 12, 8}}),
            (std::vector<Real>{-4, 0, 0}));
}

TEST(SceneProgram, SetOperationsHoldForMembership) {
  Scene scene;
  const int a = add(scene, "box", {1, 0.7, 1.2}, tilted), b = add(scene, "sphere", {1.1}, shifted);
  const auto points = random_points(500);
  const auto in_a = distances(scene, a, points), in_b = distances(scene, b, points);
  const auto both = distances(scene, scene.add_union(a, b), points);
  const auto common = distances(scene, scene.add_intersection(a, b), points);
  const auto rest = distances(scene, scene.add_difference(a, b), points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    EXPECT_EQ(both[n] < 0, in_a[n] < 0 || in_b[n] < 0);
    EXPECT_EQ(common[n] < 0, in_a[n] < 0 && in_b[n] < 0);
    EXPECT_EQ(rest[n] < 0, in_a[n] < 0 && in_b[n] > 0);
  }
}

TEST(SceneProgram, DifferenceDoesNotDependOnTheOrderOfEvaluation) {
  Scene scene;
  const int a = add(scene, "box", {1, 1, 1}), b = add(scene, "sphere", {1.2}),
            c = add(scene, "sphere", {0.4});
  const int b_and_c = scene.add_union(b, c);  // deeper than a, so it is evaluated first; c lies inside b
  const auto points = random_points(200);
  expect_equal(distances(scene, scene.add_difference(a, b_and_c), points),
               distances(scene, scene.add_difference(a, b), points), 0);
}

TEST(SceneProgram, TransformOfAnOperationMovesBothChildren) {
  Scene scene;
  const int a = add(scene, "box", {1, 0.7, 1.2}, shifted), b = add(scene, "cone", {1, 0.2, 1}, tilted);
  const int whole = scene.add_difference(a, b, tilted);
  const int moved_a = scene.add_reframed(a, tilted), moved_b = scene.add_reframed(b, tilted);
  const auto points = random_points(200);
  expect_equal(distances(scene, whole, points),
               distances(scene, scene.add_difference(moved_a, moved_b), points));
}

TEST(SceneProgram, PlacingABodyIsReframingIt) {
  Scene scene;
  const int a = add(scene, "box", {1, 0.7, 1.2}, shifted), moved = scene.add_reframed(a, tilted);
  const auto points = random_points(200);
  expect_equal(distances(SceneProgram(scene, {a}), 0, tilted, points), distances(scene, moved, points));
}

TEST(SceneProgram, ScaleScalesDistances) {
  Scene scene;
  const int small = add(scene, "cone", {1, 0.2, 1}), large = add(scene, "cone", {3, 0.6, 3});
  const auto points = random_points(200);
  expect_equal(distances(SceneProgram(scene, {small}), 0, {{}, {}, 3}, points),
               distances(scene, large, points));
}

TEST(SceneProgram, PositiveRotationTurnsXTowardsY) {
  Scene scene;
  const Real half = std::acos(-1.0) / 12;  // half of 30 degrees
  const int arm = add(scene, "box", {2, 0.1, 0.1}, {{}, {0, 0, std::sin(half), std::cos(half)}});
  const auto d =
      distances(scene, arm,
                {{std::cos(2 * half), std::sin(2 * half), 0}, {std::cos(2 * half), -std::sin(2 * half), 0}});
  EXPECT_NEAR(d[0], -0.1, 1e-14);
  EXPECT_GT(d[1], 0.5);
}

TEST(SceneProgram, VanishedBodyIsFarAway) {
  Scene scene;
  const SceneProgram program(scene, {add(scene, "sphere", {4})});
  EXPECT_EQ(distances(program, 0, {{8, 8, 8}, {}, 0}, {{8, 8, 8}})[0], far_away);
}

TEST(SceneProgram, SlotsFollowTheListOfRoots) {
  Scene scene;
  const int a = add(scene, "sphere", {1}), b = add(scene, "sphere", {2});
  const int c = scene.add_union(a, b);
  const SceneProgram program(scene, {b, a, b, c, a});
  ASSERT_EQ(program.number_of_slots(), 5);
  const Real radii[] = {2, 1, 2, 2, 1};
  for (int slot = 0; slot < 5; ++slot)
    EXPECT_EQ(distances(program, slot, {}, {{0, 0, 5}})[0], 5 - radii[slot]);
}

TEST(SceneProgram, DeepTreesFitTheStack) {
  // a complete binary tree of spheres along x; their union is as far as the nearest of them
  Scene scene;
  std::vector<int> level;
  for (int n = 0; n < 4096; ++n) level.push_back(add(scene, "sphere", {0.25}, {{1.0 * n, 0, 0}}));
  while (level.size() > 1) {
    std::vector<int> next;
    for (std::size_t n = 0; n < level.size(); n += 2) next.push_back(scene.add_union(level[n], level[n + 1]));
    level = next;
  }
  const auto d = distances(scene, level[0], {{17, 0, 0}, {4095, 3, 0}, {100.5, 0, 0}});
  expect_equal(d, {-0.25, 2.75, 0.25});
}

TEST(SceneProgram, GradientIsTheChangeOfTheDistance) {
  Scene scene;
  const int a = add(scene, "box", {1, 0.7, 1.2}, tilted), b = add(scene, "torus", {1.1, 0.3}, shifted);
  const int c = add(scene, "superquadric", {0.9, 1.3, 0.6, 3}, shifted);
  const int root = scene.add_difference(scene.add_union(a, c, shifted), b, tilted);
  const SceneProgram program(scene, {root});
  const auto points = random_points(300);
  const auto slopes = gradients(program, 0, tilted, points);
  constexpr Real step = 1e-5;
  int kinks = 0;
  for (int axis = 0; axis < 3; ++axis) {
    auto before = points, after = points;
    for (std::size_t n = 0; n < points.size(); ++n) {
      before[n][axis] -= step;
      after[n][axis] += step;
    }
    const auto low = distances(program, 0, tilted, before), high = distances(program, 0, tilted, after);
    for (std::size_t n = 0; n < points.size(); ++n)
      kinks += std::abs((high[n] - low[n]) / (2 * step) - slopes[n][axis]) > 1e-6;
  }
  EXPECT_LE(kinks, 3);  // a difference across a kink is wrong; hardly any point is that close to one
}

TEST(SceneProgram, RefusesRootsThatDoNotExist) {
  Scene scene;
  add(scene, "sphere", {1});
  EXPECT_THROW(SceneProgram(scene, {0, 1}), std::invalid_argument);
}

}  // namespace
