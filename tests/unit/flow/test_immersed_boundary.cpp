#include "flow/immersed_boundary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "boundary_in_tests.hpp"

namespace {

using namespace peclet;
using namespace peclet::flow;

const Grid grid = grid_in_tests();  // 7 x 6.875 x 6.75
const SphereInTest crossing_the_edge{{5.6, 3.1, 6.9}, 1.9};

std::vector<OpenFraction> open_values(const ImmersedBoundary& boundary) {
  std::vector<OpenFraction> all;
  for (int a = 0; a < 3; ++a) {
    const std::vector<OpenFraction> values = host_values(boundary.open()[a]);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

TEST(ImmersedBoundary, WithoutBodiesEveryFaceIsOpen) {
  const BoundaryInTest empty({});
  for (const OpenFraction open : open_values(empty.boundary)) EXPECT_EQ(open, fully_open);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(empty.boundary.fixed_rows(c).count, 0);
}

TEST(ImmersedBoundary, ClosedFacesFillTheVolumeOfTheBody) {
  const BoundaryInTest fixed({crossing_the_edge});
  for (int a = 0; a < 3; ++a) {
    Real closed = 0;
    for (const OpenFraction open : host_values(fixed.boundary.open()[a])) closed += open == 0;
    const Real volume = 4.0 / 3.0 * std::acos(-1.0) * std::pow(1.9, 3);
    // points of a lattice inside a sphere of three cells radius
    EXPECT_NEAR(closed * grid.cell_volume(), volume, 0.1 * volume);
  }
}

TEST(ImmersedBoundary, FixedAndMovingBodiesAreSampledAlike) {
  const BoundaryInTest fixed({crossing_the_edge}), moves({moving(crossing_the_edge, {0.1, 0, 0})});
  std::vector<OpenFraction> open = open_values(moves.boundary);
  for (OpenFraction& value : open) value = is_slit(value) ? 0 : value;
  EXPECT_EQ(open_values(fixed.boundary), open);
  for (int c = 0; c < 3; ++c)
    EXPECT_EQ(fixed.boundary.fixed_rows(c).count, moves.boundary.moving_rows(c).count);
}

TEST(ImmersedBoundary, AnUpdateGivesWhatANewBuildWould) {
  BoundaryInTest moved({moving({{1.9, 5.2, 3.1}, 1.2}, {0.1, 0, 0}), {{4.9, 3.1, 1.9}, 1.6}});
  const Field<Real> pressure("pressure", Layout(grid.cells));
  for (const Vec3 position : {Vec3{2.6, 4.9, 3.3}, Vec3{6.3, 7.0, 0.2}}) {
    const std::vector<OpenFraction> before = open_values(moved.boundary);
    moved.bodies.set_pose(0, position, {});
    moved.boundary.update(moved.bodies, pressure, {0.1, 1e-2});
    const BoundaryInTest fresh({moving({position, 1.2}, {0.1, 0, 0}), {{4.9, 3.1, 1.9}, 1.6}});
    EXPECT_EQ(open_values(moved.boundary), open_values(fresh.boundary));
    EXPECT_NE(open_values(moved.boundary), before);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(moved.boundary.moving_rows(c).count, fresh.boundary.moving_rows(c).count);
      EXPECT_EQ(moved.boundary.body_faces(c).count, fresh.boundary.body_faces(c).count);
    }
    EXPECT_EQ(moved.boundary.cut_cells().count, fresh.boundary.cut_cells().count);
  }
}

std::vector<Real> first_values(const Array<Real>& values, Index count) {
  std::vector<Real> result = copy_to_host(values);
  result.resize(static_cast<std::size_t>(count));
  return result;
}

void expect_same_walls(const ImmersedBoundary& found, const ImmersedBoundary& expected) {
  EXPECT_EQ(open_values(found), open_values(expected));
  for (int c = 0; c < 3; ++c) {
    const WallRows &rows = found.moving_rows(c), &expected_rows = expected.moving_rows(c);
    EXPECT_EQ(first_values(rows.wall_sum, rows.count),
              first_values(expected_rows.wall_sum, expected_rows.count));
    const BodyFaces &faces = found.body_faces(c), &expected_faces = expected.body_faces(c);
    EXPECT_EQ(first_values(faces.velocity, faces.count),
              first_values(expected_faces.velocity, expected_faces.count));
    EXPECT_EQ(found.slits(c).count, expected.slits(c).count);
    EXPECT_EQ(found.covered_points(c), expected.covered_points(c));
  }
  const CutCells &cut = found.cut_cells(), &expected_cut = expected.cut_cells();
  EXPECT_EQ(first_values(cut.wall_flux, cut.count), first_values(expected_cut.wall_flux, expected_cut.count));
}

/// Faces inside bodies that move with neither of two bodies that do not turn.
Index faces_in_common_motion(const ImmersedBoundary& boundary, int c, Real first, Real second) {
  const BodyFaces faces = boundary.body_faces(c);
  return static_cast<Index>(sum_each(
      "faces_in_common_motion", faces.count, KOKKOS_LAMBDA(Index n) {
        return faces.velocity(n) == first || faces.velocity(n) == second ? 0.0 : 1.0;
      }));
}

TEST(ImmersedBoundary, EveryStateHasARevisionOfItsOwn) {
  BoundaryInTest one({moving(crossing_the_edge, {0.1, 0, 0})}),
      other({moving(crossing_the_edge, {0.1, 0, 0})});
  std::set<Index> revisions{one.boundary.revision(), other.boundary.revision()};
  one.boundary.update(one.bodies, Field<Real>(), {0.1, 1e-2});
  revisions.insert(one.boundary.revision());
  one.boundary.refresh_friction(one.bodies);
  revisions.insert(one.boundary.revision());
  one.boundary.build(one.bodies, Field<Real>(), {0.1, 1e-2});
  revisions.insert(one.boundary.revision());
  revisions.insert(ImmersedBoundary(grid, DomainSides()).revision());
  EXPECT_EQ(revisions.size(), 6u);
}

TEST(ImmersedBoundary, BodiesThatMeetAndPartLeaveNoTrace) {
  const auto body = [](Vec3 center) { return moving({center, 1.1}, {0.1, 0.2, -0.1}); };
  const Vec3 far{1.1, 7.2, 5.4}, beside{2.2, 3.1, 1.9}, across_the_side{0.6, 3.1, 1.9};
  for (const bool other_moves : {true, false}) {
    const SphereInTest other{{4.9, 3.1, 1.9}, 1.6, {{other_moves ? -0.3 : 0.0, 0, 0}, {}}};
    BoundaryInTest moved({body(far), other});
    const Field<Real> pressure("pressure", Layout(grid.cells));
    for (const Vec3 center : {beside, far, across_the_side, beside, far}) {
      moved.bodies.set_pose(0, center, {});
      moved.boundary.update(moved.bodies, pressure, {0.1, 1e-2});
      moved.boundary.refresh_friction(moved.bodies);
      const BoundaryInTest fresh({body(center), other});
      expect_same_walls(moved.boundary, fresh.boundary);
      const bool is_far = center.y == far.y;
      EXPECT_EQ(faces_in_common_motion(moved.boundary, 0, 0.1, other.twist.linear.x) == 0, is_far);
    }
  }
}

TEST(ImmersedBoundary, CoveredPointsAreThoseThatAreNoFluidAnyMore) {
  const SphereInTest fixed{{4.9, 3.1, 1.9}, 1.6};
  const BoundaryInTest alone({fixed}), both({moving({{2.9, 3.6, 2.2}, 1.2}, {0.1, 0, 0}), fixed});
  for (int c = 0; c < 3; ++c) {
    const std::vector<OpenFraction> before = host_values(alone.boundary.open()[c]);
    const std::vector<OpenFraction> now = host_values(both.boundary.open()[c]);
    int covered = 0;
    for (std::size_t n = 0; n < now.size(); ++n) covered += is_fluid(before[n]) - is_fluid(now[n]);
    EXPECT_GT(covered, 0);
    EXPECT_EQ(both.boundary.covered_points(c), covered);
  }
}

TEST(ImmersedBoundary, ChangedBoxesHoldEveryFaceThatChanged) {
  BoundaryInTest moved({moving(crossing_the_edge, {0.1, 0, 0})});
  const std::vector<OpenFraction> before = open_values(moved.boundary);
  moved.bodies.set_pose(0, {1.1, 4.0, 0.8}, {});
  moved.boundary.update(moved.bodies, Field<Real>("pressure", Layout(grid.cells)), {0.1, 1e-2});
  const std::vector<OpenFraction> after = open_values(moved.boundary);
  std::size_t n = 0;
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < grid.cells[2]; ++k)
      for (int j = 0; j < grid.cells[1]; ++j)
        for (int i = 0; i < grid.cells[0]; ++i, ++n) {
          if (before[n] == after[n]) continue;
          bool inside = false;
          for (const Box& box : moved.boundary.changed()) inside = inside || box.contains(i, j, k);
          EXPECT_TRUE(inside);
        }
}

}  // namespace
