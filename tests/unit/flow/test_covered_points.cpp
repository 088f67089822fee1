#include "flow/covered_points.hpp"

#include <gtest/gtest.h>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75
const Vec3 velocity{0.3, -0.2, 0.1};
const SphereInTest crosses_the_edge = moving({{5.6, 3.1, 6.9}, 1.9}, velocity);
const SphereInTest beside_it = moving({{3.1, 5.3, 4.4}, 1.1}, {-0.1, 0.2, 0.4});

Field<Real> uneven_flow(Real shift) {
  const Field<Real> u("u", Layout(grid.cells));
  for_each_cell(
      "uneven_flow", Box{{0, 0, 0}, grid.cells},
      KOKKOS_LAMBDA(int i, int j, int k) { u(i, j, k) = Kokkos::sin(1.3 * i + 2.1 * j + 0.7 * k + shift); });
  return u;
}

/// Field values of fluid faces, and of faces that were fluid before the velocity of the body that covers
/// them.
struct Momentum {
  Real of_fluid = 0;
  int covered = 0;
};

Momentum momentum(const std::vector<Real>& u, const std::vector<OpenFraction>& before,
                  const std::vector<OpenFraction>& now, Real wall) {
  Momentum sum;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (!is_fluid(before[n])) continue;
    sum.covered += !is_fluid(now[n]);
    sum.of_fluid += is_fluid(now[n]) ? u[n] : wall;
  }
  return sum;
}

Real sum_of_fluid(const std::vector<Real>& u, const std::vector<OpenFraction>& open) {
  Real sum = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    if (is_fluid(open[n])) sum += u[n];
  return sum;
}

/// Moves the first body by shift and hands on what it covers of component c.
void move_and_hand_on(BoundaryInTest& flow, int c, Vec3 shift, const Field<Real>& u,
                      const Field<Real>& previous) {
  CoveredPoints covered;
  covered.remember(c, flow.boundary.moving_rows(c));
  flow.bodies.set_pose(0, crosses_the_edge.center + shift, {});
  flow.boundary.update(flow.bodies, Field<Real>("pressure", Layout(grid.cells)), {0.1, 1e-2});
  covered.hand_on(c, flow.boundary.solid(), flow.boundary.open()[c], flow.bodies.count(), u, previous);
}

TEST(CoveredPoints, LoseNoMomentumBeyondThatOfTheirBody) {
  for (int c = 0; c < 3; ++c) {
    BoundaryInTest flow({crosses_the_edge, beside_it});
    const Field<Real> u = uneven_flow(0), previous = uneven_flow(0.5);
    const std::vector<OpenFraction> before = host_values(flow.boundary.open()[c]);
    const Real sums[2] = {sum_of_fluid(host_values(u), before), sum_of_fluid(host_values(previous), before)};
    move_and_hand_on(flow, c, {0.21, -0.24, 0.33}, u, previous);  // through all three sides
    const std::vector<OpenFraction> now = host_values(flow.boundary.open()[c]);
    const Field<Real>* fields[2] = {&u, &previous};
    for (int n = 0; n < 2; ++n) {
      const Momentum after = momentum(host_values(*fields[n]), before, now, velocity[c]);
      EXPECT_GT(after.covered, 5);
      EXPECT_NEAR(after.of_fluid, sums[n], 1e-12);
    }
  }
}

TEST(CoveredPoints, LeaveAloneWhatIsNotBesideTheirBody) {
  BoundaryInTest flow({crosses_the_edge, beside_it});
  const Field<Real> u = uneven_flow(0), previous = uneven_flow(0.5);
  const std::vector<Real> before = host_values(u);
  move_and_hand_on(flow, 0, {0.3, 0, 0}, u, previous);
  const std::vector<Real> after = host_values(u);
  std::size_t n = 0;
  int changed = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i, ++n) {
        const Vec3 x = grid.face_center(0, i, j, k);
        if (after[n] != before[n]) ++changed;
        if (norm(x - beside_it.center) < beside_it.radius + 0.5) {
          EXPECT_EQ(after[n], before[n]);
        }
      }
  EXPECT_GT(changed, 50);
}

TEST(CoveredPoints, ABodyThatStaysChangesNothing) {
  BoundaryInTest flow({crosses_the_edge, beside_it});
  const Field<Real> u = uneven_flow(0), previous = uneven_flow(0.5);
  const std::vector<Real> before = host_values(u);
  move_and_hand_on(flow, 1, {}, u, previous);
  EXPECT_EQ(host_values(u), before);
}

}  // namespace
