#pragma once
// Jacobi sweeps on the viscous operator in single precision.
#include <limits>

#include "flow/chebyshev.hpp"
#include "flow/viscous_operator.hpp"

namespace peclet::flow {

/// Rows are diagonally dominant, so that the operator scaled by its regular diagonal has its spectrum within
/// [1 - s, 1 + s], s = b / (1 + b), b = theta dt nu sum_a 2 / h_a^2; rows beside a Wall or Inflow side of the
/// box, whose ghosts follow a parabola, reach further, to (1 + 8/3 b) / (1 + b).
inline Spectrum bound_spectrum(const ViscousSystem& system) {
  Real regular = 0, walled = 0;  // sums of the off-diagonal part
  for (int a = 0; a < 3; ++a) {
    const Real along = 2 * system.diffusion / (system.grid.spacing[a] * system.grid.spacing[a]);
    const bool at_wall = a != system.component && (system.sides.side[a][0].prescribes_velocity() ||
                                                   system.sides.side[a][1].prescribes_velocity());
    regular += along;
    walled += at_wall ? 8.0 / 3 * along : 2 * along;
  }
  const Real low = 1 / (1 + regular), high = (1 + walled) / (1 + regular);
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// Right-hand side of solid points, where e stays zero.
inline constexpr float solid_mark = -std::numeric_limits<float>::max();

/// rhs = residual or solid_mark, and the first sweep from e = 0: e = scale * rhs.
template <class T>
struct FirstRegularSweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const T* residual;
  float *rhs, *e;
  float scale;

  struct Row {
    const OpenFraction* open;
    const T* residual;
    float *rhs, *e;
    float scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float value = static_cast<float>(residual[i]);
      rhs[i] = is_fluid(open[i]) ? value : solid_mark;
      e[i] = in_fluid(open[i], scale * value);
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n, rhs + n, e + n, scale};
  }
};

/// next = (1 - weight) e + scale (rhs + neighbours), zero at solid points, which ghosts are taken from.
struct RegularSweep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float* rhs;
  const float* e;
  float* next;
  Diffusion<float> d;
  float keep, scale;

  struct Row {
    const float* rhs;
    const float* e;
    float* next;
    Index sy, sz;
    float x, y, z, keep, scale;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float neighbors =
          x * (e[i - 1] + e[i + 1]) + y * (e[i - sy] + e[i + sy]) + z * (e[i - sz] + e[i + sz]);
      const float value = keep * e[i] + scale * (rhs[i] + neighbors);
      next[i] = rhs[i] > solid_mark ? value : 0.0F;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {rhs + n, e + n, next + n, layout.pitch_y, layout.pitch_z, d.x, d.y, d.z, keep, scale};
  }
};

/// First sweep from e = 0 at walls.
struct FirstWallSweep {
  WallRows rows;
  Field<float> rhs, e;
  Diffusion<float> diffusion;
  float weight;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    float diagonal = 1;
    for (int d = 0; d < WallRows::directions; ++d) diagonal += diffusion.along(d / 2) * rows.weight(row, d);
    const Index p = rows.face(row);
    e[p] = weight * rhs[p] / diagonal;
  }
};

struct WallSweep {
  WallRows rows;
  Field<float> rhs, e, next;
  Diffusion<float> diffusion;
  float weight;

  KOKKOS_INLINE_FUNCTION void operator()(Index row) const {
    if (rows.superseded(row)) return;
    const Index p = rows.face(row);
    const WallRow<float> wall(rows, row, e, diffusion);
    next[p] = e[p] + weight * ((rhs[p] + wall.neighbors) / wall.diagonal - e[p]);
  }
};

/// Stage: rhs = residual, and e = the first sweep from zero, with that weight.
template <class T>
auto first_sweep(const ViscousSystem& system, const Field<T>& residual, const Field<float>& rhs,
                 const Field<float>& e, float weight) {
  const Diffusion<float> diffusion(system);
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  return Stage(system.rows,
               FirstRegularSweep<T>{system.layout(), system.open.data(), residual.data(), rhs.data(),
                                    e.data(), weight / diffusion.diagonal},
               at_walls(fixed, FirstWallSweep{fixed, rhs, e, diffusion, weight}),
               at_walls(moving, FirstWallSweep{moving, rhs, e, diffusion, weight}), ghosts_of(system, e));
}

/// Stage: next = the sweep that follows e.
inline auto next_sweep(const ViscousSystem& system, const Field<float>& rhs, const Field<float>& e,
                       const Field<float>& next, float weight) {
  const Diffusion<float> diffusion(system);
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  return Stage(system.rows,
               RegularSweep{system.layout(), rhs.data(), e.data(), next.data(), diffusion, 1.0F - weight,
                            weight / diffusion.diagonal},
               at_walls(fixed, WallSweep{fixed, rhs, e, next, diffusion, weight}),
               at_walls(moving, WallSweep{moving, rhs, e, next, diffusion, weight}), ghosts_of(system, next));
}

}  // namespace peclet::flow
