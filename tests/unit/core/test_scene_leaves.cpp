#include "core/scene_leaves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/scene_sampling.hpp"

namespace {

using namespace peclet;

struct Case {
  const char* kind;
  std::vector<Real> parameters;
};

const std::vector<Case> cases{{"sphere", {1.5}},
                              {"box", {1, 2, 0.5}},
                              {"capsule", {0.5, 1}},
                              {"torus", {2, 0.5}},
                              {"cone", {1, 0.2, 1.5}},
                              {"ellipsoid", {2, 1, 0.5}},
                              {"hollow_cylinder", {1, 3, 0.2}},
                              {"hollow_cylinder_shell", {1, 0.5, 3}},
                              {"superquadric", {2, 1, 0.5, 1.5}},
                              {"superquadric", {2, 1, 0.5, 5}},
                              {"superquadric", {2, 1, 0.5, 0.7}}};

/// Smallest distance on the plane at x[axis] = value inside the box.
Real nearest_on_plane(const Scene& scene, const Scene::Bounds& box, int axis, Real value) {
  constexpr int points = 301;
  std::vector<Real> x, d(points * points);
  const Vec3 size = box.high - box.low;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      Vec3 p;
      p[axis] = value;
      p[b] = box.low[b] + size[b] * i / (points - 1);
      p[c] = box.low[c] + size[c] * j / (points - 1);
      x.insert(x.end(), {p.x, p.y, p.z});
    }
  sample_root(scene, 0, x, d);
  return *std::min_element(d.begin(), d.end());
}

TEST(SceneLeaves, BoundsTouchTheLeafWhateverItsRotation) {
  for (const Case& c : cases) {
    Scene scene;
    scene.add_leaf(c.kind, c.parameters, {{1, 2, 3}, {0.3, -0.2, 0.5, 0.8}, 1.5});
    const Scene::Bounds box = scene.bounds(0);
    for (int axis = 0; axis < 3; ++axis)
      for (Real face : {box.low[axis], box.high[axis]}) {
        const Real nearest = nearest_on_plane(scene, box, axis, face);
        EXPECT_GE(nearest, -1e-12) << c.kind;
        EXPECT_LE(nearest, 0.02) << c.kind;  // the lattice misses the point of contact by up to 0.02
      }
  }
}

TEST(SceneLeaves, CodesAndNamesBelongTogether) {
  ASSERT_EQ(leaf_kinds().size(), 9u);
  for (const LeafKind& kind : leaf_kinds()) {
    EXPECT_EQ(leaf_kind(static_cast<int>(kind.opcode)), &kind);
    EXPECT_EQ(&leaf_kind(kind.name), &kind);
  }
  EXPECT_EQ(leaf_kind(32), nullptr);
  EXPECT_EQ(leaf_kind(0), nullptr);
}

}  // namespace
