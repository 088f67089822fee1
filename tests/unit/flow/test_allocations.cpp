// A step takes its memory from what earlier steps have allocated.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bodies_in_tests.hpp"
#include "flow/solver.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

std::vector<std::string> allocations;

void note(Kokkos::Tools::SpaceHandle, const char* label, const void*, std::uint64_t bytes) {
  allocations.push_back(std::string(label) + ", " + std::to_string(bytes) + " bytes");
}

/// What is allocated while this object lives.
class AllocationsNoted {
 public:
  AllocationsNoted() {
    allocations.clear();
    Kokkos::Tools::Experimental::set_allocate_data_callback(note);
  }
  ~AllocationsNoted() { Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr); }
};

const Grid grid{{40, 36, 32}, {1, 1, 1}, {0, 0, 0}};

Settings settings_with(Real viscosity) {
  Settings settings;
  settings.viscosity = viscosity;
  settings.time_step = 1;
  settings.advection = AdvectionScheme::Koren;
  settings.body_force = {1e-4, 0, 0};
  return settings;
}

void set_side(Solver& solver, int axis, int high, SideKind kind, Vec3 velocity = {}) {
  DomainSide side;
  side.kind = kind;
  side.velocity = velocity;
  solver.set_side(axis, high, side);
}

/// Two spheres move, a third one is fixed.
void expect_no_allocation(Solver& solver) {
  const Vec3 start[2] = {{10.3, 9.1, 8.7}, {24.6, 20.2, 18.4}},
             velocity[2] = {{0.1, 0.06, 0}, {-0.08, 0, 0.1}};
  solver.set_scene(scene_of({{start[0], 4.2}, {start[1], 3.4}, {{30.1, 8.2, 24.3}, 3.1}}), true);
  solver.build_geometry(false);
  constexpr int warm_up = 4, steps = 12;
  for (int n = 0; n < steps; ++n) {
    const AllocationsNoted noted;
    for (int b = 0; b < 2; ++b) {
      solver.set_pose(b, start[b] + Real(n) * velocity[b], {});
      solver.set_motion(b, {velocity[b], {0, 0, 0.01}}, std::nullopt);
    }
    solver.update_geometry();
    solver.step();
    if (n < warm_up) continue;
    EXPECT_EQ(allocations, std::vector<std::string>{}) << "step " << n;
  }
}

TEST(Allocations, AreNoted) {
  const AllocationsNoted noted;
  const Array<Real> array("noted", 5);
  ASSERT_EQ(allocations.size(), 1u);
  EXPECT_EQ(allocations[0].substr(0, 5), "noted");
}

TEST(Allocations, NoneInAStepWithMovingBodies) {
  Solver solver(grid);
  solver.change_settings(settings_with(0.02));
  expect_no_allocation(solver);
}

TEST(Allocations, NoneInAStepWithStiffViscosity) {
  Solver solver(grid);
  solver.change_settings(settings_with(100));
  expect_no_allocation(solver);
}

TEST(Allocations, NoneInAStepWithSides) {
  Solver solver(grid);
  solver.change_settings(settings_with(0.02));
  set_side(solver, 0, 0, SideKind::Inflow, {0.05, 0, 0});
  set_side(solver, 0, 1, SideKind::Outflow);
  for (int high = 0; high < 2; ++high) set_side(solver, 1, high, SideKind::Wall);
  expect_no_allocation(solver);
}

TEST(Allocations, NoneInAStepWithAScalar) {
  Solver solver(grid);
  solver.change_settings(settings_with(0.02));
  solver.scalars().add("heat", ScalarSettings{0.02});
  expect_no_allocation(solver);
}

}  // namespace
