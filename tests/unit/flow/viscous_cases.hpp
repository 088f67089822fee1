#pragma once
// Small flows around bodies for the tests of the momentum predictor and the viscous solver, on the host.
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>

#include "flow/immersed_boundary.hpp"
#include "flow/momentum.hpp"
#include "flow/viscous_solver.hpp"

namespace peclet::flow::testing {

/// Signed distance, negative inside solid.
using Distance = std::function<Real(Vec3)>;

inline Distance no_solid() {
  return [](Vec3) { return Real{99}; };
}

inline Distance sphere_in_the_middle(const Int3& n, Real radius) {
  return [=](Vec3 x) {
    const Vec3 r{x.x - 0.5 * n[0] - 0.13, x.y - 0.5 * n[1] + 0.21, x.z - 0.5 * n[2] - 0.3};
    return norm(r) - radius;
  };
}

inline Distance tank(const Int3& n) {
  return [=](Vec3 x) {
    Real d = 99;
    for (int a = 0; a < 3; ++a) d = std::min({d, x[a] - 1.7, n[a] - 1.4 - x[a]});
    return d;
  };
}

struct Flow {
  Grid grid;
  DomainSides sides;
  ImmersedBoundary boundary;
  RowRanges rows[3];
  SweepPlan plans[3];

  Flow(const Int3& n, const Real3& spacing, const Distance& distance, const DomainSides& box = {})
      : grid{n, spacing, {0, 0, 0}}, sides(box), boundary(grid, box) {
    const Field<Real> samples("samples", Layout(n));
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i)
          samples(i, j, k) =
              distance(Vec3{i + 0.5, j + 0.5, k + 0.5}) * std::min({spacing[0], spacing[1], spacing[2]});
    fill_mirrored_ghosts(samples, sides);
    Bodies bodies;
    boundary.build(bodies, samples, {0.1, 1e-2});
    boundary.refresh_friction(bodies);
    const Periodicity periodic = sides.periodicity();
    for (int c = 0; c < 3; ++c) {
      rows[c] = velocity_rows(boundary.rows(), sides, n, c);
      plans[c] = SweepPlan(n, rows[c].box, periodic.axis);
    }
  }

  ViscousSystem system(int c, Real diffusion) const {
    return {grid,
            sides,
            c,
            diffusion,
            &plans[c],
            rows[c],
            boundary.open()[c],
            boundary.fixed_rows(c),
            boundary.moving_rows(c)};
  }
};

/// action(i, j, k) at the unknowns of component c.
template <class Action>
void for_fluid_points(const Flow& flow, int c, const Action& action) {
  const Box box = flow.rows[c].box;
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i)
        if (flow.boundary.open()[c](i, j, k)) action(i, j, k);
}

/// Random numbers at the unknowns, zero elsewhere.
inline Field<Real> random_velocity(const Flow& flow, int c, unsigned seed) {
  const Field<Real> field("random", Layout(flow.grid.cells));
  std::mt19937 generator(seed);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  for_fluid_points(flow, c, [&](int i, int j, int k) { field(i, j, k) = uniform(generator); });
  return field;
}

/// (1 - diffusion L) e at the unknowns, written out point by point; fills the ghosts of e.
inline Field<Real> plain_product(const Flow& flow, int c, Real diffusion, const Field<Real>& e) {
  const Layout layout(flow.grid.cells);
  fill_correction_ghosts(e, c, flow.sides);
  const WallRows& walls = flow.boundary.fixed_rows(c);
  std::map<Index, Index> row_at;
  for (Index row = 0; row < walls.count; ++row) row_at[walls.face(row)] = row;
  const Field<Real> out("product", layout);
  for_fluid_points(flow, c, [&](int i, int j, int k) {
    const Index p = layout(i, j, k);
    const auto found = row_at.find(p);
    Real sum = e[p];
    for (int d = 0; d < 6; ++d) {
      const Real h = flow.grid.spacing[d / 2];
      const Index q = p + (d % 2 ? 1 : -1) * layout.stride(d / 2);
      const bool at_wall = found != row_at.end();
      const Real weight = at_wall ? walls.weight(found->second, d) : 1.0;
      const Real neighbor = at_wall && walls.is_wall(found->second, d) ? 0.0 : e[q];
      sum += diffusion / (h * h) * weight * (e[p] - neighbor);
    }
    out[p] = sum;
  });
  return out;
}

inline Norms plain_norms(const Flow& flow, int c, const Field<Real>& field) {
  Norms norms;
  for_fluid_points(flow, c, [&](int i, int j, int k) {
    const Real value = field(i, j, k);
    norms.join({value, value * value, std::abs(value)});
  });
  return norms;
}

inline DomainSide side_of(SideKind kind) {
  DomainSide side;
  side.kind = kind;
  return side;
}

}  // namespace peclet::flow::testing
