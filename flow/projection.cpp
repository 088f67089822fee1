#include "flow/projection.hpp"

#include <algorithm>

namespace peclet::flow {
namespace {

struct Divergence {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction *open_x, *open_y, *open_z;
  const Real *u, *v, *w;
  Real* result;
  Real3 scale;

  struct Row {
    const OpenFraction *ox, *oy, *oz;
    const Real *u, *v, *w;
    Real* result;
    Index sy, sz;
    Real fx, fy, fz;

    KOKKOS_INLINE_FUNCTION static Real flux(const OpenFraction* open, const Real* velocity, Index n) {
      return static_cast<Real>(open[n]) * velocity[n];
    }
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const {
      const Real divergence = fx * (flux(ox, u, i + 1) - flux(ox, u, i)) +
                              fy * (flux(oy, v, i + sy) - flux(oy, v, i)) +
                              fz * (flux(oz, w, i + sz) - flux(oz, w, i));
      result[i] = divergence;
      return divergence;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open_x + n, open_y + n,     open_z + n,     u + n,    v + n,    w + n,
            result + n, layout.pitch_y, layout.pitch_z, scale[0], scale[1], scale[2]};
  }
};

/// Divides the divergence by the open part s of each cell: the mean open fraction o of its faces, those
/// across axis a weighted by 1 / h_a^2 as in div o grad. Sides of the box are closed faces.
struct DivideByOpenPart {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  static constexpr float smallest_part = 0.25F;  // cells that are open less would be too close to instability
  Layout layout;
  const OpenFraction *open_x, *open_y, *open_z;
  Real* divergence;
  float weight[3];

  DivideByOpenPart(const Grid& grid, const FaceVector<OpenFraction>& open, const DomainSides& sides,
                   const Field<Real>& divergence_)
      : layout(divergence_.layout()),
        open_x(open.x.data()),
        open_y(open.y.data()),
        open_z(open.z.data()),
        divergence(divergence_.data()) {
    const PressureSides closing = sides.pressure_sides();
    Real inverse_square[3], sum = 0;
    for (int a = 0; a < 3; ++a) {
      // nothing flows along an axis of one cell between two closed sides
      const bool is_flat = grid.cells[a] == 1 && closing.side[a][0] == PressureSide::Closed &&
                           closing.side[a][1] == PressureSide::Closed;
      inverse_square[a] = is_flat ? 0 : 1 / (grid.spacing[a] * grid.spacing[a]);
      sum += 2 * inverse_square[a];
    }
    for (int a = 0; a < 3; ++a)
      weight[a] = sum > 0 ? static_cast<float>(open_fraction_unit * inverse_square[a] / sum) : 0;
  }

  struct Row {
    const OpenFraction *x, *y, *z;
    Real* divergence;
    Index sy, sz;
    float wx, wy, wz;

    KOKKOS_INLINE_FUNCTION static float both(const OpenFraction* open, int i, Index step) {
      return static_cast<float>(open[i] + open[i + step]);
    }
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const float part = wx * both(x, i, 1) + wy * both(y, i, sy) + wz * both(z, i, sz);
      divergence[i] /= part > smallest_part ? part : smallest_part;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open_x + n,     open_y + n, open_z + n, divergence + n, layout.pitch_y,
            layout.pitch_z, weight[0],  weight[1],  weight[2]};
  }
};

struct Projection {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  Layout layout;
  const OpenFraction *open_x, *open_y, *open_z;
  const Real *potential, *divergence;
  Real *u, *v, *w, *pressure;
  Real3 inverse_spacing;
  Real density_over_time_step, implicit_viscosity;

  struct Row {
    const OpenFraction *ox, *oy, *oz;
    const Real *phi, *divergence;
    Real *u, *v, *w, *pressure;
    Index sy, sz;
    Real fx, fy, fz, density_over_time_step, implicit_viscosity;

    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const Real here = phi[i];
      const Real x = u[i] - fx * (here - phi[i - 1]);
      const Real y = v[i] - fy * (here - phi[i - sy]);
      const Real z = w[i] - fz * (here - phi[i - sz]);
      u[i] = ox[i] ? x : 0.0;
      v[i] = oy[i] ? y : 0.0;
      w[i] = oz[i] ? z : 0.0;
      pressure[i] += density_over_time_step * here - implicit_viscosity * divergence[i];
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open_x + n,
            open_y + n,
            open_z + n,
            potential + n,
            divergence + n,
            u + n,
            v + n,
            w + n,
            pressure + n,
            layout.pitch_y,
            layout.pitch_z,
            inverse_spacing[0],
            inverse_spacing[1],
            inverse_spacing[2],
            density_over_time_step,
            implicit_viscosity};
  }
};

/// velocity -= grad phi on the faces of the high side along axis.
void project_high_side(int axis, const Grid& grid, const Field<OpenFraction>& open,
                       const Field<Real>& potential, const Field<Real>& velocity) {
  Box faces{{0, 0, 0}, grid.cells};
  faces.low[axis] = grid.cells[axis];
  faces.high[axis] = grid.cells[axis] + 1;
  const Field<OpenFraction> fraction = open;
  const Field<Real> phi = potential, u = velocity;
  const Real inverse = 1 / grid.spacing[axis];
  const Index step = potential.layout().stride(axis);
  for_each_cell(
      "flow::project_high_side", faces, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index n = u.layout()(i, j, k);
        u[n] = fraction[n] ? u[n] - inverse * (phi[n] - phi[n - step]) : 0.0;
      });
}

}  // namespace

Real compute_divergence(const Grid& grid, const SweepPlan& plan, const RowRanges& rows,
                        const FaceVector<OpenFraction>& open, const CutCells& cut_cells,
                        const DomainSides& sides, const Field<Real>& sdf, const FaceVector<Real>& velocity,
                        const Field<Real>& divergence) {
  Divergence body{divergence.layout(), open.x.data(),     open.y.data(),     open.z.data(), velocity.x.data(),
                  velocity.y.data(),   velocity.z.data(), divergence.data(), Real3{0, 0, 0}};
  for (int a = 0; a < 3; ++a) body.scale[a] = open_fraction_unit / grid.spacing[a];
  const Norms norms = sweep("flow::compute_divergence", plan, Stage{rows, body});
  const CutCells cut = cut_cells;
  const Field<Real> result = divergence;
  const Real at_walls = max_each(
      "flow::add_wall_flux", cut.count, KOKKOS_LAMBDA(Index n) {
        const Real sum = result[cut.cell(n)] + cut.wall_flux(n);
        result[cut.cell(n)] = sum;
        return Kokkos::abs(sum);
      });
  return std::max({norms.largest, at_walls, add_side_flux(grid, sides, sdf, divergence)});
}

Real compute_force_divergence(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                              const Real3& force, const Field<Real>& divergence) {
  const FaceVector<OpenFraction> o = open;
  const Field<Real> result = divergence;
  Real3 scale;
  for (int a = 0; a < 3; ++a) scale[a] = open_fraction_unit * force[a] / grid.spacing[a];
  return max_cells(
      "flow::compute_force_divergence", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = result.layout()(i, j, k);
        Real sum = 0;
        for (int a = 0; a < 3; ++a)
          sum += scale[a] *
                 (static_cast<Real>(o[a][p + result.layout().stride(a)]) - static_cast<Real>(o[a][p]));
        result[p] = sum;
        return Kokkos::abs(sum);
      });
}

Real largest_driving_force(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                           const Real3& force, const Field<Real>& potential) {
  const FaceVector<OpenFraction> o = open;
  const Field<Real> psi = potential;
  const Real3 f = force, h = grid.spacing;
  return max_cells(
      "flow::largest_driving_force", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = psi.layout()(i, j, k);
        Real largest = 0;
        for (int a = 0; a < 3; ++a) {
          const Real left = f[a] - (psi[p] - psi[p - psi.layout().stride(a)]) / h[a];
          largest = o[a][p] ? Kokkos::max(largest, Kokkos::abs(left)) : largest;
        }
        return largest;
      });
}

void add_potential(const RowRanges& rows, const Field<Real>& potential, const Field<Real>& pressure) {
  const Field<Real> phi = potential, p = pressure;
  for_each_cell(
      "flow::add_potential", rows, KOKKOS_LAMBDA(int i, int j, int k) { p(i, j, k) += phi(i, j, k); });
}

void apply_projection(const Grid& grid, const SweepPlan& plan, const RowRanges& rows,
                      const FaceVector<OpenFraction>& open, const DomainSides& sides,
                      const ProjectionUpdate& update, const FaceVector<Real>& velocity,
                      const Field<Real>& pressure) {
  const Projection body{pressure.layout(),
                        open.x.data(),
                        open.y.data(),
                        open.z.data(),
                        update.potential.data(),
                        update.divergence.data(),
                        velocity.x.data(),
                        velocity.y.data(),
                        velocity.z.data(),
                        pressure.data(),
                        Real3{1 / grid.spacing[0], 1 / grid.spacing[1], 1 / grid.spacing[2]},
                        update.density_over_time_step,
                        update.implicit_viscosity};
  if (update.weighs_open_part)
    sweep("flow::apply_projection", plan,
          Stage{rows, DivideByOpenPart(grid, open, sides, update.divergence), body});
  else
    sweep("flow::apply_projection", plan, Stage{rows, body});
  for (int axis = 0; axis < 3; ++axis)
    if (sides.side[axis][1].kind == SideKind::Outflow)
      project_high_side(axis, grid, open[axis], update.potential, velocity[axis]);
}

}  // namespace peclet::flow
