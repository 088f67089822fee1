#include "flow/moving_walls.hpp"

#include <gtest/gtest.h>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75
const SphereInTest crossing_the_edge{{5.6, 3.1, 6.9}, 1.9};

/// Outward flux of a uniform velocity through the open parts of the faces, per volume, plus that of the
/// walls.
std::vector<Real> flux_balance(const ImmersedBoundary& boundary, Vec3 velocity) {
  const Field<Real> balance("balance", Layout(grid.cells));
  const FaceVector<OpenFraction> open = boundary.open();
  const Grid box = grid;
  for_each_cell(
      "flux_of_stream", RowRanges(box.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = open.x.layout()(i, j, k);
        for (int a = 0; a < 3; ++a)
          balance[p] +=
              velocity[a] * open_fraction_unit / box.spacing[a] *
              (static_cast<Real>(open[a][p + open.x.layout().stride(a)]) - static_cast<Real>(open[a][p]));
      });
  const CutCells cut = boundary.cut_cells();
  for_each("flux_of_walls", cut.count, KOKKOS_LAMBDA(Index n) { balance[cut.cell(n)] += cut.wall_flux(n); });
  return host_values(balance);
}

Real total_wall_flux(const ImmersedBoundary& boundary) {
  const CutCells cut = boundary.cut_cells();
  return sum_each("total_wall_flux", cut.count, KOKKOS_LAMBDA(Index n) { return cut.wall_flux(n); });
}

Real wall_flux_magnitude(const ImmersedBoundary& boundary) {
  const CutCells cut = boundary.cut_cells();
  return sum_each(
      "wall_flux_magnitude", cut.count, KOKKOS_LAMBDA(Index n) { return Kokkos::abs(cut.wall_flux(n)); });
}

TEST(MovingWalls, AStreamThatMovesWithTheBodyIsFreeOfDivergence) {
  const Vec3 velocity{0.3, -0.2, 0.1};
  const BoundaryInTest moves({moving(crossing_the_edge, velocity)});
  const std::vector<Real> balance = flux_balance(moves.boundary, velocity);
  for (const Real value : balance) EXPECT_NEAR(value, 0, 1e-14);
}

TEST(MovingWalls, RigidMotionOfAClosedBodyDisplacesNoVolume) {
  const BoundaryInTest moves({moving(crossing_the_edge, {0.3, -0.2, 0.1}, {0.5, 0.2, -0.4}),
                              moving({{1.9, 5.2, 3.1}, 1.2}, {0, 0.1, 0}, {0, 0, 1})});
  EXPECT_GT(wall_flux_magnitude(moves.boundary), 1);
  EXPECT_NEAR(total_wall_flux(moves.boundary), 0, 1e-12 * wall_flux_magnitude(moves.boundary));
}

TEST(MovingWalls, FacesInsideABodyMoveWithIt) {
  const BoundaryInTest moves({moving(crossing_the_edge, {0.3, -0.2, 0.1})});
  const Real expected[3] = {0.3, -0.2, 0.1};
  for (int c = 0; c < 3; ++c) {
    const Field<Real> velocity("velocity", Layout(grid.cells));
    impose_body_velocity(moves.boundary.body_faces(c), velocity);
    const std::vector<Real> u = host_values(velocity);
    const std::vector<OpenFraction> open = host_values(moves.boundary.open()[c]);
    for (std::size_t n = 0; n < u.size(); ++n) EXPECT_EQ(u[n], open[n] == 0 ? expected[c] : 0);
  }
}

}  // namespace
