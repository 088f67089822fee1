#include "flow/projection.hpp"

namespace peclet::flow {

void compute_divergence(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                        const CutCells& cut_cells, const FaceVector<Real>& velocity, const Field<Real>& divergence) {
  const FaceVector<OpenFraction> o = open;
  const FaceVector<Real> u = velocity;
  const Field<Real> result = divergence;
  const Real3 scale{open_fraction_unit / grid.spacing[0], open_fraction_unit / grid.spacing[1],
                    open_fraction_unit / grid.spacing[2]};
  for_each_cell(
      "flow::compute_divergence", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = result.layout()(i, j, k);
        const Index y = p + result.layout().pitch_y, z = p + result.layout().pitch_z;
        result[p] = scale[0] * (o.x[p + 1] * u.x[p + 1] - o.x[p] * u.x[p]) +
                    scale[1] * (o.y[y] * u.y[y] - o.y[p] * u.y[p]) + scale[2] * (o.z[z] * u.z[z] - o.z[p] * u.z[p]);
      });
  const CutCells cut = cut_cells;
  for_each(
      "flow::add_wall_flux", cut.count, KOKKOS_LAMBDA(Index n) { result[cut.cell(n)] += cut.wall_flux(n); });
}

void subtract_gradient(const Grid& grid, const RowRanges& rows, const FaceVector<OpenFraction>& open,
                       const Field<Real>& phi, const FaceVector<Real>& velocity) {
  const FaceVector<OpenFraction> o = open;
  const FaceVector<Real> u = velocity;
  const Field<Real> potential = phi;
  const Real3 inverse{1 / grid.spacing[0], 1 / grid.spacing[1], 1 / grid.spacing[2]};
  for_each_cell(
      "flow::subtract_gradient", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index p = potential.layout()(i, j, k);
        const Index y = p - potential.layout().pitch_y, z = p - potential.layout().pitch_z;
        const Real here = potential[p];
        const Real ux = u.x[p] - inverse[0] * (here - potential[p - 1]);
        const Real uy = u.y[p] - inverse[1] * (here - potential[y]);
        const Real uz = u.z[p] - inverse[2] * (here - potential[z]);
        u.x[p] = o.x[p] ? ux : 0.0;
        u.y[p] = o.y[p] ? uy : 0.0;
        u.z[p] = o.z[p] ? uz : 0.0;
      });
}

void update_pressure(const RowRanges& rows, Real density_over_time_step, Real implicit_viscosity,
                     const Field<Real>& phi, const Field<Real>& divergence, const Field<Real>& pressure) {
  const Field<Real> p = pressure, potential = phi, div = divergence;
  for_each_cell(
      "flow::update_pressure", rows, KOKKOS_LAMBDA(int i, int j, int k) {
        const Index n = p.layout()(i, j, k);
        p[n] += density_over_time_step * potential[n] - implicit_viscosity * div[n];
      });
}

}  // namespace peclet::flow
