#include "core/mass_properties.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace {

using namespace peclet;

constexpr Real pi = std::numbers::pi;

const Pose tilted{{0.3, -0.2, 0.5}, normalized(Quaternion{0.1, -0.4, 0.2, 0.7}), 1.3};

int add(Scene& scene, const std::string& kind, std::vector<Real> parameters, const Pose& pose = {}) {
  return scene.add_leaf(kind, parameters, pose);
}

MassSettings box_of(Real half, int cells = 8, Real density = 1) {
  return {.low = {-half, -half, -half}, .high = {half, half, half}, .cells = cells, .density = density};
}

Real matrix_difference(const Matrix3& a, const Matrix3& b) {
  Real largest = 0;
  for (std::size_t n = 0; n < 9; ++n)
    largest = std::max(largest, std::abs(a[n / 3][n % 3] - b[n / 3][n % 3]));
  return largest;
}

struct Case {
  const char* kind;
  std::vector<Real> parameters;
  Real volume;
  Vec3 inertia;    // closed form
  Real tolerance;  // smooth solids converge fast, edges with the square of the finest cells
};

std::vector<Case> closed_forms() {
  const Real cylinder = pi * 1.5, cylinder_across = cylinder * (3 + 1.5 * 1.5) / 12;
  return {
      {"sphere", {1}, 4 * pi / 3, 4 * pi / 3 * Vec3{0.4, 0.4, 0.4}, 1e-8},
      {"ellipsoid",
       {1, 0.7, 0.4},
       4 * pi / 3 * 0.28,
       4 * pi / 3 * 0.28 / 5 * Vec3{0.49 + 0.16, 1 + 0.16, 1 + 0.49},
       1e-7},
      {"box", {1, 0.7, 0.4}, 8 * 0.28, 8 * 0.28 / 3 * Vec3{0.49 + 0.16, 1 + 0.16, 1 + 0.49}, 1e-5},
      {"torus",
       {1, 0.3},
       2 * pi * pi * 0.09,
       2 * pi * pi * 0.09 * Vec3{0.5 + 0.625 * 0.09, 1 + 0.75 * 0.09, 0.5 + 0.625 * 0.09},
       1e-6},
      {"hollow_cylinder", {1, 1.5, 1}, cylinder, {cylinder_across, cylinder / 2, cylinder_across}, 1e-5},
  };
}

TEST(MassProperties, MatchClosedForms) {
  for (const Case& c : closed_forms()) {
    Scene scene;
    const MassProperties body = mass_properties(scene, add(scene, c.kind, c.parameters), box_of(2));
    EXPECT_NEAR(body.volume / c.volume, 1, c.tolerance) << c.kind;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(body.inertia[axis][axis] / c.inertia[axis], 1, c.tolerance) << c.kind;
      EXPECT_NEAR(body.center[axis], 0, 1e-11) << c.kind;  // rounding of a sum over many cells
    }
  }
}

TEST(MassProperties, AreThoseOfTheBodyWhereverItIs) {
  for (const Case& c : closed_forms()) {
    Scene scene;
    const MassProperties body = mass_properties(scene, add(scene, c.kind, c.parameters, tilted), box_of(4));
    EXPECT_NEAR(body.volume / (c.volume * std::pow(1.3, 3)), 1, 5 * c.tolerance) << c.kind;
    EXPECT_NEAR(norm(body.center - tilted.translation), 0, 5 * c.tolerance) << c.kind;
    std::array<Real, 3> moments{c.inertia.x, c.inertia.y, c.inertia.z};
    std::sort(moments.begin(), moments.end());
    for (int n = 0; n < 3; ++n)
      EXPECT_NEAR(body.principal[n] / (moments[n] * std::pow(1.3, 5)), 1, 5 * c.tolerance) << c.kind;
  }
}

TEST(MassProperties, ScaleWithDensity) {
  Scene scene;
  const int root = add(scene, "ellipsoid", {1, 0.7, 0.4}, tilted);
  const MassProperties light = mass_properties(scene, root, box_of(3, 8)),
                       heavy = mass_properties(scene, root, box_of(3, 8, 7));
  EXPECT_EQ(light.volume, heavy.volume);
  EXPECT_DOUBLE_EQ(heavy.mass, 7 * light.mass);
  EXPECT_DOUBLE_EQ(heavy.principal.z, 7 * light.principal.z);
}

TEST(MassProperties, OfPartsAddUpToTheWhole) {
  Scene scene;
  const int a = add(scene, "sphere", {1}), b = add(scene, "sphere", {0.8}, {{0.9, 0.1, 0.2}});
  const auto volume = [&](int root) { return mass_properties(scene, root, box_of(3)).volume; };
  const Real both = volume(scene.add_union(a, b)), common = volume(scene.add_intersection(a, b));
  const Real rest = volume(scene.add_difference(a, b));
  // the edges where the spheres meet limit the accuracy
  EXPECT_NEAR(both + common, volume(a) + volume(b), 2e-5);
  EXPECT_NEAR(rest + common, volume(a), 2e-5);
}

TEST(MassProperties, SuperquadricsMatchTheirVolume) {
  // V = 8 a b c Gamma(1 + 1/e)^3 / Gamma(1 + 3/e)
  for (Real e : {0.7, 2.0, 4.0}) {
    Scene scene;
    const int root = add(scene, "superquadric", {1, 0.7, 0.5, e});
    const Real volume = 8 * 0.35 * std::pow(std::tgamma(1 + 1 / e), 3) / std::tgamma(1 + 3 / e);
    EXPECT_NEAR(mass_properties(scene, root, box_of(1, 4)).volume / volume, 1, 1e-3) << e;
  }
}

TEST(MassProperties, PrincipalFrameDiagonalisesTheInertia) {
  Scene scene;
  const int root =
      scene.add_union(add(scene, "ellipsoid", {1, 0.5, 0.3}, tilted), add(scene, "sphere", {0.5}));
  const MassProperties body = mass_properties(scene, root, box_of(3));
  const int framed = scene.add_reframed(root, principal_frame(body));
  const MassProperties again = mass_properties(scene, framed, box_of(3));
  EXPECT_NEAR(norm(again.center), 0, 1e-5);
  EXPECT_LT(
      matrix_difference(again.inertia,
                        {{{body.principal.x, 0, 0}, {0, body.principal.y, 0}, {0, 0, body.principal.z}}}),
      1e-5);
}

TEST(MassProperties, RefuseABoxThatCutsTheBody) {
  Scene scene;
  const int ball = add(scene, "sphere", {1});
  const int tip = scene.add_union(ball, add(scene, "sphere", {0.05}, {{2.5, 0, 0}}));
  EXPECT_THROW(mass_properties(scene, ball, box_of(0.99)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, tip, box_of(2)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, ball, {.low = {2, 2, 2}, .high = {3, 3, 3}}), std::invalid_argument);
  EXPECT_NO_THROW(mass_properties(scene, ball, box_of(1, 2)));
}

TEST(MassProperties, AcceptABoxAroundABodyWithLooseBounds) {
  Scene scene;
  // The bounds of the intersection are those of the overlapping boxes; the lens itself is much smaller.
  const int lens = scene.add_intersection(add(scene, "sphere", {1}, {{-0.9, 0, 0}}),
                                          add(scene, "sphere", {1}, {{0.9, 0, 0}}));
  const Real lens_volume = 2 * pi * 0.01 * (3 - 0.1) / 3;
  const MassSettings box{.low = {-0.2, -0.6, -0.6}, .high = {0.2, 0.6, 0.6}};
  EXPECT_NEAR(mass_properties(scene, lens, box).volume / lens_volume, 1, 1e-5);
}

TEST(MassProperties, RefuseBodiesWithoutVolumeAndWrongSettings) {
  Scene scene;
  const int a = add(scene, "sphere", {1}), far = add(scene, "sphere", {1}, {{5, 0, 0}});
  EXPECT_THROW(mass_properties(scene, scene.add_intersection(a, far), box_of(8)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, scene.add_difference(a, a), box_of(8, 4)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, 17, box_of(2)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, a, box_of(2, 0)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, a, box_of(-2)), std::invalid_argument);
  EXPECT_THROW(mass_properties(scene, a, box_of(2, 4, -1)), std::invalid_argument);
  MassSettings settings = box_of(2);
  settings.order = 0;
  EXPECT_THROW(mass_properties(scene, a, settings), std::invalid_argument);
  settings = box_of(2);
  settings.segments = 33;
  EXPECT_THROW(mass_properties(scene, a, settings), std::invalid_argument);
}

TEST(MassProperties, EveryOrderIntegratesTheSphere) {
  Scene scene;
  const int root = add(scene, "sphere", {1}, tilted);
  const Real volume = 4 * pi / 3 * std::pow(1.3, 3);
  for (int order = 1; order <= 16; ++order) {
    MassSettings settings = box_of(3, 8);
    settings.order = order;
    EXPECT_NEAR(mass_properties(scene, root, settings).volume / volume, 1, order < 3 ? 1e-2 : 1e-5) << order;
  }
}

}  // namespace
