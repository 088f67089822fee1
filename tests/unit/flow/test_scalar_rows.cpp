#include "flow/scalar_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/halo.hpp"
#include "flow/cell_volume.hpp"

namespace peclet::flow {
namespace {

using Distance = std::function<Real(Vec3)>;

/// A solid given by its distance at the cell centres, everywhere in the grid and its ghosts.
SolidSampler sampled(const Grid& grid, const Distance& distance) {
  const Layout layout(grid.cells);
  SolidSampler solid;
  solid.grid = grid;
  solid.samples = Field<Real>("samples", layout);
  solid.sdf = Field<Real>("sdf", layout);
  solid.owner = Field<int>("owner", layout);
  constexpr int g = Layout::ghost_width;
  for (int k = -g; k < grid.cells[2] + g; ++k)
    for (int j = -g; j < grid.cells[1] + g; ++j)
      for (int i = -g; i < grid.cells[0] + g; ++i) {
        const Real d = distance(grid.cell_center(i, j, k));
        solid.samples(i, j, k) = solid.sdf(i, j, k) = d;
        solid.owner(i, j, k) = sampled_solid;
      }
  return solid;
}

/// An oblique plane: trilinear interpolation of its distance is exact.
Vec3 normal() { return normalized(Vec3{1, 2, -0.5}); }
Real plane(Vec3 x) { return dot(normal(), x - Vec3{0.51, 0.53, 0.47}); }

Grid small_grid() { return Grid{{6, 8, 5}, {1.0 / 6, 1.0 / 8, 1.0 / 5}, {0, 0, 0}}; }

TEST(CellVolume, OfBothSidesOfAWallFillsTheCell) {
  const Grid grid = small_grid();
  const SolidSampler solid = sampled(grid, plane);
  const SolidSampler inverse = sampled(grid, [](Vec3 x) { return -plane(x); });
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        const Real part = fluid_part_of_cell(solid, i, j, k, sampled_solid);
        EXPECT_NEAR(part + fluid_part_of_cell(inverse, i, j, k, sampled_solid), 1, 1e-12);
        EXPECT_GE(part, 0);
      }
}

TEST(CellVolume, OfAPlaneIsExact) {
  // the derivative of the fluid volume with respect to the position of the plane is the area cut from the
  // box; the second difference of a quadratic range is constant: compare with a fine count instead
  const Grid grid{{1, 1, 1}, {1.0, 0.7, 1.3}, {0.1, 0.2, -0.1}};
  const Vec3 center = grid.cell_center(0, 0, 0);
  for (const Real shift : {-0.4, -0.11, 0.0, 0.23}) {
    const Distance distance = [&](Vec3 x) { return dot(normal(), x - center) - shift; };
    const SolidSampler solid = sampled(grid, distance);
    constexpr int n = 60;
    Real count = 0;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const Vec3 x{grid.origin[0] + (i + 0.5) / n * grid.spacing[0],
                       grid.origin[1] + (j + 0.5) / n * grid.spacing[1],
                       grid.origin[2] + (k + 0.5) / n * grid.spacing[2]};
          count += distance(x) >= 0;
        }
    // the count is off by a fraction of the n^2 points beside the plane
    EXPECT_NEAR(fluid_part_of_cell(solid, 0, 0, 0, sampled_solid), count / (n * n * n), 0.3 / n);
  }
}

struct Rows {
  ScalarGeometry geometry;
  Field<OpenFraction> state;
  Field<float> volume;
  ScalarRows rows;
};

/// All sides closed by values; the solid has this wall.
Rows build(const SolidSampler& solid, const ScalarWall& wall) {
  const Layout layout = solid.sdf.layout();
  Rows result;
  result.geometry.solid = solid;
  result.geometry.open = FaceVector<OpenFraction>("open", layout);
  for (auto& pair : result.geometry.sides.side)
    for (ScalarSide& side : pair) {
      side.is_periodic = false;
      side.condition = ScalarCondition::Value;
    }
  result.geometry.walls = Array<ScalarWall>("walls", 2);
  result.geometry.walls(0) = result.geometry.walls(1) = wall;
  result.state = Field<OpenFraction>("state", layout);
  result.volume = Field<float>("volume", layout);
  const Array<Index> scratch("scratch", static_cast<std::size_t>(solid.grid.number_of_cells()));
  classify_cells(result.geometry, result.state, result.volume);
  build_scalar_rows(result.geometry, result.state, result.volume, scratch, result.rows);
  return result;
}

TEST(ScalarRows, OfWallsOfGivenFluxHaveSymmetricLinks) {
  const Grid grid = small_grid();
  const Rows r = build(sampled(grid, plane), ScalarWall{});
  const Layout& layout = r.state.layout();
  int links = 0;
  for (Index row = 0; row < r.rows.links.count; ++row)
    for (Index other = 0; other < r.rows.links.count; ++other)
      for (int d = 1; d < 6; d += 2) {
        const Index p = r.rows.links.face(row), q = r.rows.links.face(other);
        if (q != p + layout.stride(d / 2)) continue;
        if (r.rows.links.is_wall(row, d) || r.rows.links.is_wall(other, d - 1)) continue;
        if (r.state[p] != cell_state::cut && r.state[q] != cell_state::cut) continue;
        const Real here = r.rows.coefficient(row, d) * static_cast<Real>(r.volume[p]);
        const Real there = r.rows.coefficient(other, d - 1) * static_cast<Real>(r.volume[q]);
        EXPECT_NEAR(here, there, 1e-14);
        ++links;
      }
  EXPECT_GT(links, 20);
}

TEST(ScalarRows, KeepALinearFieldThroughAWallOfItsFlux) {
  const Grid grid = small_grid();
  const Vec3 gradient{0.3, -0.7, 1.1};
  // what flows into the fluid along the normal, with diffusivity 1
  const Rows r = build(sampled(grid, plane), ScalarWall{ScalarCondition::Flux, -dot(gradient, normal())});
  const Layout& layout = r.state.layout();
  const auto value = [&](Index p) {
    const Int3 c = cell_of(layout, p);
    return dot(gradient, grid.cell_center(c[0], c[1], c[2]));
  };
  int checked = 0;
  for (Index row = 0; row < r.rows.links.count; ++row) {
    const Index p = r.rows.links.face(row);
    const Int3 c = cell_of(layout, p);
    bool at_side = false, drops_slivers = false;
    for (int a = 0; a < 3; ++a) {
      at_side = at_side || c[a] == 0 || c[a] == grid.cells[a] - 1;
    }
    if (r.state[p] != cell_state::cut || at_side || r.volume[p] <= smallest_cell_volume) continue;
    Real sum = r.rows.source(row);
    for (int d = 0; d < 6; ++d) {
      const Real h = grid.spacing[d / 2];
      const Index q = d % 2 ? p + layout.stride(d / 2) : p - layout.stride(d / 2);
      drops_slivers = drops_slivers || r.rows.links.is_wall(row, d);
      sum += r.rows.coefficient(row, d) / (h * h) * (value(q) - value(p));
    }
    EXPECT_FALSE(drops_slivers);
    EXPECT_NEAR(sum, 0, 1e-11) << "cell " << c[0] << " " << c[1] << " " << c[2];
    ++checked;
  }
  EXPECT_GT(checked, 10);
}

TEST(ScalarRows, SeeAWallOfGivenValueAtItsDistance) {
  const Grid grid{{12, 1, 1}, {1.0 / 12, 1, 1}, {0, 0, 0}};
  constexpr Real position = 0.2871;
  const Rows r =
      build(sampled(grid, [&](Vec3 x) { return x.x - position; }), ScalarWall{ScalarCondition::Value, 3.0});
  const Layout& layout = r.state.layout();
  const auto parabola = [&](Real x) { return 3 + 2 * (x - position) - 5 * (x - position) * (x - position); };
  int walls = 0;
  for (Index row = 0; row < r.rows.links.count; ++row) {
    if (!r.rows.links.is_wall(row, 0) || r.rows.links.owner(row, 0) != sampled_solid) continue;
    const Index p = r.rows.links.face(row);
    const Real x = grid.cell_center(cell_of(layout, p)[0], 0, 0).x, h = grid.spacing[0];
    const Real second = (r.rows.coefficient(row, 0) * (r.rows.wall_value(row, 0) - parabola(x)) +
                         r.rows.coefficient(row, 1) * (parabola(x + h) - parabola(x))) /
                        (h * h);
    EXPECT_NEAR(second, -10, 1e-6);  // the root of the distance is found to 1e-9
    EXPECT_DOUBLE_EQ(r.rows.wall_value(row, 0), 3);
    ++walls;
  }
  EXPECT_EQ(walls, 1);
}

}  // namespace
}  // namespace peclet::flow
