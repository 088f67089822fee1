#pragma once
// A symmetric relative of the viscous operator, which multigrid can coarsen: wall rows scaled, the exchange
// between neighbours the mean of what their rows say, U by its symmetric part.
#include "flow/poisson_operator.hpp"
#include "flow/viscous_operator.hpp"

namespace peclet::flow {

/// Factor of a wall row that bounds its exchange with every fluid neighbour by that of a regular row; it
/// makes the operator nearly symmetric.
KOKKOS_INLINE_FUNCTION Real row_factor(const WallRows& rows, Index row) {
  float largest = 1;
  for (int d = 0; d < WallRows::directions; ++d)
    largest = Kokkos::max(largest, rows.openness(row, d) * rows.weight(row, d));
  return 1 / static_cast<Real>(largest);
}

/// How much further from its wall the centre of a coarse cell lies than the wall point in it, in spacings:
/// by half of one or not at all, as it holds two points in that direction or one. A third for both converges
/// fastest (found by trial).
KOKKOS_INLINE_FUNCTION Real distance_to_coarse_centre(const Merging& merging, int axis) {
  return merging.ratio[axis] == 2 ? 1.0 / 3 : 0;
}

/// What a wall point has of the change of its coarse cell: it is closer to the wall, where nothing changes.
KOKKOS_INLINE_FUNCTION float share_of_coarse_change(const WallRows& rows, Index row, const Merging& merging) {
  Real sum = 0;
  for (int d = 0; d < WallRows::directions; ++d)
    sum += (1 - rows.openness(row, d)) * rows.weight(row, d) * distance_to_coarse_centre(merging, d / 2);
  return static_cast<float>(1 / (1 + row_factor(rows, row) * sum));
}

/// Diffusion that bounds the exchange between any two points.
Real largest_exchange(const ViscousSystem& system);

/// Coefficients of the relative times smallest spacing^2 / exchange: links between fluid points, where
/// fully_open stands for that exchange along the smallest spacing, and what rows have besides: exchange
/// with walls from the centres of the cells into which the points merge.
void fill_links(const ViscousSystem& system, Real exchange, const FaceVector<OpenFraction>& links,
                const Field<float>& reaction, const Merging& merging);

}  // namespace peclet::flow
