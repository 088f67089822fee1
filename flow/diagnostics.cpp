#include "flow/diagnostics.hpp"

namespace peclet::flow {

Real largest_component(const RowRanges& rows, const FaceVector<Real>& velocity) {
  const FaceVector<Real> u = velocity;
  return max_cells(
      "flow::largest_velocity", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = u.x.layout()(i, j, k);
        const Real x = Kokkos::abs(u.x[p]), y = Kokkos::abs(u.y[p]), z = Kokkos::abs(u.z[p]);
        const Real larger = x > y ? x : y;
        return larger > z ? larger : z;
      });
}

Real largest_courant_rate(const RowRanges& rows, const FaceVector<OpenFraction>& open,
                          const FaceVector<Real>& velocity, const Real3& spacing, bool count_slits) {
  const FaceVector<OpenFraction> o = open;
  const FaceVector<Real> u = velocity;
  const Real3 h = spacing;
  return max_cells(
      "flow::largest_courant_rate", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = u.x.layout()(i, j, k);
        Real rate = 0;
        for (int a = 0; a < 3; ++a) {
          const Index next = p + u.x.layout().stride(a);
          const Real low = count_slits || !is_slit(o[a][p]) ? Kokkos::abs(u[a][p]) : 0.0;
          const Real high = count_slits || !is_slit(o[a][next]) ? Kokkos::abs(u[a][next]) : 0.0;
          rate += (low > high ? low : high) / h[a];
        }
        return rate;
      });
}

void mask_solid_points(const RowRanges& whole, const FaceVector<OpenFraction>& open,
                       const FaceVector<Real>& velocity) {
  const FaceVector<OpenFraction> o = open;
  const FaceVector<Real> u = velocity;
  for_each_cell(
      "flow::mask_solid_points", whole, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = u.x.layout()(i, j, k);
        for (int c = 0; c < 3; ++c) u[c][p] = is_fluid(o[c][p]) ? u[c][p] : 0.0;
      });
}

Real sum_of_change(const RowRanges& rows, const Field<OpenFraction>& open, const Field<Real>& velocity,
                   const Field<Real>& previous) {
  const Field<OpenFraction> o = open;
  const Field<Real> u = velocity, old = previous;
  return sum_cells(
      "flow::sum_of_change", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = u.layout()(i, j, k);
        return is_fluid(o[p]) ? u[p] - old[p] : 0.0;
      });
}

Real divergence_in_open_cells(const RowRanges& rows, const FaceVector<OpenFraction>& open,
                              const Field<Real>& divergence) {
  const FaceVector<OpenFraction> o = open;
  const Field<Real> div = divergence;
  return max_cells(
      "flow::divergence_in_open_cells", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = div.layout()(i, j, k);
        const Index y = p + div.layout().pitch_y, z = p + div.layout().pitch_z;
        const int any = o.x[p] + o.x[p + 1] + o.y[p] + o.y[y] + o.z[p] + o.z[z];
        return any ? Kokkos::abs(div[p]) : 0.0;
      });
}

Real count_fluid_points(const RowRanges& rows, const Field<OpenFraction>& open) {
  const Field<OpenFraction> o = open;
  return sum_cells(
      "flow::count_fluid_points", rows,
      KOKKOS_LAMBDA(int i, int j, int k) { return static_cast<Real>(is_fluid(o(i, j, k))); });
}

}  // namespace peclet::flow
