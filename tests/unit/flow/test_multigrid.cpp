#include "flow/multigrid.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/pressure_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

/// V-cycle applied to a random vector that vanishes in closed cells and has zero mean.
Field<float> apply(const Multigrid& multigrid, const FaceVector<OpenFraction>& open,
                   const Field<Real>& vector) {
  const Int3 n = vector.layout().cells;
  for_cells(n, [&](int i, int j, int k) {
    multigrid.residual()(i, j, k) = is_open_cell(open, i, j, k) ? static_cast<float>(vector(i, j, k)) : 0;
  });
  multigrid.apply();
  const Field<float> result("result", vector.layout());
  Kokkos::deep_copy(result.array(), multigrid.correction().array());
  return result;
}

Real dot_of(const Field<float>& a, const Field<Real>& b) {
  Real sum = 0;
  for_cells(b.layout().cells,
            [&](int i, int j, int k) { sum += static_cast<Real>(a(i, j, k)) * b(i, j, k); });
  return sum;
}

TEST(Multigrid, CycleIsSymmetricAndPositive) {
  for (const Int3& n : {Int3{24, 20, 28}, Int3{33, 17, 21}, Int3{9, 50, 3}, Int3{4, 5, 6}})
    for (const PressureSide side : {PressureSide::Periodic, PressureSide::Closed, PressureSide::Fixed}) {
      PressureSides sides;
      for (auto& axis : sides.side) axis[0] = axis[1] = side;
      const auto open = make_faces(n, sides, spheres(n, {{n[0] / 2., n[1] / 3., n[2] / 2.}}, 2.4));
      Multigrid multigrid(n, {1, 1.2, 0.9}, sides);
      multigrid.set_open_fractions(open, RowRanges(n));
      const Field<Real> a = random_field(n, 31), b = random_field(n, 32);
      for_cells(n, [&](int i, int j, int k) {
        if (!is_open_cell(open, i, j, k)) a(i, j, k) = b(i, j, k) = 0;
      });
      const Field<float> ma = apply(multigrid, open, a), mb = apply(multigrid, open, b);
      const Real scale = std::sqrt(dot_of(ma, a) * dot_of(mb, b));
      EXPECT_GT(dot_of(ma, a), 0);
      // Single precision inside.
      EXPECT_NEAR(dot_of(ma, b), dot_of(mb, a), 1e-5 * scale);
    }
}

TEST(Multigrid, CycleIsSymmetricAndKeepsGroupsApart) {
  const Int3 n{37, 26, 28};
  const int wall = 18;
  const auto walls = [](int axis, int i, int, int) {
    return axis == 0 && (i == 0 || i == wall) ? OpenFraction{0} : fully_open;
  };
  const auto open = make_faces(n, PressureSides(), walls);
  const Field<unsigned char> group("group", Layout(n));
  for_cells(n, [&](int i, int j, int k) { group(i, j, k) = i < wall; });
  Multigrid multigrid(n, {1, 1, 1}, PressureSides());
  multigrid.set_open_fractions(open, RowRanges(n));
  multigrid.set_groups({Box{{wall, 0, 0}, n}, Box{{0, 0, 0}, {wall, n[1], n[2]}}}, group);
  const Field<Real> a = random_field(n, 36), b = random_field(n, 37);
  const Field<float> ma = apply(multigrid, open, a), mb = apply(multigrid, open, b);
  const Real scale = std::sqrt(dot_of(ma, a) * dot_of(mb, b));
  EXPECT_GT(dot_of(ma, a), 0);
  EXPECT_NEAR(dot_of(ma, b), dot_of(mb, a), 1e-5 * scale);
  for_cells(n, [&](int i, int j, int k) {
    if (i < wall) a(i, j, k) = 0;
  });
  const Field<float> part = apply(multigrid, open, a);
  for_cells(n, [&](int i, int j, int k) {
    EXPECT_EQ(part(i, j, k), i < wall ? 0 : ma(i, j, k)) << i << " " << j << " " << k;
  });
}

TEST(Multigrid, ReturnsTheProductOfCorrectionAndResidual) {
  const Int3 n{30, 26, 22};
  const auto open = make_faces(n, PressureSides(), all_open());
  Multigrid multigrid(n, {1, 1, 1}, PressureSides());
  multigrid.set_open_fractions(open, RowRanges(n));
  const Field<Real> a = random_field(n, 33);
  const Field<float> ma = apply(multigrid, open, a);
  EXPECT_NEAR(multigrid.apply(), dot_of(ma, a), 1e-5 * dot_of(ma, a));
}

TEST(Multigrid, ResultDoesNotDependOnWhatWasThereBefore) {
  const Int3 n{30, 26, 22};
  const auto open = make_faces(n, PressureSides(), spheres(n, {{10, 11, 12}}, 5));
  Multigrid multigrid(n, {1, 1, 1}, PressureSides());
  multigrid.set_open_fractions(open, RowRanges(n));
  const Field<Real> a = random_field(n, 34), b = random_field(n, 35);
  const Field<float> first = apply(multigrid, open, a);
  apply(multigrid, open, b);
  const Field<float> second = apply(multigrid, open, a);
  for_cells(n, [&](int i, int j, int k) { EXPECT_EQ(first(i, j, k), second(i, j, k)); });
}

}  // namespace
}  // namespace peclet::flow
