#include "flow/scalars.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "flow/solver.hpp"

namespace peclet::flow {
namespace {

constexpr int temperature = 0;

/// A closed tank without bodies, one scalar in it, and the flow at rest.
Solver tank(const Grid& grid, Real diffusivity) {
  Solver solver(grid);
  for (int axis = 0; axis < 3; ++axis)
    for (int high = 0; high < 2; ++high) {
      DomainSide side;
      side.kind = SideKind::Slip;
      solver.set_side(axis, high, side);
    }
  ScalarSettings settings;
  settings.diffusivity = diffusivity;
  settings.tolerance = 1e-12;
  solver.scalars().add("temperature", settings);
  return solver;
}

void give(Scalar& scalar, int axis, int high, ScalarCondition condition, Real value) {
  ScalarSide& side = scalar.sides.side[axis][high];
  side.condition = condition;
  side.value = value;
  side.is_given = true;
}

Grid small_grid() { return Grid{{7, 5, 4}, {0.1, 0.2, 0.3}, {0, 0, 0}}; }

TEST(Scalars, AreFoundByName) {
  Solver solver = tank(small_grid(), 1);
  EXPECT_EQ(solver.scalars().find("temperature"), temperature);
  EXPECT_EQ(solver.scalars().find("salt"), -1);
  EXPECT_EQ(solver.scalars().add("salt", {}), 1);
  EXPECT_EQ(solver.scalars().count(), 2);
}

TEST(Scalars, OfAColumnWithASourceBecomeAParabola) {
  const Grid grid = small_grid();
  constexpr Real diffusivity = 0.7, source = 2;
  Solver solver = tank(grid, diffusivity);
  Scalar& scalar = solver.scalars()[temperature];
  scalar.settings.source = source;
  give(scalar, 1, 0, ScalarCondition::Value, 3);
  solver.solve_scalar_steady(temperature);
  // 3 + s / D (y H - y^2 / 2), no flux at y = H: stencil and side are exact for quadratic profiles
  const Real height = grid.extent(1);
  for (int j = 0; j < grid.cells[1]; ++j) {
    const Real y = grid.cell_center(0, j, 0).y;
    EXPECT_NEAR(scalar.fields.value(3, j, 2), 3 + source / diffusivity * (y * height - y * y / 2), 1e-8);
  }
  EXPECT_TRUE(scalar.report.converged);
  // all that the source makes leaves through the side of given value
  const Real volume = grid.extent(0) * grid.extent(1) * grid.extent(2);
  const int low_y = giver_index(side_giver(1, 0), 0);
  EXPECT_NEAR(scalar.given[static_cast<std::size_t>(low_y)], -source * volume, 1e-6 * volume);
}

TEST(Scalars, GainWhatASideGives) {
  Solver solver = tank(small_grid(), 0.4);
  Scalar& scalar = solver.scalars()[temperature];
  give(scalar, 2, 1, ScalarCondition::Flux, 1.5);
  solver.advance_scalars();
  const Real before = solver.scalars().amount(temperature);
  for (int n = 0; n < 5; ++n) solver.advance_scalars();
  const Real area = 0.7 * 1.0, time = 5 * solver.settings().time_step;
  EXPECT_NEAR(solver.scalars().amount(temperature) - before, 1.5 * area * time, 1e-10 * time);
}

TEST(Scalars, NeedAValueWhereFluidFlowsIn) {
  Solver solver = tank(small_grid(), 0);
  DomainSide side;
  side.kind = SideKind::Inflow;
  side.velocity = {1, 0, 0};
  solver.set_side(0, 0, side);
  EXPECT_THROW(solver.prepare_scalars(), std::runtime_error);
  give(solver.scalars()[temperature], 0, 0, ScalarCondition::Value, 1);
  EXPECT_NO_THROW(solver.prepare_scalars());
}

TEST(Scalars, PushFluidOnlyAlongGravity) {
  const Grid grid{{4, 6, 4}, {1, 1, 1}, {0, 0, 0}};
  Solver solver(grid);
  solver.scalars().add("temperature", {});
  Scalar& scalar = solver.scalars()[temperature];
  scalar.fields.value.fill(2);
  solver.scalars().set_buoyancy({temperature, 0.5, 1.5, {0, -3, 0}});
  solver.prepare_scalars();
  const Field<Real> residual("residual", Layout(grid.cells));
  for (int c = 0; c < 3; ++c) {
    residual.fill(0);
    solver.scalars().add_buoyancy(c, 0.2, RowRanges(grid.cells), residual);
    // -dt beta (c - reference) g
    EXPECT_NEAR(residual(1, 2, 3), c == 1 ? 0.2 * 0.5 * 0.5 * 3 : 0, 1e-15);
  }
}

}  // namespace
}  // namespace peclet::flow
