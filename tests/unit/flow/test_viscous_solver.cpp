#include "flow/viscous_solver.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/viscous_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

struct Outcome {
  SolverReport report;
  Real error, bound, left_over, true_left_over;
};

/// Solves for a known random solution. Rows of the operator have a positive diagonal, negative neighbours and
/// a sum of at least 1, so that its inverse is at most 1 in the maximum norm: errors are bounded by the
/// residual.
Outcome solve(const Flow& flow, int c, Real diffusion, int limit = 200, Real tolerance = 1e-8) {
  const Layout layout(flow.grid.cells);
  const Field<Real> expected = random_velocity(flow, c, 7);
  const Field<Real> residual = plain_product(flow, c, diffusion, expected), correction("correction", layout);
  const Norms start = plain_norms(flow, c, residual);
  const Field<Real> rhs("rhs", layout);
  Kokkos::deep_copy(rhs.array(), residual.array());
  ViscousSolver solver(layout);
  Outcome outcome{};
  outcome.report =
      solver.solve(flow.system(c, diffusion), residual, correction, tolerance, 1, limit, outcome.left_over);
  outcome.bound = outcome.report.residual * std::max(1.0, start.largest);
  for_fluid_points(flow, c, [&](int i, int j, int k) {
    outcome.error = std::max(outcome.error, std::abs(correction(i, j, k) - expected(i, j, k)));
  });
  const Field<Real> product = plain_product(flow, c, diffusion, correction);
  for_fluid_points(flow, c,
                   [&](int i, int j, int k) { outcome.true_left_over += rhs(i, j, k) - product(i, j, k); });
  return outcome;
}

void expect_solved(const Flow& flow, Real diffusion, const std::string& name, int most = 8) {
  for (int c = 0; c < 3; ++c) {
    SCOPED_TRACE(name + ", component " + std::to_string(c) + ", diffusion " + std::to_string(diffusion));
    const Outcome outcome = solve(flow, c, diffusion);
    EXPECT_TRUE(outcome.report.converged);
    EXPECT_LE(outcome.report.residual, 1e-8);
    EXPECT_LE(outcome.report.iterations, diffusion > 10 ? most : 40);
    const Real rounding = 1e-13 * (1 + 12 * diffusion);
    EXPECT_LE(outcome.error, outcome.bound + rounding);
    EXPECT_NEAR(outcome.left_over, outcome.true_left_over,
                rounding * static_cast<Real>(flow.grid.number_of_cells()));
  }
}

const Real numbers[] = {0.02, 1, 50, 1e4};

TEST(ViscousSolver, ConvergesInOpenBoxesOfAnySize) {
  for (const Int3& n : {Int3{16, 16, 16}, Int3{17, 12, 9}, Int3{31, 5, 23}, Int3{40, 37, 1}}) {
    const Flow flow(n, {1, 1, 1}, no_solid());
    for (const Real number : numbers) expect_solved(flow, number, "open " + std::to_string(n[0]));
  }
}

TEST(ViscousSolver, ConvergesAroundASphere) {
  for (const Int3& n : {Int3{24, 24, 24}, Int3{31, 22, 27}}) {
    const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 7.2));
    for (const Real number : numbers) expect_solved(flow, number, "sphere " + std::to_string(n[0]), 5);
  }
}

TEST(ViscousSolver, ConvergesInATank) {
  const Int3 n{40, 25, 33};
  const Flow flow(n, {1, 1, 1}, tank(n));
  for (const Real number : numbers) expect_solved(flow, number, "tank");
}

TEST(ViscousSolver, ConvergesOnUnequalSpacings) {
  const Int3 n{24, 20, 28};
  const Flow flow(n, {1, 2.5, 0.7}, sphere_in_the_middle(n, 6));
  for (const Real number : numbers) expect_solved(flow, number, "unequal", 11);
}

TEST(ViscousSolver, ConvergesBetweenSides) {
  DomainSides channel, duct;
  channel.side[0][0] = side_of(SideKind::Inflow);
  channel.side[0][1] = side_of(SideKind::Outflow);
  channel.side[1][0] = channel.side[1][1] = side_of(SideKind::Wall);
  duct.side[2][0] = side_of(SideKind::Outflow);
  duct.side[2][1] = side_of(SideKind::Outflow);
  duct.side[0][0] = side_of(SideKind::Slip);
  duct.side[0][1] = side_of(SideKind::Wall);
  const Int3 n{30, 19, 22};
  for (const Real number : numbers) {
    expect_solved(Flow(n, {1, 1, 1}, sphere_in_the_middle(n, 5), channel), number, "channel", 11);
    expect_solved(Flow(n, {1, 1, 1}, no_solid(), duct), number, "duct", 18);
  }
}

TEST(ViscousSolver, ConvergesWhereABodyIsCloseToTheSides) {
  DomainSides walls;
  walls.side[0][0] = walls.side[0][1] = side_of(SideKind::Wall);
  walls.side[2][0] = side_of(SideKind::Inflow);
  walls.side[2][1] = side_of(SideKind::Outflow);
  const Int3 n{8, 30, 9};
  for (const Real radius : {2.5, 3.4, 3.8})
    for (const Real number : numbers)
      expect_solved(Flow(n, {1, 1, 1}, sphere_in_the_middle(n, radius), walls), number, "slab", 12);
}

TEST(ViscousSolver, SaysThatItDidNotConverge) {
  const Int3 n{24, 24, 24};
  const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 7.2));
  for (const Real number : numbers) {
    const Outcome outcome = solve(flow, 0, number, 1);
    EXPECT_FALSE(outcome.report.converged);
    EXPECT_EQ(outcome.report.iterations, 1);
    EXPECT_GT(outcome.report.residual, 1e-8);
    EXPECT_LE(outcome.error, outcome.bound + 1e-9);
  }
}

TEST(ViscousSolver, NothingGivesNothing) {
  const Int3 n{8, 8, 8};
  const Flow flow(n, {1, 1, 1}, no_solid());
  const Layout layout(n);
  const Field<Real> residual("residual", layout), correction("correction", layout);
  correction.fill(3);
  ViscousSolver solver(layout);
  Real left_over = 1;
  const SolverReport report =
      solver.solve(flow.system(0, 1e3), residual, correction, 1e-8, 0, 200, left_over);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(left_over, 0);
  for_fluid_points(flow, 0, [&](int i, int j, int k) { EXPECT_EQ(correction(i, j, k), 0); });
}

}  // namespace
}  // namespace peclet::flow
