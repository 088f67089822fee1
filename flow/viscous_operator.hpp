#pragma once
// The operator 1 + dt U - theta dt nu L of one velocity component, row by row: the regular formula on the
// grid, wall rows beside it. U, upwind advection, is absent from explicit runs.
#include "core/field.hpp"
#include "core/sweep.hpp"
#include "flow/domain_sides.hpp"
#include "flow/iterate_ghosts.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// One component's linear system.
struct ViscousSystem {
  Grid grid;
  DomainSides sides;
  int component = 0;
  Real diffusion = 0;               // theta dt nu
  const SweepPlan* plan = nullptr;  // wraps along periodic axes
  RowRanges rows;                   // beginning on whole vectors
  Field<OpenFraction> open;         // rows of solid points are left out of norms
  WallRows fixed_rows, moving_rows;
  FaceVector<Real> carrier{};  // v, where advection is implicit
  Real advection_step = 0;     // dt; 0: no advection
  Index revision = -1;         // of open and the rows; -1: unknown

  bool is_advected() const { return advection_step > 0; }
  template <class T>
  UpwindAdvection<T> upwind() const {
    return {grid, carrier, component, advection_step};
  }
  Layout layout() const { return open.layout(); }
};

KOKKOS_INLINE_FUNCTION float in_fluid(OpenFraction open, float value) {
  return static_cast<float>(is_fluid(open)) * value;
}

/// Coefficients of the regular formula.
template <class T>
struct Diffusion {
  T x, y, z;  // theta dt nu / h^2
  T diagonal;

  explicit Diffusion(const ViscousSystem& system) : Diffusion(system.grid, system.diffusion) {}
  Diffusion(const Grid& grid, Real diffusion) {
    T along[3];
    for (int a = 0; a < 3; ++a) along[a] = static_cast<T>(diffusion / (grid.spacing[a] * grid.spacing[a]));
    x = along[0];
    y = along[1];
    z = along[2];
    diagonal = 1 + 2 * (x + y + z);
  }
  KOKKOS_INLINE_FUNCTION T along(int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
};

/// Row of a wall: sum of weighted fluid neighbours and diagonal.
template <class T>
struct WallRow {
  T neighbors = 0, diagonal = 1;

  KOKKOS_INLINE_FUNCTION WallRow(const WallRows& rows, Index row, const Field<float>& e,
                                 const Diffusion<T>& diffusion) {
    const Index p = rows.face(row);
    for (int d = 0; d < WallRows::directions; ++d) {
      const T coefficient = diffusion.along(d / 2) * static_cast<T>(rows.weight(row, d));
      const Index step = e.layout().stride(d / 2);
      diagonal += coefficient;
      neighbors += rows.openness(row, d) * coefficient * static_cast<T>(e[d % 2 ? p + step : p - step]);
    }
  }
};

/// A e on regular points of a row, from differences: stiff rows would lose the smooth part of e otherwise.
struct ProductRow {
  const float* e;
  Index sy, sz;
  float x, y, z;

  KOKKOS_INLINE_FUNCTION ProductRow(const Layout& layout, const float* row, const Diffusion<float>& d)
      : e(row), sy(layout.pitch_y), sz(layout.pitch_z), x(d.x), y(d.y), z(d.z) {}
  KOKKOS_INLINE_FUNCTION float operator()(int i) const {
    const float c = e[i];
    return c + x * ((c - e[i - 1]) + (c - e[i + 1])) + y * ((c - e[i - sy]) + (c - e[i + sy])) +
           z * ((c - e[i - sz]) + (c - e[i + sz]));
  }
};

/// The same at a wall row.
KOKKOS_INLINE_FUNCTION float wall_product(const WallRows& rows, Index row, const Field<float>& e,
                                          const Diffusion<float>& diffusion) {
  const Index p = rows.face(row);
  float sum = e[p];
  for (int d = 0; d < WallRows::directions; ++d) {
    const Index step = e.layout().stride(d / 2);
    const float neighbor = rows.openness(row, d) * e[d % 2 ? p + step : p - step];
    sum += diffusion.along(d / 2) * rows.weight(row, d) * (e[p] - neighbor);
  }
  return sum;
}

/// Part of a stage: the body at wall rows.
template <class Body>
AtEntries<Body> at_walls(const WallRows& rows, const Body& body) {
  return {rows.chains, rows.count, body};
}

/// Part of a stage: the ghosts of e.
inline OnRows<IterateGhosts> ghosts_of(const ViscousSystem& system, const Field<float>& e) {
  return {{e.layout(), GhostRules(e.layout(), system.sides, system.component), e.data()}};
}

}  // namespace peclet::flow
