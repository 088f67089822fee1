#pragma once
// Transfer between the finest level and the coarse levels of one group of fluid regions.
//
// Regions that thin walls part would meet again in coarse cells, which can follow only one of them. Each
// group of regions has coarse levels of its own instead.
#include "flow/poisson_operator.hpp"

namespace peclet::flow {

/// The finest operator on the cells of one group; the faces of other cells count as closed.
struct GroupOperator : LevelOperator<OpenFraction> {
  const unsigned char* group = nullptr;  ///< of each cell with an open face
  unsigned char own = 0;

  KOKKOS_INLINE_FUNCTION Real coefficient(int axis, Index face, Index cell) const {
    return group[cell] == own ? LevelOperator<OpenFraction>::coefficient(axis, face, cell) : 0;
  }
};

/// coarse = sum of fine over the children that belong to the group.
void restrict_group(const Field<unsigned char>& group, int own, const Merging& merging,
                    const Field<float>& fine, const RowRanges& coarse_rows, const Field<float>& coarse);

/// Adds the coarse value to the children that belong to the group; cells outside rows have none.
void prolong_group(const Field<unsigned char>& group, int own, const Merging& merging,
                   const Field<float>& coarse, const RowRanges& rows, const Field<float>& fine);

}  // namespace peclet::flow
