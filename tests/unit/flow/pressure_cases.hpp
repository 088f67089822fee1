#pragma once
// Open fractions and reference evaluations for the tests of the pressure solver, on the host.
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "flow/pressure_solver.hpp"

namespace peclet::flow::testing {

/// Fraction of the face low of cell (i, j, k) along axis, for cells inside the box.
using Faces = std::function<OpenFraction(int axis, int i, int j, int k)>;

inline PressureSides sides_of(PressureSide x_low, PressureSide x_high, PressureSide y, PressureSide z) {
  PressureSides sides;
  sides.side[0][0] = x_low;
  sides.side[0][1] = x_high;
  for (int high = 0; high < 2; ++high) {
    sides.side[1][high] = y;
    sides.side[2][high] = z;
  }
  return sides;
}

inline int wrapped(int i, int n) { return ((i % n) + n) % n; }

/// Fills every face, ghosts included, as the solver asks for.
inline void fill_faces(const FaceVector<OpenFraction>& open, const PressureSides& sides, const Faces& faces) {
  const Int3 n = open.x.layout().cells;
  const int g = Layout::ghost_width;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = -g; k < n[2] + g; ++k)
      for (int j = -g; j < n[1] + g; ++j)
        for (int i = -g; i < n[0] + g; ++i) {
          Int3 cell{i, j, k};
          bool beyond = false;
          for (int a = 0; a < 3; ++a) {
            if (sides.is_periodic(a))
              cell[a] = wrapped(cell[a], n[a]);
            else
              beyond |= cell[a] < 0 || cell[a] >= n[a] + (a == axis);
          }
          OpenFraction value = beyond ? OpenFraction{0} : faces(axis, cell[0], cell[1], cell[2]);
          if (!sides.is_periodic(axis) && !beyond) {
            if (cell[axis] == 0 && sides.side[axis][0] == PressureSide::Closed) value = 0;
            if (cell[axis] == n[axis] && sides.side[axis][1] == PressureSide::Closed) value = 0;
          }
          open[axis](i, j, k) = value;
        }
}

inline FaceVector<OpenFraction> make_faces(const Int3& cells, const PressureSides& sides,
                                           const Faces& faces) {
  const FaceVector<OpenFraction> open("open", Layout(cells));
  fill_faces(open, sides, faces);
  return open;
}

inline Faces all_open() {
  return [](int, int, int, int) { return fully_open; };
}

/// Cells inside spheres of a periodic box are closed; faces between fluid cells are cut at random, the same
/// way for the same face.
inline Faces spheres(const Int3& n, const std::vector<Vec3>& centres, Real radius) {
  return [=](int axis, int i, int j, int k) -> OpenFraction {
    const auto distance = [&](Vec3 x) {
      Real d = 1e9;
      for (const Vec3& c : centres) {
        Vec3 r = x - c;
        for (int a = 0; a < 3; ++a) r[a] -= n[a] * std::round(r[a] / n[a]);
        d = std::min(d, norm(r) - radius);
      }
      return d;
    };
    Vec3 x{i + 0.5, j + 0.5, k + 0.5};
    x[axis] -= 0.5;
    const Real open = std::min(1.0, std::max(0.0, 0.5 + distance(x)));
    return static_cast<OpenFraction>(std::lround(open * fully_open));
  };
}

/// Sum over the faces of a cell of o (phi_neighbour - phi) / h^2; neighbours are taken from the ghosts of
/// phi.
inline Real laplacian_at(const FaceVector<OpenFraction>& open, const Field<Real>& phi, const Real3& h, int i,
                         int j, int k) {
  Real sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side <= 1; side += 2) {
      const int di = axis == 0 ? side : 0, dj = axis == 1 ? side : 0, dk = axis == 2 ? side : 0;
      const Real o = side < 0 ? open[axis](i, j, k) : open[axis](i + di, j + dj, k + dk);
      sum += o * open_fraction_unit * (phi(i + di, j + dj, k + dk) - phi(i, j, k)) / (h[axis] * h[axis]);
    }
  return sum;
}

inline bool is_open_cell(const FaceVector<OpenFraction>& open, int i, int j, int k) {
  return open.x(i, j, k) || open.x(i + 1, j, k) || open.y(i, j, k) || open.y(i, j + 1, k) ||
         open.z(i, j, k) || open.z(i, j, k + 1);
}

template <class Action>
void for_cells(const Int3& n, const Action& action) {
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) action(i, j, k);
}

inline Field<Real> random_field(const Int3& cells, unsigned seed, Real offset = 0) {
  const Field<Real> field("random", Layout(cells));
  std::mt19937 generator(seed);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  for_cells(cells, [&](int i, int j, int k) { field(i, j, k) = offset + uniform(generator); });
  return field;
}

}  // namespace peclet::flow::testing
