#pragma once
// A symmetric relative of the viscous operator, which multigrid can coarsen: wall rows scaled, the exchange
// between neighbours the mean of what their rows say, U by its symmetric part.
#include "flow/poisson_operator.hpp"
#include "flow/viscous_operator.hpp"

namespace peclet::flow {

/// Factor of a wall row that bounds its exchange with every fluid neighbour by that of a regular row; it
/// makes the operator nearly symmetric.
KOKKOS_INLINE_FUNCTION Real row_factor(const WallRows& rows, Index row) {
  Real largest = 1;
  for (int d = 0; d < WallRows::directions; ++d)
    if (!rows.is_wall(row, d)) largest = Kokkos::fmax(largest, static_cast<Real>(rows.weight(row, d)));
  return 1 / largest;
}

/// Diffusion that bounds the exchange between any two points.
Real largest_exchange(const ViscousSystem& system);

/// Coefficients of the relative times smallest spacing^2 / exchange: links between fluid points, where
/// fully_open stands for that exchange along the smallest spacing, and what rows have besides.
void fill_links(const ViscousSystem& system, Real exchange, const FaceVector<OpenFraction>& links,
                const Field<float>& reaction);

}  // namespace peclet::flow
