#include "flow/solid_sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bodies_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();

/// A slab whose upper side is the plane through point with this normal; the rest of it is far away.
Scene half_space(Vec3 point, Vec3 normal) {
  Scene scene;
  SceneInstance instance;
  instance.root = scene.add_leaf("box", std::vector<Real>{50, 50, 50});
  // turns z into the normal
  const Vec3 axis = cross({0, 0, 1}, normal);
  const Quaternion turn = normalized(Quaternion{axis.x, axis.y, axis.z, 1 + normal.z});
  instance.pose = {point - 50 * normal, turn, 1};
  scene.add_instance(instance);
  return scene;
}

SolidSampler sampler_of(Bodies& bodies) {
  SolidSampler solid;
  solid.geometry = bodies.geometry();
  solid.grid = grid;
  return solid;
}

/// Opening of the low face of cell (5, 4, 3) along axis: open, closed_s, closed_t.
std::vector<Real> opening(const SolidSampler& solid, int axis) {
  const Array<Real> result("opening", 3);
  for_each(
      "opening", 1, KOKKOS_LAMBDA(Index) {
        const FaceOpening face = face_opening(solid, axis, 5, 4, 3, 0, 0);
        result(0) = face.open;
        result(1) = face.closed_s;
        result(2) = face.closed_t;
      });
  return copy_to_host(result);
}

Real crossing(const SolidSampler& solid, Vec3 from, Vec3 to) {
  const Array<Real> result("crossing", 1);
  for_each("crossing", 1, KOKKOS_LAMBDA(Index) { result(0) = wall_crossing(solid, 0, 0, from, to); });
  return copy_to_host(result)[0];
}

TEST(FaceOpening, IsOneWithoutSolidAndZeroInside) {
  for (const Real side : {-1.0, 1.0}) {
    const Vec3 center = grid.face_center(0, 5, 4, 3);
    Bodies bodies(half_space(center + Vec3{0, 0, 10 * side}, {0, 0, 1}), grid, false, {});
    EXPECT_EQ(opening(sampler_of(bodies), 0)[0], side < 0 ? 1 : 0);
  }
}

TEST(FaceOpening, IsExactWhereAPlaneCutsParallelToAnEdge) {
  for (int axis = 0; axis < 3; ++axis) {
    const int s = (axis + 1) % 3;
    Vec3 normal, point = grid.face_center(axis, 5, 4, 3);
    normal[s] = 1;
    point[s] += 0.2 * grid.spacing[s];  // solid up to 0.2 beyond the middle
    Bodies bodies(half_space(point, normal), grid, false, {});
    const std::vector<Real> face = opening(sampler_of(bodies), axis);
    EXPECT_NEAR(face[0], 0.3, 1e-12);
    EXPECT_NEAR(face[1], -0.15, 1e-12);  // middle of the closed strip from -0.5 to 0.2
    EXPECT_NEAR(face[2], 0, 1e-12);
  }
}

TEST(FaceOpening, IsExactWhereAPlaneCutsACornerOff) {
  // s + t < -0.7 in units of the edges is solid: a triangle with legs of 0.3
  const int axis = 2, s = 0, t = 1;
  Vec3 normal{1 / grid.spacing[0], 1 / grid.spacing[1], 0};
  Vec3 point = grid.face_center(axis, 5, 4, 3);
  point[s] -= 0.35 * grid.spacing[s];
  point[t] -= 0.35 * grid.spacing[t];
  Bodies bodies(half_space(point, normalized(normal)), grid, false, {});
  const std::vector<Real> face = opening(sampler_of(bodies), axis);
  EXPECT_NEAR(face[0], 1 - 0.5 * 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(face[1], -0.5 + 0.1, 1e-12);
  EXPECT_NEAR(face[2], -0.5 + 0.1, 1e-12);
}

TEST(FaceOpening, OfFluidAndSolidExchangedAddsToOne) {
  const Vec3 normal = normalized(Vec3{0.3, -0.7, 0.6});
  for (const Real offset : {-0.2, 0.0, 0.13}) {
    const Vec3 point = grid.face_center(1, 5, 4, 3) + offset * normal;
    Bodies solid(half_space(point, normal), grid, false, {}),
        fluid(half_space(point, -normal), grid, false, {});
    const Real sum = opening(sampler_of(solid), 1)[0] + opening(sampler_of(fluid), 1)[0];
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(WallCrossing, FindsTheSurfaceOfASphere) {
  Bodies bodies(scene_of({{{2, 5, 3}, 1.3}}), grid, true, {});
  const SolidSampler solid = sampler_of(bodies);
  const Vec3 from{3.5, 5.1, 3.2}, to{3.0, 5.1, 3.2};
  const Vec3 wall = from + crossing(solid, from, to) * (to - from);
  EXPECT_NEAR(norm(wall - Vec3{2, 5, 3}), 1.3, 1e-8 * norm(to - from));
}

TEST(WallCrossing, FindsTheSurfaceOfASphereThatASegmentGrazes) {
  const Vec3 center{2, 5, 3};
  for (const bool has_images : {false, true}) {
    Bodies bodies(scene_of({{center, 1.3}}), grid, has_images, {});
    const SolidSampler solid = sampler_of(bodies);
    for (const Real depth : {1e-2, 1e-4, 1e-6}) {
      const Vec3 from{2.4, 5, 4.3 - depth}, to{2.0, 5, 4.3 - depth};
      const Vec3 wall = from + crossing(solid, from, to) * (to - from);
      EXPECT_NEAR(norm(wall - center), 1.3, 1e-9 * norm(to - from));
      EXPECT_GT(wall.x, to.x);
    }
  }
}

TEST(WallCrossing, IsTheEndOfTheSegmentWhereItMeetsNoWall) {
  Bodies bodies(scene_of({{{2, 5, 3}, 1.3}}), grid, true, {});
  const SolidSampler solid = sampler_of(bodies);
  EXPECT_EQ(crossing(solid, {4.5, 5, 3}, {4.0, 5, 3}), 1);
  EXPECT_EQ(crossing(solid, {3.0, 5, 3}, {2.5, 5, 3}), 0);  // starts inside
}

/// Interpolated samples of a linear function at points inside the outermost cell centres.
std::vector<Real> interpolated(const SolidSampler& solid, const std::vector<Vec3>& points) {
  const Field<Real> samples = solid.samples;
  const Grid box = solid.grid;
  for_each_cell(
      "linear_samples", RowRanges(box.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Vec3 x = box.cell_center(i, j, k);
        samples(i, j, k) = 1 + 2 * x.x - 3 * x.y + 0.5 * x.z;
      });
  const Array<Vec3> x = copy_from_host("points", points);
  const Array<Real> values("values", points.size());
  for_each(
      "interpolated", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { values(n) = solid.distance(sampled_solid, x(n)); });
  return copy_to_host(values);
}

TEST(SampledSolid, IsInterpolatedExactlyIfLinear) {
  Bodies none(Scene(), grid, true, {});
  SolidSampler solid = sampler_of(none);
  solid.samples = Field<Real>("samples", Layout(grid.cells));
  const std::vector<Vec3> points{{0.3, 4.4, 2.2}, {2.71, 6.1, 5.5}, {-0.7, 2.4, 1.0}};
  const std::vector<Real> values = interpolated(solid, points);
  for (std::size_t n = 0; n < points.size(); ++n)
    EXPECT_NEAR(values[n], 1 + 2 * points[n].x - 3 * points[n].y + 0.5 * points[n].z, 1e-12);
}

}  // namespace
