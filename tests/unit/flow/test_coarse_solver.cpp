#include "flow/coarse_solver.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/pressure_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

TEST(CoarseSolver, InvertsOnEachRegionUpToTheMean) {
  // A wall at k = 2 and at the periodic side splits the box; the cell (1, 1, 0) is closed.
  const Int3 n{5, 4, 4};
  const PressureSides sides;
  const auto faces = [&](int axis, int i, int j, int k) -> OpenFraction {
    if (axis == 2 && k % 2 == 0) return 0;
    const Int3 lower{wrapped(i - (axis == 0), n[0]), wrapped(j - (axis == 1), n[1]),
                     wrapped(k - (axis == 2), n[2])};
    const auto is_hole = [](int a, int b, int c) { return a == 1 && b == 1 && c == 0; };
    return is_hole(i, j, k) || is_hole(lower[0], lower[1], lower[2]) ? 0 : fully_open;
  };
  const auto open = make_faces(n, sides, faces);
  const LevelShape shape(n, sides);
  const LevelOperator<OpenFraction> op(shape, open,
                                       {open_fraction_unit, open_fraction_unit, open_fraction_unit});
  const CoarseSolver solver(shape);
  solver.set_operator(op);
  const Field<float> rhs("rhs", shape.layout), solution("solution", shape.layout);
  const Field<Real> random = random_field(n, 41, 0.7);
  for_cells(n, [&](int i, int j, int k) { rhs(i, j, k) = static_cast<float>(random(i, j, k)); });
  solver.solve(rhs, solution);
  EXPECT_EQ(solution(1, 1, 0), 0);

  Real mean_rhs[2] = {}, mean_solution[2] = {};
  const Real count[2] = {39, 40};
  const Field<Real> phi("phi", shape.layout);
  for (int k = -1; k <= n[2]; ++k)
    for (int j = -1; j <= n[1]; ++j)
      for (int i = -1; i <= n[0]; ++i)
        phi(i, j, k) = solution(wrapped(i, n[0]), wrapped(j, n[1]), wrapped(k, n[2]));
  for_cells(n, [&](int i, int j, int k) {
    if (i == 1 && j == 1 && k == 0) return;
    mean_rhs[k / 2] += rhs(i, j, k) / count[k / 2];
    mean_solution[k / 2] += phi(i, j, k) / count[k / 2];
  });
  for (const Real mean : mean_solution) EXPECT_NEAR(mean, 0, 1e-6);
  for_cells(n, [&](int i, int j, int k) {
    if (i == 1 && j == 1 && k == 0) return;
    EXPECT_NEAR(-laplacian_at(open, phi, {1, 1, 1}, i, j, k), rhs(i, j, k) - mean_rhs[k / 2], 1e-5);
  });
}

}  // namespace
}  // namespace peclet::flow
