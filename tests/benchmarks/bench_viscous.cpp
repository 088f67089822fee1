// Time of the viscous solve and of the momentum residual, one velocity component each.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "flow/immersed_boundary.hpp"
#include "flow/momentum.hpp"
#include "flow/viscous_solver.hpp"
#include "tests/benchmarks/harness.hpp"

namespace {
using namespace peclet;
using namespace peclet::flow;
using namespace peclet::benchmarks;

struct Case {
  std::string name;
  Int3 cells;
  std::function<Real(Vec3)> distance;  ///< positive in the fluid
};

Case tank() {
  const Int3 n{88, 304, 88};
  const auto distance = [n](Vec3 x) {
    const Real wall = std::min({x.x - 8.3, 80.3 - x.x, x.y - 8.3, 296.3 - x.y, x.z - 8.3, 80.3 - x.z});
    return std::min({wall, sphere_distance(x, {44, 200, 44}, 6, n), sphere_distance(x, {45, 215, 44}, 6, n)});
  };
  return {"tank 88x304x88, two spheres", n, distance};
}

Case open_box(const Int3& n) {
  const std::string name = std::to_string(n[0]) + "x" + std::to_string(n[1]) + "x" + std::to_string(n[2]);
  return {name + " open", n, [](Vec3) { return Real{9}; }};
}

Case one_sphere(int n) {
  const Int3 cells{n, n, n};
  const Vec3 middle{0.5 * n + 0.1, 0.5 * n - 0.2, 0.5 * n};
  return {"sphere in " + std::to_string(n) + "^3", cells,
          [=](Vec3 x) { return sphere_distance(x, middle, 0.3 * n, cells); }};
}

void run(const Case& c, Real number, int repetitions, Table& table) {
  const Layout layout(c.cells);
  const Grid grid{c.cells, {1, 1, 1}, {0, 0, 0}};
  const Periodicity periodic;
  const Field<Real> samples("samples", layout);
  for (int k = 0; k < c.cells[2]; ++k)
    for (int j = 0; j < c.cells[1]; ++j)
      for (int i = 0; i < c.cells[0]; ++i) samples(i, j, k) = c.distance(grid.cell_center(i, j, k));
  fill_periodic_ghosts(samples, periodic);
  const DomainSides sides;
  ImmersedBoundary boundary(grid, sides);
  Bodies bodies;
  boundary.build(bodies, samples, {number, 1});
  boundary.refresh_friction(bodies);
  const SweepPlan plan(c.cells, boundary.rows().box, periodic.axis);

  MomentumTerms terms;
  terms.grid = grid;
  terms.velocity = FaceVector<Real>("velocity", layout);
  terms.previous = FaceVector<Real>("previous", layout);
  terms.extrapolated = FaceVector<Real>("extrapolated", layout);
  terms.pressure = Field<Real>("pressure", layout);
  terms.kinematic_viscosity = number;
  terms.scheme = AdvectionScheme::Koren;
  std::srand(3);
  for (int k = 0; k < c.cells[2]; ++k)
    for (int j = 0; j < c.cells[1]; ++j)
      for (int i = 0; i < c.cells[0]; ++i)
        for (int a = 0; a < 3; ++a)
          terms.extrapolated[a](i, j, k) =
              boundary.open()[a](i, j, k)
                  ? std::sin(0.1 * i + 0.05 * j + a) * std::cos(0.07 * k) + 0.1 * std::rand() / RAND_MAX
                  : 0;
  for (int a = 0; a < 3; ++a) fill_periodic_ghosts(terms.extrapolated[a], periodic);

  const Field<Real> residual("residual", layout), correction("correction", layout);
  ViscousSolver solver(layout);
  Best residual_time, leak_time, solve_time;
  SolverReport report;
  const int component = 1;
  const WallRows &fixed = boundary.fixed_rows(component), &moving = boundary.moving_rows(component);
  const Field<OpenFraction>& open = boundary.open()[component];
  for (int n = 0; n < repetitions; ++n) {
    leak_time.add([&] { advective_leak(component, terms, fixed, moving); });
    residual_time.add(
        [&] { compute_momentum_residual(component, terms, plan, boundary.rows(), fixed, moving, residual); });
    Real left_over = 0;
    const ViscousSystem system{grid, sides, component, number, &plan, boundary.rows(), open, fixed, moving};
    solve_time.add([&] { report = solver.solve(system, residual, correction, 1e-8, 1, 200, left_over); });
  }
  const double cells = static_cast<double>(c.cells[0]) * c.cells[1] * c.cells[2];
  table.add({c.name, number, double(report.iterations), report.residual, solve_time.wall,
             solve_time.processor, 1e6 * solve_time.wall / cells, residual_time.wall, leak_time.wall,
             report.converged ? "" : "NOT CONVERGED"});
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const Options options(argc, argv);
  Table table("viscous", {"case", "nu dt/h2", "iterations", "residual", "solve ms", "cpu ms", "ns/cell",
                          "momentum ms", "leak ms", "failure"});
  std::vector<Case> cases{tank(), one_sphere(64)};
  for (const int n : {48, 64, 96, 128, 160, 256, 320}) cases.push_back(open_box({n, n, n}));
  for (const Case& c : cases)
    if (options.wants(c.name))
      for (const Real number : {0.017, 1.0, 50.0, 1e4}) run(c, number, number > 1 ? 3 : 10, table);
  return table.finish(options);
}
