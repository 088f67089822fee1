#include <gtest/gtest.h>

#include <cmath>

#include "core/mass_properties.hpp"

namespace {

using namespace peclet;

Matrix3 matrix_of(Quaternion q) {
  Matrix3 m;
  for (int column = 0; column < 3; ++column) {
    Vec3 axis;
    axis[column] = 1;
    const Vec3 image = rotate(q, axis);
    for (int row = 0; row < 3; ++row) m[row][column] = image[row];
  }
  return m;
}

/// R diag(moments) R^T
Matrix3 inertia_of(Vec3 moments, const Matrix3& r) {
  Matrix3 m{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int n = 0; n < 3; ++n) m[a][b] += r[a][n] * moments[n] * r[b][n];
  return m;
}

const Quaternion tilt = normalized(Quaternion{0.3, -0.2, 0.5, 0.8});

TEST(PrincipalAxes, FindTheMomentsInAscendingOrder) {
  const PrincipalAxes found = principal_axes(inertia_of({5, 2, 3}, matrix_of(tilt)));
  EXPECT_NEAR(found.moments.x, 2, 1e-14);
  EXPECT_NEAR(found.moments.y, 3, 1e-14);
  EXPECT_NEAR(found.moments.z, 5, 1e-14);
}

TEST(PrincipalAxes, ReproduceTheMatrixAndAreRightHanded) {
  for (Vec3 moments : {Vec3{5, 2, 3}, Vec3{1, 1, 3}, Vec3{2, 1e-6, 2}, Vec3{4, 4, 4}}) {
    const Matrix3 inertia = inertia_of(moments, matrix_of(tilt));
    const PrincipalAxes found = principal_axes(inertia);
    const Matrix3 again = inertia_of(found.moments, found.axes);
    const Matrix3 unit = inertia_of({1, 1, 1}, found.axes);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        EXPECT_NEAR(again[a][b], inertia[a][b], 1e-8);  // equal moments may differ by the tolerance
        EXPECT_NEAR(unit[a][b], a == b, 1e-14);
      }
    const auto column = [&](int c) { return Vec3{found.axes[0][c], found.axes[1][c], found.axes[2][c]}; };
    EXPECT_NEAR(dot(cross(column(0), column(1)), column(2)), 1, 1e-14);
  }
}

TEST(PrincipalAxes, EqualMomentsKeepTheCoordinateAxes) {
  Matrix3 inertia = inertia_of({2, 2, 2}, matrix_of({}));
  inertia[0][1] = inertia[1][0] = 1e-13;
  inertia[2][2] -= 1e-13;
  const PrincipalAxes found = principal_axes(inertia);
  for (int n = 0; n < 3; ++n) EXPECT_EQ(found.axes[n][n], 1);
}

TEST(QuaternionOf, IsTheRotationOfTheMatrix) {
  for (Quaternion q :
       {Quaternion{}, tilt, Quaternion{1, 0, 0, 0}, Quaternion{0, 1, 0, 0}, Quaternion{0, 0, 1, 0},
        normalized(Quaternion{1, 1, 1, -1e-9}), normalized(Quaternion{0.2, 0.9, 0.1, -0.3})}) {
    const Quaternion found = quaternion_of(matrix_of(q));
    const Vec3 v{0.3, -1.2, 0.7};
    EXPECT_NEAR(norm(rotate(found, v) - rotate(q, v)), 0, 1e-14);
    EXPECT_GE(found.w, 0);
  }
}

}  // namespace
