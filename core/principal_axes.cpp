#include <algorithm>
#include <cmath>

#include "core/mass_properties.hpp"

namespace peclet {

namespace {

constexpr Real negligible = 1e-9;  // of the trace: far above rounding, far below any real asymmetry

/// Rotate the plane (p, q) so that a[p][q] vanishes [GolubVanLoan2013, section 8.5].
void jacobi_rotation(Matrix3& a, Matrix3& axes, int p, int q) {
  const Real theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const Real t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const Real c = 1 / std::sqrt(t * t + 1), s = t * c;
  const auto turn = [c, s](Real& x, Real& y) {
    const Real old = x;
    x = c * old - s * y;
    y = s * old + c * y;
  };
  for (int n = 0; n < 3; ++n) turn(a[n][p], a[n][q]);
  for (int n = 0; n < 3; ++n) turn(a[p][n], a[q][n]);
  for (int n = 0; n < 3; ++n) turn(axes[n][p], axes[n][q]);
}

Real largest_component_sign(const Matrix3& axes, int column) {
  Real largest = 0;
  for (int n = 0; n < 3; ++n)
    if (std::abs(axes[n][column]) > std::abs(largest) * (1 + negligible)) largest = axes[n][column];
  return largest < 0 ? -1 : 1;
}

}  // namespace

PrincipalAxes principal_axes(const Matrix3& symmetric) {
  Matrix3 a = symmetric, axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Real scale = std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]);
  for (int sweep = 0; sweep < 50; ++sweep) {
    // While all off-diagonal entries are negligible at the start nothing turns; once turning, it goes to the
    // end.
    const Real off = std::max({std::abs(a[0][1]), std::abs(a[0][2]), std::abs(a[1][2])});
    if (off <= (sweep == 0 ? negligible : 1e-16) * scale) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q)
        if (a[p][q] != 0) jacobi_rotation(a, axes, p, q);
  }
  std::array<int, 3> order{0, 1, 2};
  for (int n = 1; n < 3; ++n)
    for (int m = n; m > 0 && a[order[m]][order[m]] < a[order[m - 1]][order[m - 1]] - negligible * scale; --m)
      std::swap(order[m], order[m - 1]);

  PrincipalAxes result;
  for (int column = 0; column < 2; ++column) {
    const Real sign = largest_component_sign(axes, order[column]);
    for (int n = 0; n < 3; ++n) result.axes[n][column] = sign * axes[n][order[column]];
  }
  const auto column = [&result](int c) {
    return Vec3{result.axes[0][c], result.axes[1][c], result.axes[2][c]};
  };
  const Vec3 third = cross(column(0), column(1));
  for (int n = 0; n < 3; ++n) {
    result.axes[n][2] = third[n];
    result.moments[n] = a[order[n]][order[n]];
  }
  return result;
}

/// [Shepperd1978]: divides by the largest component.
Quaternion quaternion_of(const Matrix3& m) {
  const Real trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > std::max({m[0][0], m[1][1], m[2][2]})) {
    return normalized(Quaternion{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace});
  }
  int a = 0;
  if (m[1][1] > m[a][a]) a = 1;
  if (m[2][2] > m[a][a]) a = 2;
  const int b = (a + 1) % 3, c = (a + 2) % 3;
  Real vector[3];
  vector[a] = 1 + m[a][a] - m[b][b] - m[c][c];
  vector[b] = m[a][b] + m[b][a];
  vector[c] = m[a][c] + m[c][a];
  Quaternion q{vector[0], vector[1], vector[2], m[c][b] - m[b][c]};
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  return normalized(q);
}

}  // namespace peclet
