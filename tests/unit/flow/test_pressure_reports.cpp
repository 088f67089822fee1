// What the pressure solver says when it fails, and that it does not allocate.
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/flow/pressure_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

TEST(PressureSolver, ReportsFailure) {
  const Int3 n{32, 32, 32};
  const PressureSides sides;
  const auto open = make_faces(n, sides, all_open());
  PressureSolver solver(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides);
  solver.set_open_fractions(open, RowRanges(n));
  const Field<Real> phi("phi", Layout(n));
  PressureSettings settings;
  settings.max_iterations = 2;
  SolveReport report = solver.solve(random_field(n, 15), phi, settings);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_GT(report.residual, 1e-6);
  const Field<Real> broken = random_field(n, 16);
  broken(3, 4, 5) = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_FALSE(solver.solve(broken, phi, PressureSettings()).converged);
}

TEST(PressureSolver, NamesWhatIsWrong) {
  PressureSides half;
  half.side[1][0] = PressureSide::Closed;
  EXPECT_THROW(PressureSolver(Grid{{8, 8, 8}, {1, 1, 1}, {0, 0, 0}}, half), std::invalid_argument);
  EXPECT_THROW(PressureSolver(Grid{{8, 0, 8}, {1, 1, 1}, {0, 0, 0}}, PressureSides()), std::invalid_argument);
  EXPECT_THROW(PressureSolver(Grid{{8, 8, 8}, {1, -1, 1}, {0, 0, 0}}, PressureSides()),
               std::invalid_argument);
  const Int3 n{8, 8, 8};
  PressureSolver solver(Grid{n, {1, 1, 1}, {0, 0, 0}}, PressureSides());
  const Field<Real> rhs("rhs", Layout(n)), phi("phi", Layout(n)), small("small", Layout({4, 4, 4}));
  EXPECT_THROW(solver.solve(rhs, phi, PressureSettings()), std::runtime_error);
  EXPECT_THROW(solver.update_open_fractions({}), std::runtime_error);
  const auto open = make_faces(n, PressureSides(), all_open());
  EXPECT_THROW(solver.set_open_fractions(open, RowRanges(Int3{9, 8, 8})), std::invalid_argument);
  solver.set_open_fractions(open, RowRanges(n));
  EXPECT_THROW(solver.solve(small, phi, PressureSettings()), std::invalid_argument);
  PressureSettings negative;
  negative.relative_tolerance = -1;
  EXPECT_THROW(solver.solve(rhs, phi, negative), std::invalid_argument);
}

struct Allocations {
  static int count;
  static void add(Kokkos_Profiling_SpaceHandle, const char*, const void*, std::uint64_t) { ++count; }
};
int Allocations::count = 0;

TEST(PressureSolver, SolvesAndUpdatesWithoutAllocating) {
  const Int3 n{40, 36, 32};
  const PressureSides sides;
  const auto open = make_faces(n, sides, spheres(n, {{10, 12, 14}}, 5));
  PressureSolver solver(Grid{n, {1, 1, 1}, {0, 0, 0}}, sides);
  solver.set_open_fractions(open, RowRanges(n));
  const Field<Real> rhs = random_field(n, 17), phi("phi", Layout(n));
  Allocations::count = 0;
  Kokkos::Tools::Experimental::set_allocate_data_callback(Allocations::add);
  solver.update_open_fractions({Box{{4, 6, 8}, {18, 19, 21}}});
  solver.solve(rhs, phi, PressureSettings());
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  EXPECT_EQ(Allocations::count, 0);
}

}  // namespace
}  // namespace peclet::flow
