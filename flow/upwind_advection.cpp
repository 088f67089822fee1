#include "flow/upwind_advection.hpp"

#include "core/loop.hpp"

namespace peclet::flow {

Real upwind_leak(const UpwindAdvection<Real>& upwind, const WallRows& rows, const Field<Real>& e) {
  const UpwindAdvection<Real> advection = upwind;
  const WallRows w = rows;
  const Field<Real> correction = e;
  return sum_each(
      "flow::upwind_leak", rows.count, KOKKOS_LAMBDA(Index row) {
        if (w.superseded(row)) return 0.0;
        const Index p = w.face(row);
        Real excess = 0;
        for (int d = 0; d < WallRows::directions; ++d) {
          excess += advection.inflow(p, d);
          if (!w.is_wall(row, d)) excess -= advection.outflow(p, d);
        }
        return excess * correction[p];
      });
}

}  // namespace peclet::flow
