// A function is the signed distance of a solid exactly if its sign tells inside from outside, it changes no
// faster than the distance between two points, and from every point it leads to a point of the surface.
#include "core/sdf_primitives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace peclet;

struct Solid {
  const char* name;
  Opcode opcode;
  std::vector<Real> parameters;
  std::function<bool(Vec3)> contains;  // strictly inside, from the inequality that defines the solid
  Real size;
};

Real hypot2(Real a, Real b) { return std::sqrt(a * a + b * b); }

std::vector<Solid> exact_solids() {
  const auto tube = [](Real radial, Real axial, Real inner, Real outer, Real height) {
    return radial < outer && (radial > inner || inner == 0) && std::abs(axial) < height / 2;
  };
  const auto cone = [](Vec3 p, Real bottom, Real top, Real h) {
    return std::abs(p.y) < h && hypot2(p.x, p.z) < bottom + (top - bottom) * (p.y + h) / (2 * h);
  };
  const auto ellipsoid = [](Vec3 p, Vec3 r) {
    return std::pow(p.x / r.x, 2) + std::pow(p.y / r.y, 2) + std::pow(p.z / r.z, 2) < 1;
  };
  const auto torus = [](Vec3 p, Real ring, Real tube_radius) {
    return hypot2(hypot2(p.x, p.z) - ring, p.y) < tube_radius;
  };
  return {
      {"sphere", Opcode::Sphere, {1.3}, [](Vec3 p) { return norm(p) < 1.3; }, 1.3},
      {"hollow cylinder",
       Opcode::HollowCylinder,
       {1.2, 1.6, 0.5},
       [=](Vec3 p) { return tube(hypot2(p.x, p.z), p.y, 0.7, 1.2, 1.6); },
       1.5},
      {"solid cylinder",
       Opcode::HollowCylinder,
       {1.2, 1.6, 1.2},
       [=](Vec3 p) { return tube(hypot2(p.x, p.z), p.y, 0, 1.2, 1.6); },
       1.5},
      {"box",
       Opcode::Box,
       {1.1, 0.6, 0.8},
       [](Vec3 p) { return std::abs(p.x) < 1.1 && std::abs(p.y) < 0.6 && std::abs(p.z) < 0.8; },
       1.4},
      {"shell",
       Opcode::HollowCylinderShell,
       {1.2, 0.9, 1.0},
       [=](Vec3 p) { return tube(hypot2(p.x, p.y), p.z, 0.9, 1.2, 1.0); },
       1.3},
      {"solid shell",
       Opcode::HollowCylinderShell,
       {1.2, 0, 1.0},
       [=](Vec3 p) { return tube(hypot2(p.x, p.y), p.z, 0, 1.2, 1.0); },
       1.3},
      {"capsule",
       Opcode::Capsule,
       {0.4, 0.9},
       [](Vec3 p) { return norm(Vec3{p.x, p.y - std::clamp(p.y, -0.9, 0.9), p.z}) < 0.4; },
       1.3},
      {"torus", Opcode::Torus, {1.0, 0.3}, [=](Vec3 p) { return torus(p, 1.0, 0.3); }, 1.3},
      {"spindle torus", Opcode::Torus, {0.5, 0.9}, [=](Vec3 p) { return torus(p, 0.5, 0.9); }, 1.4},
      {"truncated cone", Opcode::Cone, {1.1, 0.4, 0.7}, [=](Vec3 p) { return cone(p, 1.1, 0.4, 0.7); }, 1.3},
      {"inverted cone", Opcode::Cone, {0.0, 1.5, 0.4}, [=](Vec3 p) { return cone(p, 0.0, 1.5, 0.4); }, 1.5},
      {"cylinder as a cone",
       Opcode::Cone,
       {0.8, 0.8, 0.7},
       [=](Vec3 p) { return cone(p, 0.8, 0.8, 0.7); },
       1.1},
      {"ellipsoid",
       Opcode::Ellipsoid,
       {1.3, 0.5, 0.8},
       [=](Vec3 p) { return ellipsoid(p, {1.3, 0.5, 0.8}); },
       1.3},
      {"disc-like ellipsoid",
       Opcode::Ellipsoid,
       {1.3, 0.05, 1.3},
       [=](Vec3 p) { return ellipsoid(p, {1.3, 0.05, 1.3}); },
       1.3},
      {"needle-like ellipsoid",
       Opcode::Ellipsoid,
       {0.02, 0.02, 1.3},
       [=](Vec3 p) { return ellipsoid(p, {0.02, 0.02, 1.3}); },
       1.3},
  };
}

std::vector<Solid> superquadrics() {
  std::vector<Solid> solids;
  for (Real e : {0.5, 0.8, 1.0, 1.5, 2.0, 4.0, 20.0})
    solids.push_back({"superquadric",
                      Opcode::Superquadric,
                      {1.3, 0.6, 0.9, e},
                      [e](Vec3 p) {
                        return std::pow(std::abs(p.x / 1.3), e) + std::pow(std::abs(p.y / 0.6), e) +
                                   std::pow(std::abs(p.z / 0.9), e) <
                               1;
                      },
                      1.4});
  return solids;
}

sdf::Parameters padded(const std::vector<Real>& values) {
  sdf::Parameters parameters{};
  std::copy(values.begin(), values.end(), &parameters[0]);
  return parameters;
}

Real distance(const Solid& solid, Vec3 p) {
  return sdf::leaf_distance<Real>(solid.opcode, p.x, p.y, p.z, padded(solid.parameters));
}

sdf::Dual dual_distance(const Solid& solid, Vec3 p) {
  using sdf::Dual;
  return sdf::leaf_distance<Dual>(solid.opcode, Dual{p.x, {1, 0, 0}}, Dual{p.y, {0, 1, 0}},
                                  Dual{p.z, {0, 0, 1}}, padded(solid.parameters));
}

/// Points all over the neighbourhood, on the symmetry planes and on the axes.
std::vector<Vec3> points_around(const Solid& solid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> coordinate(-2 * solid.size, 2 * solid.size);
  std::vector<Vec3> points{{0, 0, 0}};
  for (int n = 0; n < 4000; ++n) {
    Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
    for (int axis = 0; axis < 3; ++axis)
      if (n % 16 < 8 && (n >> axis) & 1) p[axis] = 0;
    points.push_back(n % 3 ? p : 0.5 * p);
  }
  return points;
}

TEST(SdfPrimitives, SignTellsInsideFromOutside) {
  auto solids = exact_solids();
  for (const Solid& s : superquadrics()) solids.push_back(s);
  for (const Solid& solid : solids)
    for (const Vec3& p : points_around(solid)) {
      const Real d = distance(solid, p);
      if (std::abs(d) <= 1e-12) continue;
      EXPECT_EQ(d < 0, solid.contains(p)) << solid.name << " at " << p.x << " " << p.y << " " << p.z;
    }
}

TEST(SdfPrimitives, DistanceChangesNoFasterThanTheWayGone) {
  for (const Solid& solid : exact_solids()) {
    const auto points = points_around(solid);
    for (std::size_t n = 1; n < points.size(); ++n) {
      const Vec3 p = points[n], q = n % 2 ? points[n - 1] : p + 1e-3 * points[n - 1];
      EXPECT_LE(std::abs(distance(solid, p) - distance(solid, q)), norm(p - q) + 1e-13) << solid.name;
    }
  }
}

TEST(SdfPrimitives, GradientLeadsToTheSurface) {
  for (const Solid& solid : exact_solids())
    for (const Vec3& p : points_around(solid)) {
      const sdf::Dual d = dual_distance(solid, p);
      EXPECT_NEAR(d.value, distance(solid, p), 1e-14);
      // a few dozen roundings of numbers of order one
      EXPECT_NEAR(norm(d.gradient), 1, 1e-12) << solid.name;
      EXPECT_NEAR(distance(solid, p - d.value * d.gradient), 0, 1e-12)
          << solid.name << " at " << p.x << " " << p.y << " " << p.z;
    }
}

TEST(SdfPrimitives, SuperquadricIsADistanceToFirstOrder) {
  for (const Solid& solid : superquadrics()) {
    const Real e = solid.parameters[3];
    std::mt19937 random(3);
    std::uniform_real_distribution<Real> angle(0.15, 0.85);
    for (int n = 0; n < 200; ++n) {
      // a surface point with all coordinates well away from zero, and its normal
      Vec3 s{angle(random), angle(random), angle(random)};
      s = s / std::pow(std::pow(s.x, e) + std::pow(s.y, e) + std::pow(s.z, e), 1 / e);
      const Vec3 p{1.3 * s.x, 0.6 * s.y, 0.9 * s.z};
      const Vec3 normal = normalized(
          Vec3{std::pow(s.x, e - 1) / 1.3, std::pow(s.y, e - 1) / 0.6, std::pow(s.z, e - 1) / 0.9});
      EXPECT_NEAR(distance(solid, p), 0, 1e-14) << e;
      for (Real step : {1e-5, -1e-5})  // the error is of second order, its factor the curvature
        EXPECT_NEAR(distance(solid, p + step * normal) / step, 1, 1e-2) << e;
    }
  }
}

TEST(SdfPrimitives, SuperquadricWithExponentTwoIsDeepestInTheCentre) {
  const Solid solid = superquadrics()[4];
  EXPECT_DOUBLE_EQ(distance(solid, {0, 0, 0}), -0.6);
}

TEST(SdfPrimitives, EllipsoidAgreesWithTheSphere) {
  for (const Vec3& p : points_around(exact_solids()[0])) {
    const Real sphere = sdf::leaf_distance<Real>(Opcode::Sphere, p.x, p.y, p.z, {1.3});
    const Real ellipsoid = sdf::leaf_distance<Real>(Opcode::Ellipsoid, p.x, p.y, p.z, {1.3, 1.3, 1.3});
    EXPECT_NEAR(ellipsoid, sphere, 1e-14);
  }
}

}  // namespace
