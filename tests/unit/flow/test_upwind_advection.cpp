#include "flow/upwind_advection.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/viscous_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

/// The curl of random numbers on the edges: every cell gains as much as it loses.
FaceVector<Real> solenoidal_velocity(const Flow& flow) {
  const Layout layout(flow.grid.cells);
  const Int3 n = flow.grid.cells;
  FaceVector<Real> edges("edges", layout), velocity("carrier", layout);
  std::mt19937 generator(11);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) edges[c](i, j, k) = uniform(generator);
    fill_periodic_ghosts(edges[c], flow.sides.periodicity());
  }
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const Index p = layout(i, j, k);
          velocity[c][p] = (edges[b][p + layout.stride(a)] - edges[b][p]) / flow.grid.spacing[a] -
                           (edges[a][p + layout.stride(b)] - edges[a][p]) / flow.grid.spacing[b];
        }
    fill_periodic_ghosts(velocity[c], flow.sides.periodicity());
  }
  return velocity;
}

/// A stream along x, straight on through bodies.
FaceVector<Real> uniform_stream(const Flow& flow) {
  FaceVector<Real> velocity("carrier", Layout(flow.grid.cells));
  velocity.x.fill(1);
  return velocity;
}

ViscousSystem advected(const Flow& flow, int c, Real diffusion, const FaceVector<Real>& carrier, Real dt) {
  ViscousSystem system = flow.system(c, diffusion);
  system.carrier = carrier;
  system.advection_step = dt;
  return system;
}

/// dt U e at the unknowns, from fluxes.
Field<Real> plain_upwind(const Flow& flow, int c, const FaceVector<Real>& carrier, Real dt,
                         const Field<Real>& e) {
  const Layout layout(flow.grid.cells);
  fill_correction_ghosts(e, c, flow.sides);
  const WallRows& walls = flow.boundary.fixed_rows(c);
  std::map<Index, Index> row_at;
  for (Index row = 0; row < walls.count; ++row) row_at[walls.face(row)] = row;
  const Field<Real> out("upwind", layout);
  for_fluid_points(flow, c, [&](int i, int j, int k) {
    const Index p = layout(i, j, k);
    const auto found = row_at.find(p);
    Real loss = 0, dilation = 0;
    for (int d = 0; d < 6; ++d) {
      const Index step = layout.stride(d / 2), face = d % 2 ? p + step : p;
      const Field<Real>& v = carrier[d / 2];
      const Real outwards =
          (d % 2 ? 1 : -1) * dt * (v[face] + v[face - layout.stride(c)]) / (2 * flow.grid.spacing[d / 2]);
      const bool is_wall = found != row_at.end() && walls.is_wall(found->second, d);
      const Real beyond = is_wall ? 0 : e[d % 2 ? p + step : p - step];
      loss += outwards * (outwards > 0 ? e[p] : beyond);
      dilation += outwards;
    }
    out[p] = found == row_at.end() ? loss : loss - dilation * e[p];
  });
  return out;
}

Real sum_over_fluid(const Flow& flow, int c, const Field<Real>& field) {
  Real sum = 0;
  for_fluid_points(flow, c, [&](int i, int j, int k) { sum += field(i, j, k); });
  return sum;
}

/// dt U e as the solver evaluates it.
Field<Real> upwind_of(const ViscousSystem& system, const Field<Real>& values) {
  const Layout layout = system.layout();
  const Field<float> e("e", layout);
  for (Index p = 0; p < static_cast<Index>(e.array().extent(0)); ++p)
    e.array()(p) = static_cast<float>(values.array()(p));
  ghosts_of(system, e).body.finish();
  const Field<Real> out("product", layout);
  const UpwindAdvection<Real> upwind = system.upwind<Real>();
  sweep("upwind", *system.plan,
        Stage(system.rows, AddUpwind<Real>{upwind, e.data(), out.data(), 1},
              at_walls(system.fixed_rows, AddWallUpwind<Real>{system.fixed_rows, upwind, e, out, 1})));
  return out;
}

TEST(UpwindAdvection, CarriesNothingOutOfAUniformField) {
  const Flow flow({12, 9, 10}, {1, 0.5, 2}, no_solid());
  const FaceVector<Real> carrier = solenoidal_velocity(flow);
  const Field<Real> ones("ones", Layout(flow.grid.cells));
  ones.fill(1);
  for (int c = 0; c < 3; ++c) {
    const Field<Real> product = upwind_of(advected(flow, c, 0, carrier, 3), ones);
    for_fluid_points(flow, c, [&](int i, int j, int k) { ASSERT_NEAR(product(i, j, k), 0, 1e-13); });
  }
}

TEST(UpwindAdvection, TheLeakIsTheSumOverTheFluid) {
  const Int3 n{20, 18, 21};
  const Flow flow(n, {1, 1.5, 1}, sphere_in_the_middle(n, 5.4));
  const FaceVector<Real> carrier = solenoidal_velocity(flow);
  for (int c = 0; c < 3; ++c) {
    const ViscousSystem system = advected(flow, c, 0, carrier, 3);
    Field<Real> e = random_velocity(flow, c, 5);
    for_fluid_points(flow, c, [&](int i, int j, int k) { e(i, j, k) = static_cast<float>(e(i, j, k)); });
    const Real leak = upwind_leak(system.upwind<Real>(), system.fixed_rows, e);
    EXPECT_GT(std::abs(leak), 0.01);
    EXPECT_NEAR(sum_over_fluid(flow, c, upwind_of(system, e)), leak, 1e-10);
  }
}

/// Solves for a known random solution; the inverse of the operator is at most 1 in the maximum norm, as rows
/// are diagonally dominant.
void expect_solved(const Flow& flow, const FaceVector<Real>& carrier, Real diffusion, Real dt, int most) {
  const Layout layout(flow.grid.cells);
  for (int c = 0; c < 3; ++c) {
    SCOPED_TRACE("component " + std::to_string(c) + ", diffusion " + std::to_string(diffusion) + ", step " +
                 std::to_string(dt));
    const Field<Real> expected = random_velocity(flow, c, 7), correction("correction", layout);
    const Field<Real> residual = plain_product(flow, c, diffusion, expected);
    const Field<Real> carried = plain_upwind(flow, c, carrier, dt, expected);
    for_fluid_points(flow, c, [&](int i, int j, int k) { residual(i, j, k) += carried(i, j, k); });
    const Real supplied = sum_over_fluid(flow, c, residual);
    const Real scale = std::max(1.0, plain_norms(flow, c, residual).largest);
    const ViscousSystem system = advected(flow, c, diffusion, carrier, dt);
    ViscousSolver solver(layout);
    Real left_over = 0;
    const Field<Real> nothing("nothing", layout);
    EXPECT_EQ(solver.solve(system, nothing, correction, 1e-8, 1, 200, left_over).iterations, 0);
    EXPECT_EQ(plain_norms(flow, c, correction).largest, 0);
    const SolverReport report = solver.solve(system, residual, correction, 1e-8, 1, 200, left_over);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, most);
    Real error = 0;
    for_fluid_points(flow, c, [&](int i, int j, int k) {
      error = std::max(error, std::abs(correction(i, j, k) - expected(i, j, k)));
    });
    EXPECT_LE(error, report.residual * scale + 1e-12);
    // without walls in the way, what is left over is what the fluid as a whole would lose
    const Real diffused = sum_over_fluid(flow, c, plain_product(flow, c, diffusion, correction));
    const Real leaving = sum_over_fluid(flow, c, plain_upwind(flow, c, carrier, dt, correction)) -
                         upwind_leak(system.upwind<Real>(), system.fixed_rows, correction);
    EXPECT_NEAR(left_over, supplied - diffused - leaving, 1e-9 * scale);
  }
}

TEST(UpwindAdvection, IsSolvedInPeriodicBoxes) {
  for (const Int3& n : {Int3{16, 16, 16}, Int3{17, 12, 9}, Int3{24, 21, 1}}) {
    const Flow open(n, {1, 1.5, 1}, no_solid()), sphere(n, {1, 1, 1}, sphere_in_the_middle(n, 3.6));
    for (const Real dt : {0.2, 5.0})
      for (const Real diffusion : {0.0, 0.3, 20.0}) {
        expect_solved(open, solenoidal_velocity(open), diffusion, dt, 60);
        expect_solved(sphere, solenoidal_velocity(sphere), diffusion, dt, 60);
      }
  }
}

TEST(UpwindAdvection, IsSolvedBetweenSides) {
  DomainSides sides;
  sides.side[0][0] = side_of(SideKind::Inflow);
  sides.side[0][0].velocity = {1, 0, 0};
  sides.side[0][1] = side_of(SideKind::Outflow);
  for (int axis = 1; axis < 3; ++axis)
    sides.side[axis][0] = sides.side[axis][1] = side_of(axis == 1 ? SideKind::Slip : SideKind::Wall);
  const Int3 n{30, 19, 22};
  const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 5), sides);
  for (const Real dt : {0.5, 10.0})
    for (const Real diffusion : {0.0, 0.3, 20.0})
      expect_solved(flow, uniform_stream(flow), diffusion, dt, 80);
}

TEST(UpwindAdvection, SaysThatItDidNotConverge) {
  const Flow flow({16, 16, 16}, {1, 1, 1}, no_solid());
  const Layout layout(flow.grid.cells);
  const Field<Real> residual = random_velocity(flow, 0, 3), correction("correction", layout);
  Real left_over = 0;
  const SolverReport report = ViscousSolver(layout).solve(
      advected(flow, 0, 0.1, solenoidal_velocity(flow), 20), residual, correction, 1e-8, 1, 1, left_over);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_GT(report.residual, 1e-8);
}

}  // namespace
}  // namespace peclet::flow
