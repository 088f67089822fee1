#include "flow/pressure_solver.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/pressure_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

constexpr PressureSide periodic = PressureSide::Periodic, closed = PressureSide::Closed,
                       fixed = PressureSide::Fixed;

struct Solution {
  Field<Real> phi;
  SolveReport report;
};

Solution solve(const Grid& grid, const PressureSides& sides, const FaceVector<OpenFraction>& open,
               const Field<Real>& rhs, Real tolerance) {
  PressureSolver solver(grid, sides);
  solver.set_open_fractions(open, RowRanges(grid.cells));
  Solution solution{Field<Real>("phi", Layout(grid.cells)), {}};
  PressureSettings settings;
  settings.relative_tolerance = tolerance;
  solution.report = solver.solve(rhs, solution.phi, settings);
  return solution;
}

Real norm_of(const Field<Real>& field) {
  Real sum = 0;
  for_cells(field.layout().cells, [&](int i, int j, int k) { sum += field(i, j, k) * field(i, j, k); });
  return std::sqrt(sum);
}

/// 2-norm of the residual by the definition of the equation, with means[region of the cell] removed.
template <class Mean>
Real residual_norm(const FaceVector<OpenFraction>& open, const Field<Real>& rhs, const Field<Real>& phi,
                   const Real3& h, const Mean& mean) {
  Real sum = 0;
  for_cells(rhs.layout().cells, [&](int i, int j, int k) {
    if (!is_open_cell(open, i, j, k)) return;
    const Real r = laplacian_at(open, phi, h, i, j, k) - (rhs(i, j, k) - mean(i, j, k));
    sum += r * r;
  });
  return std::sqrt(sum);
}

Real largest_difference(const Field<Real>& a, const Field<Real>& b) {
  Real largest = 0;
  for_cells(a.layout().cells,
            [&](int i, int j, int k) { largest = std::max(largest, std::abs(a(i, j, k) - b(i, j, k))); });
  return largest;
}

/// phi minus its mean over open cells.
Field<Real> centred(const FaceVector<OpenFraction>& open, const Field<Real>& phi) {
  const Int3 n = phi.layout().cells;
  Real sum = 0, count = 0;
  for_cells(n, [&](int i, int j, int k) {
    if (!is_open_cell(open, i, j, k)) return;
    sum += phi(i, j, k);
    ++count;
  });
  const Field<Real> result("centred", phi.layout());
  for_cells(n, [&](int i, int j, int k) {
    result(i, j, k) = is_open_cell(open, i, j, k) ? phi(i, j, k) - sum / count : 0;
  });
  return result;
}

Real manufactured_error(const Int3& cells) {
  const Grid grid{cells, {1.0 / cells[0], 0.7 / cells[1], 1.3 / cells[2]}, {0, 0, 0}};
  const Real kx = 2 * M_PI, ky = 2 * M_PI / 0.7, kz = 4 * M_PI / 1.3;
  const auto exact = [&](Vec3 x) {
    return std::sin(kx * x.x) * std::cos(ky * x.y) * std::sin(kz * x.z + 0.3);
  };
  const Field<Real> rhs("rhs", Layout(cells));
  for_cells(cells, [&](int i, int j, int k) {
    rhs(i, j, k) = -(kx * kx + ky * ky + kz * kz) * exact(grid.cell_center(i, j, k));
  });
  const PressureSides sides;
  const auto open = make_faces(cells, sides, all_open());
  const Field<Real> phi = centred(open, solve(grid, sides, open, rhs, 1e-10).phi);
  Real error = 0;
  for_cells(cells, [&](int i, int j, int k) {
    error = std::max(error, std::abs(phi(i, j, k) - exact(grid.cell_center(i, j, k))));
  });
  return error;
}

TEST(PressureSolver, ConvergesAtSecondOrderWithUnequalSpacings) {
  const Real coarse = manufactured_error({16, 12, 22}), fine = manufactured_error({32, 24, 44});
  EXPECT_LT(fine, 0.03);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(PressureSolver, SatisfiesTheDiscreteEquationToTheToleranceItReports) {
  const Int3 n{21, 18, 26};
  const Grid grid{n, {0.5, 0.6, 0.4}, {0, 0, 0}};
  for (const PressureSides& sides :
       {PressureSides(), sides_of(closed, fixed, periodic, closed), sides_of(fixed, fixed, fixed, fixed)})
    for (const Real tolerance : {1e-3, 1e-6, 1e-10, 1e-12}) {
      const auto open = make_faces(n, sides, spheres(n, {{7, 8, 9}, {14, 9, 20}}, 4.3));
      Field<Real> rhs = random_field(n, 3);
      for_cells(n, [&](int i, int j, int k) {
        if (!is_open_cell(open, i, j, k)) rhs(i, j, k) = 0;
      });
      if (sides.is_periodic(0)) rhs = centred(open, rhs);
      const Solution s = solve(grid, sides, open, rhs, tolerance);
      EXPECT_TRUE(s.report.converged) << tolerance;
      EXPECT_LE(s.report.residual, tolerance);
      const auto none = [](int, int, int) { return Real{0}; };
      const Real found = residual_norm(open, rhs, s.phi, grid.spacing, none) / norm_of(rhs);
      // The two evaluations differ by rounding: 1e-16 of the diagonal times phi.
      EXPECT_NEAR(found, s.report.residual, 1e-3 * tolerance + 1e-14);
    }
}

TEST(PressureSolver, HonoursTheLimitOnTheLargestResidual) {
  const Int3 n{24, 20, 28};
  const Grid grid{n, {1, 1, 1}, {0, 0, 0}};
  const PressureSides sides;
  const auto open = make_faces(n, sides, all_open());
  PressureSolver solver(grid, sides);
  solver.set_open_fractions(open, RowRanges(n));
  const Field<Real> rhs = random_field(n, 4), phi("phi", Layout(n));
  PressureSettings settings;
  settings.relative_tolerance = 0.5;
  settings.residual_limit = 1e-7;
  const SolveReport report = solver.solve(rhs, phi, settings);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.largest_residual, 1e-7);
}

TEST(PressureSolver, FixedSidesHoldZeroHalfACellAway) {
  // phi'' = 1, phi = 0 at both ends: x (x - L) / 2 at the centres, less h^2 / 8 from the half cells.
  const Int3 n{20, 3, 1};
  const Real h = 0.25, length = n[0] * h;
  const Grid grid{n, {h, 1, 1}, {0, 0, 0}};
  const PressureSides sides = sides_of(fixed, fixed, closed, periodic);
  const auto open = make_faces(n, sides, all_open());
  const Field<Real> rhs("rhs", Layout(n));
  rhs.fill(1);
  const Field<Real> phi = solve(grid, sides, open, rhs, 1e-12).phi;
  for_cells(n, [&](int i, int j, int k) {
    const Real x = (i + 0.5) * h;
    EXPECT_NEAR(phi(i, j, k), 0.5 * x * (x - length) - h * h / 8, 1e-10);
  });
}

TEST(PressureSolver, FillsTheGhosts) {
  const Int3 n{12, 10, 9};
  const PressureSides sides = sides_of(closed, fixed, periodic, closed);
  const auto open = make_faces(n, sides, all_open());
  const Field<Real> phi = solve(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides, open, random_field(n, 5), 1e-8).phi;
  for (int d = 0; d < Layout::ghost_width; ++d) {
    EXPECT_EQ(phi(-1 - d, 3, 4), phi(d, 3, 4));
    EXPECT_EQ(phi(n[0] + d, 3, 4), -phi(n[0] - 1 - d, 3, 4));
    EXPECT_EQ(phi(3, -1 - d, 4), phi(3, n[1] - 1 - d, 4));
    EXPECT_EQ(phi(3, n[1] + d, 4), phi(3, d, 4));
    EXPECT_EQ(phi(3, 4, -1 - d), phi(3, 4, d));
    EXPECT_EQ(phi(-1 - d, -1 - d, n[2] + d), phi(d, n[1] - 1 - d, n[2] - 1 - d));
  }
}

TEST(PressureSolver, ClosedSidesAreLikeAShellOfSolid) {
  const Int3 inner{17, 14, 12}, outer{25, 22, 20};
  const Field<Real> rhs = random_field(inner, 6), embedded("rhs", Layout(outer));
  for_cells(inner, [&](int i, int j, int k) { embedded(i + 4, j + 4, k + 4) = rhs(i, j, k); });
  const auto inside = [&](int axis, int i, int j, int k) {
    const Int3 cell{i - 4, j - 4, k - 4};
    for (int a = 0; a < 3; ++a)
      if (cell[a] < (a == axis) || cell[a] >= inner[a]) return OpenFraction{0};
    return fully_open;
  };
  const PressureSides walls = sides_of(closed, closed, closed, closed), wrap;
  const auto open = make_faces(inner, walls, all_open());
  const auto open_in_shell = make_faces(outer, wrap, inside);
  const auto phi = centred(open, solve(Grid{inner, {1, 2, 1}, {0, 0, 0}}, walls, open, rhs, 1e-11).phi);
  const auto shell = centred(
      open_in_shell, solve(Grid{outer, {1, 2, 1}, {0, 0, 0}}, wrap, open_in_shell, embedded, 1e-11).phi);
  for_cells(inner, [&](int i, int j, int k) { EXPECT_NEAR(phi(i, j, k), shell(i + 4, j + 4, k + 4), 1e-8); });
  EXPECT_EQ(shell(1, 1, 1), 0);
}

TEST(PressureSolver, RowRangesGiveTheAnswerOfTheWholeBox) {
  const Int3 n{40, 30, 26};
  const PressureSides sides;
  const auto inside = [](int i, int j, int k) {
    return i >= 5 && i < 35 && j >= 3 && j < 25 && k >= 4 && k < 21 &&
           (i - 20) * (i - 20) + (j - 14) * (j - 14) < 170;
  };
  const auto open = make_faces(n, sides, [&](int axis, int i, int j, int k) {
    const bool both = inside(i, j, k) && inside(i - (axis == 0), j - (axis == 1), k - (axis == 2));
    return both ? fully_open : OpenFraction{0};
  });
  RowRanges rows(Box{{5, 3, 4}, {35, 25, 21}});
  rows.first = Array<int>("first", rows.number_of_rows());
  rows.last = Array<int>("last", rows.number_of_rows());
  for (int k = 4; k < 21; ++k)
    for (int j = 3; j < 25; ++j) {
      const Index row = (j - 3) + (k - 4) * 22;
      rows.first(row) = rows.last(row) = 5;
      for (int i = 34; i >= 5; --i)
        if (inside(i, j, k)) rows.first(row) = i;
      for (int i = 5; i < 35; ++i)
        if (inside(i, j, k)) rows.last(row) = i + 1;
    }
  const Grid grid{n, {1, 1, 1}, {0, 0, 0}};
  const Field<Real> rhs = random_field(n, 7);
  const Solution whole = solve(grid, sides, open, rhs, 1e-11);
  PressureSolver solver(grid, sides);
  solver.set_open_fractions(open, rows);
  const Field<Real> phi("phi", Layout(n));
  PressureSettings settings;
  settings.relative_tolerance = 1e-11;
  const SolveReport report = solver.solve(rhs, phi, settings);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(largest_difference(centred(open, phi), centred(open, whole.phi)), 1e-8);
}

TEST(PressureSolver, SolvesEveryRegionOnItsOwn) {
  // Two walls split the box in two; a pocket of two cells and a lone cell lie in a solid block.
  const Int3 n{20, 18, 16};
  const PressureSides sides;
  const auto region = [](int i, int j, int k) {
    if (i >= 4 && i < 9 && j >= 4 && j < 9 && k >= 4 && k < 9)
      return j == 6 && k == 6 && (i == 5 || i == 6) ? 3 : (i == 7 && j == 7 && k == 7 ? 4 : 0);
    return k < 10 ? 1 : 2;
  };
  const auto open = make_faces(n, sides, [&](int axis, int i, int j, int k) {
    const int here = region(i, j, k);
    const int there = region(wrapped(i - (axis == 0), n[0]), wrapped(j - (axis == 1), n[1]),
                             wrapped(k - (axis == 2), n[2]));
    return here == there && here != 0 && here != 4 ? fully_open : OpenFraction{0};
  });
  const Field<Real> rhs = random_field(n, 8, 0.5);
  Real sum[5] = {}, count[5] = {};
  for_cells(n, [&](int i, int j, int k) {
    rhs(i, j, k) += region(i, j, k);  // a different inconsistency in each region
    sum[region(i, j, k)] += rhs(i, j, k);
    ++count[region(i, j, k)];
  });
  const Field<Real> original("original", rhs.layout());
  Kokkos::deep_copy(original.array(), rhs.array());
  const Grid grid{n, {1, 1, 1}, {0, 0, 0}};
  const Solution s = solve(grid, sides, open, rhs, 1e-10);
  EXPECT_TRUE(s.report.converged);
  EXPECT_LE(s.report.iterations, 16);
  const auto mean = [&](int i, int j, int k) { return sum[region(i, j, k)] / count[region(i, j, k)]; };
  EXPECT_LT(residual_norm(open, original, s.phi, grid.spacing, mean) / norm_of(original), 1e-10);
  for_cells(n, [&](int i, int j, int k) {
    if (region(i, j, k) == 0 || region(i, j, k) == 4) {
      EXPECT_EQ(s.phi(i, j, k), 0);
    }
  });
}

TEST(PressureSolver, UpdateEqualsANewSolverBitwise) {
  const Int3 n{41, 37, 30};
  const Grid grid{n, {1, 1, 1}, {0, 0, 0}};
  const PressureSides sides;
  const auto before = spheres(n, {{10, 12, 14}, {1, 36, 15}}, 4.6),
             after = spheres(n, {{11.3, 12.4, 14}, {0, 36.9, 14.2}}, 4.6);
  const auto open = make_faces(n, sides, before);
  PressureSolver updated(grid, sides), fresh(grid, sides);
  updated.set_open_fractions(open, RowRanges(n));
  fill_faces(open, sides, after);
  updated.update_open_fractions({Box{{4, 6, 8}, {18, 19, 21}}, Box{{-6, 30, 8}, {8, 44, 22}}});
  fresh.set_open_fractions(open, RowRanges(n));
  const Field<Real> rhs = random_field(n, 9), a("a", Layout(n)), b("b", Layout(n));
  const SolveReport report = updated.solve(rhs, a, PressureSettings());
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.residual, fresh.solve(rhs, b, PressureSettings()).residual);
  EXPECT_EQ(largest_difference(a, b), 0);
}

TEST(PressureSolver, UpdateFindsRegionsThatAppear) {
  const Int3 n{24, 24, 24};
  const PressureSides sides;
  const auto open = make_faces(n, sides, all_open());
  PressureSolver solver(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides);
  solver.set_open_fractions(open, RowRanges(n));
  const Field<Real> rhs = random_field(n, 10), phi("phi", Layout(n));
  EXPECT_TRUE(solver.solve(rhs, phi, PressureSettings()).converged);
  const auto pocket = [](int i, int j, int k) { return (i == 10 || i == 11) && j == 12 && k == 13; };
  fill_faces(open, sides, [&](int axis, int i, int j, int k) {
    const bool here = pocket(i, j, k), there = pocket(i - (axis == 0), j - (axis == 1), k - (axis == 2));
    return here == there ? fully_open : OpenFraction{0};
  });
  solver.update_open_fractions({Box{{10, 12, 13}, {12, 13, 14}}});
  const SolveReport report = solver.solve(random_field(n, 11, 3), phi, PressureSettings());
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 9);
}

TEST(PressureSolver, ScalesWithTheRightHandSide) {
  const Int3 n{18, 25, 14};
  const Grid grid{n, {1e-3, 2e-3, 1e-3}, {0, 0, 0}};
  const PressureSides sides;
  const auto open = make_faces(n, sides, spheres(n, {{9, 9, 7}}, 4));
  const Field<Real> rhs = random_field(n, 12), tiny("tiny", Layout(n));
  const Real factor = std::ldexp(1.0, -300);
  for_cells(n, [&](int i, int j, int k) { tiny(i, j, k) = factor * rhs(i, j, k); });
  const Solution one = solve(grid, sides, open, rhs, 1e-8), other = solve(grid, sides, open, tiny, 1e-8);
  EXPECT_EQ(one.report.iterations, other.report.iterations);
  for_cells(n, [&](int i, int j, int k) { EXPECT_EQ(other.phi(i, j, k), factor * one.phi(i, j, k)); });
}

TEST(PressureSolver, StartsFromTheFirstGuess) {
  const Int3 n{30, 22, 26};
  const Grid grid{n, {1, 1, 1}, {0, 0, 0}};
  const PressureSides sides;
  const auto open = make_faces(n, sides, all_open());
  PressureSolver solver(grid, sides);
  solver.set_open_fractions(open, RowRanges(n));
  const Field<Real> rhs = random_field(n, 13), phi("phi", Layout(n)), first("first", Layout(n));
  solver.solve(rhs, phi, PressureSettings());
  Kokkos::deep_copy(first.array(), phi.array());
  const SolveReport again = solver.solve(rhs, phi, PressureSettings());
  EXPECT_EQ(again.iterations, 0);
  EXPECT_TRUE(again.converged);
  EXPECT_EQ(largest_difference(phi, first), 0);
}

TEST(PressureSolver, ConstantAndZeroRightHandSidesGiveZero) {
  const Int3 n{9, 8, 7};
  const PressureSides sides;
  const auto open = make_faces(n, sides, all_open());
  for (const Real value : {0.0, 2.5}) {
    const Field<Real> rhs("rhs", Layout(n));
    rhs.fill(value);
    const Solution s = solve(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides, open, rhs, 1e-6);
    EXPECT_TRUE(s.report.converged);
    EXPECT_EQ(norm_of(s.phi), 0);
  }
}

TEST(PressureSolver, EverythingSolidGivesZero) {
  const Int3 n{9, 8, 7};
  const PressureSides sides;
  const auto open = make_faces(n, sides, [](int, int, int, int) { return OpenFraction{0}; });
  const Solution s = solve(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides, open, random_field(n, 14), 1e-6);
  EXPECT_TRUE(s.report.converged);
  EXPECT_EQ(norm_of(s.phi), 0);
}

}  // namespace
}  // namespace peclet::flow
