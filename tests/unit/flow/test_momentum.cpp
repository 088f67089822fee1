#include "flow/momentum.hpp"

#include <gtest/gtest.h>

#include "tests/unit/flow/viscous_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

MomentumTerms terms_of(const Flow& flow) {
  const Layout layout(flow.grid.cells);
  MomentumTerms terms;
  terms.grid = flow.grid;
  terms.extrapolated = FaceVector<Real>("extrapolated", layout);
  terms.velocity = FaceVector<Real>("velocity", layout);
  terms.previous = FaceVector<Real>("previous", layout);
  terms.pressure = Field<Real>("pressure", layout);
  terms.time_step = 0.25;
  terms.density = 2;
  return terms;
}

using Profile = std::function<Real(Vec3)>;

/// Component c of the velocity, ghosts included.
void set_velocity(const Flow& flow, const MomentumTerms& terms, int c, const Profile& profile) {
  const int g = Layout::ghost_width;
  const Int3 n = flow.grid.cells;
  for (int k = -g; k < n[2] + g; ++k)
    for (int j = -g; j < n[1] + g; ++j)
      for (int i = -g; i < n[0] + g; ++i)
        terms.extrapolated[c](i, j, k) = profile(flow.grid.face_center(c, i, j, k));
}

Field<Real> residual_of(const Flow& flow, int c, const MomentumTerms& terms) {
  const Field<Real> residual("residual", Layout(flow.grid.cells));
  advective_leak(c, terms, flow.boundary.fixed_rows(c), flow.boundary.moving_rows(c));
  compute_momentum_residual(c, terms, flow.plans[c], flow.rows[c], flow.boundary.fixed_rows(c),
                            flow.boundary.moving_rows(c), residual);
  return residual;
}

void expect_everywhere(const Flow& flow, int c, const Field<Real>& residual, const Profile& expected) {
  for_fluid_points(flow, c, [&](int i, int j, int k) {
    ASSERT_NEAR(residual(i, j, k), expected(flow.grid.face_center(c, i, j, k)), 1e-11)
        << i << " " << j << " " << k;
  });
}

constexpr AdvectionScheme schemes[] = {AdvectionScheme::SecondUpwind, AdvectionScheme::Koren,
                                       AdvectionScheme::Central};

TEST(Momentum, ForceAndPressureGradientAccelerate) {
  const Flow flow({12, 7, 9}, {0.5, 1, 2}, no_solid());
  MomentumTerms terms = terms_of(flow);
  terms.acceleration = {3, 0, -1};
  const int g = Layout::ghost_width;
  for (int k = -g; k < 9 + g; ++k)
    for (int j = -g; j < 7 + g; ++j)
      for (int i = -g; i < 12 + g; ++i) terms.pressure(i, j, k) = 4 * 0.5 * i + 6 * j - 10 * k;
  const Real expected[] = {0.25 * (3 - 4 / 2.0), 0.25 * (-6 / 2.0), 0.25 * (-1 + 5 / 2.0)};
  for (int c = 0; c < 3; ++c)
    expect_everywhere(flow, c, residual_of(flow, c, terms), [&](Vec3) { return expected[c]; });
}

TEST(Momentum, ViscosityIsExactForParabolas) {
  const Flow flow({9, 8, 7}, {0.5, 1, 2}, no_solid());
  MomentumTerms terms = terms_of(flow);
  terms.kinematic_viscosity = 0.3;
  for (int c = 0; c < 3; ++c) {
    set_velocity(flow, terms, c,
                 [](Vec3 x) { return x.x * x.x - 2 * x.y * x.y + 0.5 * x.z * x.z + x.x * x.y; });
    expect_everywhere(flow, c, residual_of(flow, c, terms), [](Vec3) { return 0.25 * 0.3 * (2 - 4 + 1); });
  }
}

TEST(Momentum, AStreamCarriesALinearProfile) {
  const Flow flow({11, 9, 8}, {0.5, 1, 2}, no_solid());
  MomentumTerms terms = terms_of(flow);
  for (const AdvectionScheme scheme : schemes)
    for (const Real sign : {1.0, -1.0}) {
      terms.scheme = scheme;
      const Vec3 stream{sign * 1.5, -sign * 0.5, sign * 2};
      for (int c = 0; c < 3; ++c) {
        for (int a = 0; a < 3; ++a) set_velocity(flow, terms, a, [&](Vec3) { return stream[a]; });
        const int across = (c + 1) % 3;
        set_velocity(flow, terms, c, [&](Vec3 x) { return stream[c] + 0.1 * x[across]; });
        expect_everywhere(flow, c, residual_of(flow, c, terms),
                          [&](Vec3) { return -0.25 * stream[across] * 0.1; });
      }
    }
}

TEST(Momentum, TheLastStepEntersWithTheRatioOfTheSteps) {
  const Flow flow({9, 8, 7}, {1, 1, 1}, no_solid());
  MomentumTerms terms = terms_of(flow);
  terms.step_ratio = 0.5;
  for (int c = 0; c < 3; ++c) {
    terms.velocity[c].fill(3);
    terms.previous[c].fill(1);
    expect_everywhere(flow, c, residual_of(flow, c, terms), [](Vec3) { return -0.5 * 2; });
  }
}

/// What A(v) adds up to over the fluid is what advective_leak says.
TEST(Momentum, TheLeakIsTheSumOfAdvection) {
  const Int3 n{20, 18, 21};
  const Flow flow(n, {1, 1, 1}, sphere_in_the_middle(n, 5.4));
  MomentumTerms terms = terms_of(flow);
  for (int a = 0; a < 3; ++a) {
    const Field<Real> random = random_velocity(flow, a, 3 + a);
    Kokkos::deep_copy(terms.extrapolated[a].array(), random.array());
    fill_velocity_ghosts(terms.extrapolated, a, flow.sides);
  }
  for (const AdvectionScheme scheme : schemes) {
    terms.scheme = scheme;
    for (int c = 0; c < 3; ++c) {
      const Real leak = advective_leak(c, terms, flow.boundary.fixed_rows(c), flow.boundary.moving_rows(c));
      EXPECT_NE(leak, 0);
      EXPECT_NEAR(plain_norms(flow, c, residual_of(flow, c, terms)).sum, -terms.time_step * leak, 1e-11);
    }
  }
}

/// Between parallel walls at any distance from the lattice: the profile that the viscous term balances.
TEST(Momentum, ViscosityIsExactBetweenWalls) {
  const Int3 n{6, 14, 6};
  const Real low = 1.8, high = 11.3;
  const Flow flow(n, {1, 1, 1}, [=](Vec3 x) { return std::min(x.y - low, high - x.y); });
  MomentumTerms terms = terms_of(flow);
  terms.kinematic_viscosity = 0.3;
  set_velocity(flow, terms, 0,
               [=](Vec3 x) { return x.y < low || x.y > high ? 0 : (x.y - low) * (high - x.y); });
  const Field<Real> residual = residual_of(flow, 0, terms);
  for_fluid_points(flow, 0,
                   [&](int i, int j, int k) { EXPECT_NEAR(residual(i, j, k), -0.25 * 0.3 * 2, 1e-6); });
}

}  // namespace
}  // namespace peclet::flow
