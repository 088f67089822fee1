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

/// All marks are what the fractions say.
void expect_marks(const LevelOperator<OpenFraction>& op, const FaceVector<OpenFraction>& open) {
  const Layout& layout = open.x.layout();
  for_cells(layout.cells, [&](int first, int j, int k) {
    if (first % Layout::alignment != 0) return;
    bool expected = first + Layout::alignment <= layout.cells[0];
    for (int i = first; expected && i < first + Layout::alignment; ++i)
      for (int axis = 0; axis < 3; ++axis)
        for (const Index step : {Index{0}, layout.stride(axis)})
          expected = expected && open[axis][layout(i, j, k) + step] == fully_open;
    ASSERT_EQ(op.row<float>(j, k).is_open_vector(first), expected) << first << " " << j << " " << k;
  });
}

TEST(Multigrid, MarksOfOpenVectorsFollowTheFractions) {
  if (!runs_on_host) GTEST_SKIP() << "no marks";
  for (const PressureSide side : {PressureSide::Periodic, PressureSide::Closed, PressureSide::Fixed}) {
    const Int3 n{75, 26, 22};
    PressureSides sides;
    for (auto& axis : sides.side) axis[0] = axis[1] = side;
    const bool periodic = side == PressureSide::Periodic;
    const Box second = periodic ? Box{{38, 18, 14}, {53, 33, 29}} : Box{{38, 11, 6}, {53, 26, 21}};
    const Vec3 centre = periodic ? Vec3{45, 25, 21} : Vec3{45, 18, 13};
    const auto before = spheres(n, {{40, 11, 12}}, 5), after = spheres(n, {centre}, 5);
    const auto open = make_faces(n, sides, before);
    Multigrid multigrid(n, {1, 1, 1}, sides);
    multigrid.set_open_fractions(open, RowRanges(n));
    expect_marks(multigrid.finest_operator(), open);
    const auto moved = make_faces(n, sides, after);
    for (int axis = 0; axis < 3; ++axis) Kokkos::deep_copy(open[axis].array(), moved[axis].array());
    multigrid.update({Box{{33, 4, 5}, {48, 19, 20}}, second});
    expect_marks(multigrid.finest_operator(), open);
  }
}

TEST(Multigrid, OpenVectorsAreSmoothedLikeAnyOthersButForRounding) {
  const Int3 n{75, 26, 22};
  const auto open = make_faces(n, PressureSides(), spheres(n, {{40, 11, 12}}, 5));
  Multigrid multigrid(n, {1, 1.2, 0.9}, PressureSides());
  multigrid.set_open_fractions(open, RowRanges(n));
  const Field<Real> vector = random_field(n, 38);
  const auto smoothed = [&](bool with_marks) {
    LevelOperator<OpenFraction> op = multigrid.finest_operator();
    if (!with_marks) op.open_vectors = nullptr;
    const Layout layout(n);
    const LevelFields fields{{"rhs", layout}, {"solution", layout}, {"scratch", layout}};
    for_cells(n, [&](int i, int j, int k) {
      fields.rhs(i, j, k) = is_open_cell(open, i, j, k) ? static_cast<float>(vector(i, j, k)) : 0;
    });
    smooth_from_zero(op, multigrid.plan(), multigrid.rows(), fields);
    smooth(op, multigrid.plan(), multigrid.rows(), fields);
    return fields.solution;
  };
  const Field<float> found = smoothed(true), expected = smoothed(false);
  // values of order one, a few dozen roundings of single precision
  for_cells(n, [&](int i, int j, int k) { EXPECT_NEAR(found(i, j, k), expected(i, j, k), 3e-6); });
}

}  // namespace
}  // namespace peclet::flow
