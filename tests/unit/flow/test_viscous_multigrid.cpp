#include "flow/viscous_multigrid.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/viscous_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

/// Largest residual that a cycle leaves, and the residual.
Real cycle(const ViscousMultigrid& multigrid, const Flow& flow, const ViscousSystem& system,
           const Field<Real>& residual) {
  multigrid.apply(system, residual, 1);
  const Layout layout(flow.grid.cells);
  const Field<Real> correction("correction", layout);
  for_fluid_points(flow, system.component,
                   [&](int i, int j, int k) { correction(i, j, k) = Real{multigrid.correction()(i, j, k)}; });
  const Field<Real> product = plain_product(flow, system.component, system.diffusion, correction);
  for_fluid_points(flow, system.component,
                   [&](int i, int j, int k) { residual(i, j, k) -= product(i, j, k); });
  return plain_norms(flow, system.component, residual).largest;
}

/// Mean reduction of the largest residual over cycles that follow two others.
Real reduction(const Flow& flow, int c, Real diffusion) {
  const ViscousSystem system = flow.system(c, diffusion);
  ViscousMultigrid multigrid(flow.grid, flow.sides);
  EXPECT_TRUE(multigrid.is_solver(system));
  multigrid.set_system(system);
  const Field<Real> residual = plain_product(flow, c, diffusion, random_velocity(flow, c, 11));
  cycle(multigrid, flow, system, residual);
  const Real before = cycle(multigrid, flow, system, residual);
  constexpr int cycles = 4;
  Real after = before;
  for (int n = 0; n < cycles; ++n) after = cycle(multigrid, flow, system, residual);
  return std::pow(after / before, 1.0 / cycles);
}

TEST(ViscousMultigrid, CyclesConvergeAroundASphereOnAnyGrid) {
  for (const Int3& n : {Int3{24, 24, 24}, Int3{31, 22, 27}, Int3{48, 48, 48}}) {
    const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 0.31 * n[1]));
    for (const Real diffusion : {5.0, 100.0, 1e4})
      for (int c = 0; c < 3; ++c) EXPECT_LE(reduction(flow, c, diffusion), 0.1) << n[0] << " " << diffusion;
  }
}

TEST(ViscousMultigrid, CyclesConvergeInATankAndBetweenSides) {
  const Int3 n{30, 19, 22};
  DomainSides channel;
  channel.side[0][0] = side_of(SideKind::Inflow);
  channel.side[0][1] = side_of(SideKind::Outflow);
  channel.side[1][0] = channel.side[1][1] = side_of(SideKind::Wall);
  const Flow closed(n, {1, 1, 1}, tank(n)), open(n, {1, 1, 1}, sphere_in_the_middle(n, 5), channel);
  for (const Real diffusion : {5.0, 100.0, 1e4})
    for (int c = 0; c < 3; ++c) {
      EXPECT_LE(reduction(closed, c, diffusion), 0.15) << diffusion;
      EXPECT_LE(reduction(open, c, diffusion), c == 0 ? 0.4 : 0.15) << diffusion;
    }
}

std::vector<float> result(const ViscousMultigrid& multigrid, const Flow& flow, const ViscousSystem& system) {
  multigrid.apply(system, random_velocity(flow, system.component, 5), 1);
  std::vector<float> values;
  for_fluid_points(flow, system.component,
                   [&](int i, int j, int k) { values.push_back(multigrid.correction()(i, j, k)); });
  return values;
}

TEST(ViscousMultigrid, KeepsTheLevelsOfEachComponentUntilTheirSystemChanges) {
  const Int3 n{24, 20, 18};
  const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 6)), other(n, {1, 1, 1}, sphere_in_the_middle(n, 4));
  const auto system = [](const Flow& of, int c, Real diffusion, Index revision) {
    ViscousSystem viscous = of.system(c, diffusion);
    viscous.revision = revision;
    return viscous;
  };
  const auto fresh = [&](const Flow& of, const ViscousSystem& viscous) {
    ViscousMultigrid multigrid(of.grid, of.sides);
    multigrid.set_system(viscous);
    return result(multigrid, of, viscous);
  };
  ViscousMultigrid multigrid(flow.grid, flow.sides);
  for (int round = 0; round < 2; ++round)
    for (int c = 0; c < 3; ++c) {
      multigrid.set_system(system(flow, c, 100, 1));
      EXPECT_EQ(result(multigrid, flow, system(flow, c, 100, 1)), fresh(flow, system(flow, c, 100, 1)));
    }
  for (const ViscousSystem& changed : {system(flow, 1, 30, 1), system(flow, 1, 30, -1)}) {
    multigrid.set_system(changed);
    EXPECT_EQ(result(multigrid, flow, changed), fresh(flow, changed));
  }
  multigrid.set_system(system(other, 0, 100, 2));
  EXPECT_EQ(result(multigrid, other, system(other, 0, 100, 2)), fresh(other, system(other, 0, 100, 2)));
}

}  // namespace
}  // namespace peclet::flow
