#include "flow/momentum.hpp"

namespace peclet::flow {

void extrapolate_velocity(const RowRanges& rows, const FaceVector<Real>& velocity, const FaceVector<Real>& previous,
                          Real step_ratio, const FaceVector<Real>& extrapolated) {
  for (int c = 0; c < 3; ++c) {
    const Field<Real> u = velocity[c], old = previous[c], v = extrapolated[c];
    const Real half = 0.5 * step_ratio;
    for_each_cell(
        "flow::extrapolate_velocity", rows, KOKKOS_LAMBDA(int i, int j, int k) {
          const Index p = u.layout()(i, j, k);
          v[p] = u[p] + half * (u[p] - old[p]);
        });
  }
}

namespace {

/// div(v v_c) at face p, conservative form.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real advection_at_face(const FaceVector<Real>& v, int c, Index p, const Real3& inverse_spacing) {
  const Layout& layout = v.x.layout();
  const Index own = layout.stride(c);
  Real divergence = 0;
  for (int a = 0; a < 3; ++a) {
    const Index step = layout.stride(a);
    divergence += inverse_spacing[a] * (momentum_flux_low<Scheme>(v, c, a, p + step, own, step) -
                                        momentum_flux_low<Scheme>(v, c, a, p, own, step));
  }
  return divergence;
}

template <>
KOKKOS_INLINE_FUNCTION Real advection_at_face<NoAdvection>(const FaceVector<Real>&, int, Index, const Real3&) {
  return 0;
}

/// div(v v_c) - v_c div(v) at face p. Beside walls the carrying velocity is not solenoidal, because faces are
/// partly closed; without the second term a stream that moves with the body would not stay uniform.
template <class Scheme>
KOKKOS_INLINE_FUNCTION Real advection_beside_wall(const FaceVector<Real>& v, int c, Index p, const Real3& inverse_spacing) {
  return advection_at_face<Scheme>(v, c, p, inverse_spacing) - v[c][p] * carrier_divergence(v, c, p, inverse_spacing);
}

template <>
KOKKOS_INLINE_FUNCTION Real advection_beside_wall<NoAdvection>(const FaceVector<Real>&, int, Index, const Real3&) {
  return 0;
}

KOKKOS_INLINE_FUNCTION Real laplacian_at_face(const Field<Real>& q, Index p, const Real3& inverse_square) {
  const Layout& layout = q.layout();
  Real sum = 0;
  for (int a = 0; a < 3; ++a) {
    const Index step = layout.stride(a);
    sum += inverse_square[a] * (q[p + step] - 2 * q[p] + q[p - step]);
  }
  return sum;
}

KOKKOS_INLINE_FUNCTION Real laplacian_at_wall(const WallRows& rows, Index row, const Field<Real>& q, Index p,
                                              const Real3& inverse_square) {
  const Layout& layout = q.layout();
  Real sum = rows.wall_sum(row);
  for (int d = 0; d < WallRows::directions; ++d) {
    const Index step = layout.stride(d / 2);
    const Real neighbor = rows.is_wall(row, d) ? 0.0 : q[d % 2 ? p + step : p - step];
    sum += inverse_square[d / 2] * rows.weight(row, d) * (neighbor - q[p]);
  }
  return sum;
}

struct InverseSpacing {
  Real3 first, square;

  explicit InverseSpacing(const Grid& grid) {
    for (int a = 0; a < 3; ++a) {
      first[a] = 1 / grid.spacing[a];
      square[a] = first[a] * first[a];
    }
  }
};

KOKKOS_INLINE_FUNCTION Real predictor_residual(const MomentumTerms& t, int c, Index p, Real advection, Real laplacian,
                                               Real inverse_spacing) {
  const Real gradient = inverse_spacing * (t.pressure[p] - t.pressure[p - t.pressure.layout().stride(c)]);
  const Real change = t.velocity[c][p] - t.previous[c][p];
  return t.time_step *
             (-advection - gradient / t.density + t.acceleration[c] + t.kinematic_viscosity * laplacian) -
         t.step_ratio * change;
}

template <class Scheme>
void residual_of_grid(int c, const MomentumTerms& terms, const RowRanges& rows, const Field<Real>& residual) {
  const MomentumTerms t = terms;
  const InverseSpacing inverse(terms.grid);
  const Field<Real> r = residual;
  for_each_cell(
      "flow::momentum_residual", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = r.layout()(i, j, k);
        const Real advection = advection_at_face<Scheme>(t.extrapolated, c, p, inverse.first);
        const Real laplacian = laplacian_at_face(t.extrapolated[c], p, inverse.square);
        r[p] = predictor_residual(t, c, p, advection, laplacian, inverse.first[c]);
      });
}

template <class Scheme>
void residual_of_wall_rows(int c, const MomentumTerms& terms, const WallRows& rows, const Field<Real>& residual) {
  const MomentumTerms t = terms;
  const InverseSpacing inverse(terms.grid);
  const Field<Real> r = residual;
  const WallRows w = rows;
  for_each(
      "flow::momentum_residual_walls", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return;
        const Index p = w.face(row);
        const Real advection = advection_beside_wall<Scheme>(t.extrapolated, c, p, inverse.first);
        const Real laplacian = laplacian_at_wall(w, row, t.extrapolated[c], p, inverse.square);
        r[p] = predictor_residual(t, c, p, advection, laplacian, inverse.first[c]);
      });
}

template <class Scheme>
void residual_with_scheme(int c, const MomentumTerms& terms, const RowRanges& rows, const WallRows& fixed_rows,
                          const WallRows& moving_rows, const Field<Real>& residual) {
  residual_of_grid<Scheme>(c, terms, rows, residual);
  residual_of_wall_rows<Scheme>(c, terms, fixed_rows, residual);
  residual_of_wall_rows<Scheme>(c, terms, moving_rows, residual);
}

}  // namespace

void compute_momentum_residual(int c, const MomentumTerms& terms, const RowRanges& rows, const WallRows& fixed_rows,
                               const WallRows& moving_rows, const Field<Real>& residual) {
  switch (terms.scheme) {
    case AdvectionScheme::None:
      return residual_with_scheme<NoAdvection>(c, terms, rows, fixed_rows, moving_rows, residual);
    case AdvectionScheme::SecondUpwind:
      return residual_with_scheme<SecondUpwindScheme>(c, terms, rows, fixed_rows, moving_rows, residual);
    case AdvectionScheme::Koren:
      return residual_with_scheme<KorenScheme>(c, terms, rows, fixed_rows, moving_rows, residual);
    case AdvectionScheme::Central:
      return residual_with_scheme<CentralScheme>(c, terms, rows, fixed_rows, moving_rows, residual);
  }
}

}  // namespace peclet::flow
