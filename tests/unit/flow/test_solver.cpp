#include "flow/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bodies_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();

Settings settings_of(AdvectionScheme scheme) {
  Settings settings;
  settings.density = 1.5;
  settings.viscosity = 0.2;
  settings.time_step = 0.25;
  settings.advection = scheme;
  return settings;
}

Solver solver_with(const std::vector<SphereInTest>& spheres, const Settings& settings) {
  Solver solver(grid);
  solver.change_settings(settings);
  solver.set_scene(scene_of(spheres), true);
  solver.build_geometry(false);
  return solver;
}

void set_uniform(Solver& solver, Vec3 velocity) {
  for (int c = 0; c < 3; ++c) solver.velocity()[c].fill(velocity[c]);
  solver.velocity_changed();
}

TEST(Solver, AForceAcceleratesAnEmptyBox) {
  Settings settings = settings_of(AdvectionScheme::Koren);
  settings.body_force = {0.3, -0.6, 0.15};
  Solver solver = solver_with({}, settings);
  for (int n = 1; n <= 3; ++n) {
    solver.step();
    for (int c = 0; c < 3; ++c)
      for (const Real u : host_values(solver.velocity()[c]))
        EXPECT_NEAR(u, n * 0.25 * settings.body_force[c] / 1.5, 1e-12);
  }
  EXPECT_EQ(solver.number_of_steps(), 3);
  EXPECT_DOUBLE_EQ(solver.time(), 0.75);
}

TEST(Solver, RestStaysRestAroundFixedBodies) {
  Solver solver = solver_with({{{2.6, 5.2, 3.6}, 1.4}}, settings_of(AdvectionScheme::SecondUpwind));
  solver.step();
  EXPECT_EQ(solver.largest_velocity(), 0);
  EXPECT_EQ(norm(solver.loads()[0].force), 0);
}

TEST(Solver, EveryOpenCellConservesVolumeAfterAnImpulsiveStart) {
  Solver solver = solver_with({{{5.6, 3.1, 6.9}, 1.5, {{0.4, -0.2, 0.1}, {0, 0.3, 0}}}},
                              settings_of(AdvectionScheme::Koren));
  solver.step();
  EXPECT_GT(solver.largest_velocity(), 0.1);
  EXPECT_LT(solver.largest_open_divergence(), 1e-8 * solver.largest_velocity() / 0.5);
}

TEST(Solver, ABodyAndAStreamMoveTogether) {
  const Vec3 velocity{0.4, -0.2, 0.1};
  for (const AdvectionScheme scheme : {AdvectionScheme::None, AdvectionScheme::SecondUpwind,
                                       AdvectionScheme::Koren, AdvectionScheme::Central}) {
    Vec3 position{5.6, 3.1, 6.9};
    Solver solver = solver_with({{position, 1.5, {velocity, {}}}}, settings_of(scheme));
    set_uniform(solver, velocity);
    for (int n = 0; n < 4; ++n) {
      position += 0.25 * velocity;
      solver.set_pose(0, position, {});
      solver.step();
    }
    for (int c = 0; c < 3; ++c)
      for (const Real u : host_values(solver.velocity()[c])) EXPECT_NEAR(u, velocity[c], 1e-9);
    EXPECT_LT(norm(solver.loads()[0].force), 1e-8);
  }
}

TEST(Solver, UncoveredFacesStartWithTheVelocityOfTheBody) {
  Solver solver =
      solver_with({{{2.6, 5.2, 3.6}, 1.4, {{0.4, 0, 0}, {}}}}, settings_of(AdvectionScheme::None));
  const std::vector<OpenFraction> before = host_values(solver.open().x);
  solver.set_pose(0, {3.2, 5.2, 3.6}, {});
  solver.update_geometry();
  const std::vector<OpenFraction> after = host_values(solver.open().x);
  const std::vector<Real> u = host_values(solver.velocity().x);
  int uncovered = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (before[n] != 0 || after[n] == 0) continue;
    ++uncovered;
    EXPECT_EQ(u[n], 0.4);
  }
  EXPECT_GT(uncovered, 5);
}

TEST(Solver, ALeapKeepsTheFlowWhereItStaysFluid) {
  Solver solver = solver_with({{{2.6, 5.2, 3.6}, 1.4}}, settings_of(AdvectionScheme::None));
  set_uniform(solver, {1, 2, 3});
  const std::vector<OpenFraction> before = host_values(solver.open().y);
  solver.set_pose(0, {6.1, 2.5, 3.3}, {});
  solver.update_geometry();
  const std::vector<OpenFraction> after = host_values(solver.open().y);
  const std::vector<Real> v = host_values(solver.velocity().y);
  for (std::size_t n = 0; n < v.size(); ++n) {
    if (is_fluid(before[n]) && is_fluid(after[n])) {
      EXPECT_EQ(v[n], 2);
    }
  }
}

TEST(Solver, LoadsNeedAStep) {
  Solver solver = solver_with({{{2.6, 5.2, 3.6}, 1.4}}, settings_of(AdvectionScheme::None));
  EXPECT_THROW(solver.loads(), std::runtime_error);
}

TEST(Solver, DragPointsAgainstTheMotionAndTorqueAgainstTheSpin) {
  Solver solver =
      solver_with({{{2.6, 5.2, 3.6}, 1.4, {{0, 0.1, 0}, {0, 0, 0.2}}}}, settings_of(AdvectionScheme::None));
  solver.step();
  const BodyLoad load = solver.loads()[0];
  EXPECT_LT(load.force.y, 0);
  EXPECT_LT(load.torque.z, 0);
  EXPECT_LT(load.pressure_force.y, 0);
  EXPECT_LT(load.viscous_force.y, 0);
  EXPECT_NEAR(norm(load.pressure_force + load.viscous_force - load.force), 0, 1e-12 * norm(load.force));
}

TEST(Solver, ACapThatIsTooLowIsReported) {
  Settings settings = settings_of(AdvectionScheme::None);
  settings.pressure_iteration_limit = 1;
  settings.velocity_iteration_limit = 1;
  settings.viscosity = 5;
  Solver solver = solver_with({{{2.6, 5.2, 3.6}, 1.4, {{0, 0.1, 0}, {}}}}, settings);
  solver.step();
  EXPECT_FALSE(solver.pressure_report().converged);
  EXPECT_FALSE(solver.velocity_report().converged);
}

}  // namespace
