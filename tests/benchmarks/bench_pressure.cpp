// Time, iterations and memory of the pressure solve.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "flow/pressure_solver.hpp"
#include "tests/benchmarks/harness.hpp"

namespace {
using namespace peclet;
using namespace peclet::flow;
using namespace peclet::benchmarks;

using Distance = std::function<Real(Vec3)>;

struct Case {
  std::string name;
  Int3 cells;
  Distance distance;  ///< positive in the fluid
  RowRanges rows;
};

/// Open part of a face from the distances at its centre and the four points between centre and corners.
OpenFraction open_fraction(const Distance& distance, Vec3 centre, int axis) {
  int open = 0;
  for (int a = -4; a < 4; ++a)
    for (int b = -4; b < 4; ++b) {
      Vec3 x = centre;
      x[(axis + 1) % 3] += (a + 0.5) / 8;
      x[(axis + 2) % 3] += (b + 0.5) / 8;
      open += distance(x) > 0;
    }
  return static_cast<OpenFraction>(open * (fully_open / 64));
}

FaceVector<OpenFraction> sample(const Case& c) {
  const Layout layout(c.cells);
  FaceVector<OpenFraction> open("open", layout);
  const Grid grid{c.cells, {1, 1, 1}, {0, 0, 0}};
  const int g = Layout::ghost_width;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = -g; k < c.cells[2] + g; ++k)
      for (int j = -g; j < c.cells[1] + g; ++j)
        for (int i = -g; i < c.cells[0] + g; ++i) {
          const Int3& n = c.cells;
          const Int3 p{(i + 2 * n[0]) % n[0], (j + 2 * n[1]) % n[1], (k + 2 * n[2]) % n[2]};
          const Vec3 x = grid.face_center(axis, p[0], p[1], p[2]);
          const Real d = c.distance(x);
          open[axis](i, j, k) = d > 1 ? fully_open : (d < -1 ? 0 : open_fraction(c.distance, x, axis));
        }
  return open;
}

Case tank() {
  const Int3 n{88, 304, 88};
  const auto distance = [n](Vec3 x) {
    const Real wall = std::min({x.x - 8, 80 - x.x, x.y - 8, 296 - x.y, x.z - 8, 80 - x.z});
    return std::min({wall, sphere_distance(x, {44, 200, 44}, 6, n), sphere_distance(x, {45, 215, 44}, 6, n)});
  };
  return {"tank 88x304x88, two spheres", n, distance, RowRanges(Box{{8, 8, 8}, {80, 296, 80}})};
}

Case open_box(const Int3& n) {
  const std::string name = std::to_string(n[0]) + "x" + std::to_string(n[1]) + "x" + std::to_string(n[2]);
  return {name + " open", n, [](Vec3) { return Real{9}; }, RowRanges(n)};
}

/// Spheres on a perturbed body-centred lattice.
Case packing(int n, int per_side, Real fraction) {
  std::vector<Vec3> centres;
  std::srand(5);
  const Real a = static_cast<Real>(n) / per_side;
  const auto noise = [a] { return 0.02 * a * (2.0 * std::rand() / RAND_MAX - 1); };
  for (int k = 0; k < per_side; ++k)
    for (int j = 0; j < per_side; ++j)
      for (int i = 0; i < per_side; ++i)
        for (const Real s : {0.25, 0.75})
          centres.push_back({(i + s) * a + noise(), (j + s) * a + noise(), (k + s) * a + noise()});
  const Real radius = std::cbrt(fraction * a * a * a / 2 / (4.0 / 3 * M_PI));
  const Int3 cells{n, n, n};
  const auto distance = [=](Vec3 x) {
    Real d = n;
    for (const Vec3& c : centres) d = std::min(d, sphere_distance(x, c, radius, cells));
    return d;
  };
  return {"packing " + std::to_string(fraction).substr(0, 4) + " in " + std::to_string(n) + "^3", cells,
          distance, RowRanges(cells)};
}

/// Spheres that leave gaps of this width between each other and to the wall around the box.
Case narrow_gaps(int n, Real gap) {
  const Real radius = 0.2 * n, middle = 0.5 * n + 0.3;
  const Int3 cells{n, n, n};
  const auto distance = [=](Vec3 x) {
    const Vec3 low{middle - radius - gap / 2, middle, middle},
        high{middle + radius + gap / 2, middle, middle};
    const Real wall = std::min({x.x, x.y, x.z}) - (middle - 2 * radius - 1.5 * gap);
    return std::min({wall, sphere_distance(x, low, radius, cells), sphere_distance(x, high, radius, cells)});
  };
  return {"gaps of " + std::to_string(gap).substr(0, 4) + " in " + std::to_string(n) + "^3", cells, distance,
          RowRanges(cells)};
}

/// Two chambers with a hollow sphere in each: four regions of fluid.
Case split_domain(int n) {
  const Int3 cells{n, n, n};
  const auto distance = [=](Vec3 x) {
    const Real slabs = std::min(std::abs(x.x - 0.03 * n), std::abs(x.x - 0.5 * n)) - 1.3;
    Real d = slabs;
    for (const Real s : {0.26, 0.75}) {
      const Real outside = sphere_distance(x, {s * n, 0.5 * n, 0.5 * n}, 0.15 * n, cells);
      d = std::min(d, std::abs(outside) - 1.3);
    }
    return d;
  };
  return {"four regions in " + std::to_string(n) + "^3", cells, distance, RowRanges(cells)};
}

Field<Real> make_rhs(const Case& c) {
  const Field<Real> rhs("rhs", Layout(c.cells));
  std::srand(3);
  for (int k = 0; k < c.cells[2]; ++k)
    for (int j = 0; j < c.cells[1]; ++j)
      for (int i = 0; i < c.cells[0]; ++i)
        rhs(i, j, k) = std::sin(0.1 * i + 0.05 * j) * std::cos(0.07 * k) + 2.0 * std::rand() / RAND_MAX - 1;
  return rhs;
}

/// One row per tolerance; the iterations to 1e-6.
int run(const Case& c, int repetitions, Table& table) {
  const FaceVector<OpenFraction> open = sample(c);
  PressureSolver solver(Grid{c.cells, {1, 1, 1}, {0, 0, 0}}, PressureSides());
  Best set_time, update_time;
  set_time.add([&] { solver.set_open_fractions(open, c.rows); });
  update_time.add([&] {
    solver.update_open_fractions({Box{{38, 8, 38}, {50, 20, 50}}, Box{{38, 30, 38}, {50, 42, 50}}});
  });
  const Field<Real> given = make_rhs(c), rhs("rhs", Layout(c.cells)), phi("phi", Layout(c.cells));
  const double cells = static_cast<double>(c.cells[0]) * c.cells[1] * c.cells[2];
  int iterations = 0;
  for (const Real tolerance : {1e-8, 1e-6}) {
    PressureSettings settings;
    settings.relative_tolerance = tolerance;
    Best solve_time;
    SolveReport report;
    for (int n = 0; n < repetitions; ++n) {
      phi.fill(0);
      Kokkos::deep_copy(rhs.array(), given.array());
      solve_time.add([&] { report = solver.solve(rhs, phi, settings); });
    }
    iterations = report.iterations;
    table.add({c.name, tolerance, double(iterations), solve_time.wall, solve_time.processor,
               1e6 * solve_time.wall / cells, static_cast<double>(solver.bytes()) / cells, set_time.wall,
               update_time.wall, report.converged ? "" : "NOT CONVERGED"});
  }
  std::fprintf(stderr, "%s\n", c.name.c_str());
  return iterations;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases{tank()};
  for (const int n : {32, 48, 64, 96, 128, 160, 256, 320}) cases.push_back(open_box({n, n, n}));
  for (const Int3& n : {Int3{63, 65, 33}, Int3{127, 127, 127}, Int3{97, 101, 103}, Int3{8, 256, 256},
                        Int3{256, 256, 8}, Int3{512, 512, 1}})
    cases.push_back(open_box(n));
  for (const int n : {96, 160}) cases.push_back(packing(n, 3, 0.5));
  for (const Real gap : {1.0, 0.25}) cases.push_back(narrow_gaps(96, gap));
  cases.push_back(split_domain(96));
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const Options options(argc, argv);
  Table table("pressure", {"case", "rtol", "iterations", "ms", "cpu ms", "ns/cell", "B/cell", "set ms",
                           "update ms", "failure"});
  int most = 0, coarse = 0, fine = 0;
  for (const Case& c : all_cases()) {
    if (!options.wants(c.name)) continue;
    const int iterations = run(c, 5, table);
    most = std::max(most, iterations);
    if (c.name == "32x32x32 open") coarse = iterations;
    if (c.name == "256x256x256 open") fine = iterations;
  }
  const auto add_first = [&](const std::string& name, int iterations) {
    table.add_first({name, 1e-6, double(iterations), "", "", "", "", "", "", ""});
  };
  if (most) add_first("most of all cases", most);
  if (coarse && fine) add_first("growth from 32^3 to 256^3", fine - coarse);
  return table.finish(options);
}
