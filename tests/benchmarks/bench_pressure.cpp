// Time, iterations and memory of the pressure solve.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "flow/pressure_solver.hpp"

namespace {
using namespace peclet;
using namespace peclet::flow;

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

Real periodic(Real x, Real n) { return x - n * std::round(x / n); }

Real sphere(Vec3 x, Vec3 centre, Real radius, const Int3& n) {
  return norm(Vec3{periodic(x.x - centre.x, n[0]), periodic(x.y - centre.y, n[1]),
                   periodic(x.z - centre.z, n[2])}) -
         radius;
}

Case tank() {
  const Int3 n{88, 304, 88};
  const auto distance = [n](Vec3 x) {
    const Real wall = std::min({x.x - 8, 80 - x.x, x.y - 8, 296 - x.y, x.z - 8, 80 - x.z});
    return std::min({wall, sphere(x, {44, 200, 44}, 6, n), sphere(x, {45, 215, 44}, 6, n)});
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
    for (const Vec3& c : centres) d = std::min(d, sphere(x, c, radius, cells));
    return d;
  };
  return {"packing " + std::to_string(fraction).substr(0, 4) + " in " + std::to_string(n) + "^3", cells,
          distance, RowRanges(cells)};
}

double milliseconds() {
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run(const Case& c, Real tolerance, int repetitions) {
  const Layout layout(c.cells);
  const FaceVector<OpenFraction> open = sample(c);
  PressureSolver solver(Grid{c.cells, {1, 1, 1}, {0, 0, 0}}, PressureSides());
  double start = milliseconds();
  solver.set_open_fractions(open, c.rows);
  const double set_time = milliseconds() - start;
  start = milliseconds();
  solver.update_open_fractions({Box{{38, 8, 38}, {50, 20, 50}}, Box{{38, 30, 38}, {50, 42, 50}}});
  const double update_time = milliseconds() - start;

  const Field<Real> rhs("rhs", layout), phi("phi", layout);
  std::srand(3);
  for (int k = 0; k < c.cells[2]; ++k)
    for (int j = 0; j < c.cells[1]; ++j)
      for (int i = 0; i < c.cells[0]; ++i)
        rhs(i, j, k) = std::sin(0.1 * i + 0.05 * j) * std::cos(0.07 * k) + 2.0 * std::rand() / RAND_MAX - 1;
  PressureSettings settings;
  settings.relative_tolerance = tolerance;
  double best = 1e30, processor = 1e30;
  SolveReport report;
  for (int n = 0; n < repetitions; ++n) {
    phi.fill(0);
    start = milliseconds();
    const std::clock_t processor_start = std::clock();
    report = solver.solve(rhs, phi, settings);
    best = std::min(best, milliseconds() - start);
    processor =
        std::min(processor, 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
  }
  const double cells = static_cast<double>(c.cells[0]) * c.cells[1] * c.cells[2];
  std::printf("%-30s %7.0e %4d %9.2f %9.2f %9.2f %8.1e %8.1f %9.2f %9.2f %s\n", c.name.c_str(), tolerance,
              report.iterations, best, processor, 1e6 * best / cells, report.residual,
              static_cast<Real>(solver.bytes()) / cells, set_time, update_time,
              report.converged ? "" : "NOT CONVERGED");
  std::fflush(stdout);
}

}  // namespace

/// Argument: part of the names of the cases to run; all without one.
int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  std::printf("%-30s %7s %4s %9s %9s %9s %8s %8s %9s %9s\n", "case", "rtol", "its", "ms", "cpu ms", "ns/cell",
              "residual", "B/cell", "set ms", "update ms");
  const std::string wanted = argc > 1 ? argv[1] : "";
  std::vector<Case> cases{tank()};
  for (const int n : {32, 48, 64, 96, 127, 128, 160, 256, 320}) cases.push_back(open_box({n, n, n}));
  cases.push_back(open_box({97, 101, 103}));
  cases.push_back(open_box({8, 256, 256}));
  cases.push_back(open_box({256, 256, 8}));
  cases.push_back(open_box({512, 512, 1}));
  cases.push_back(packing(96, 3, 0.5));
  cases.push_back(packing(160, 3, 0.5));
  bool found = false;
  for (const Case& c : cases) {
    if (c.name.find(wanted) == std::string::npos) continue;
    found = true;
    for (const Real tolerance : {1e-6, 1e-8}) run(c, tolerance, 8);
  }
  if (!found)
    std::fprintf(stderr, "bench_pressure: expected part of the name of a case, found %s\n", argv[1]);
  return found ? 0 : 1;
}
