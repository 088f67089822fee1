#pragma once
// The cells that walls concern. What lies beside walls is listed from them, so that the boxes around moving
// bodies are searched once, and the grid around fixed ones.
#include <cstdint>

#include "core/field.hpp"
#include "flow/domain_sides.hpp"
#include "flow/region_list.hpp"

namespace peclet::flow {

/// What is known of a cell, as bits of its mark.
namespace cell_mark {
inline constexpr std::uint8_t in_region = 1;  // of a moving body
inline constexpr std::uint8_t touched = 2;    // the cell is solid, or one of its low faces not fully open
inline constexpr std::uint8_t touched_by_fixed = 4;  // the same with the fixed solid alone
}  // namespace cell_mark

/// Every cell with a face or a stencil that a wall touches is among them.
struct NearCells {
  Index count = 0;
  Array<Int3> cell;
};

/// Lists the near cells of the regions. marks: ghosts need not be filled. scratch has room for all cells of
/// the regions.
void find_near_cells(const Field<std::uint8_t>& marks, const DomainSides& sides, const RegionList& regions,
                     const Array<Index>& scratch, NearCells& near);

}  // namespace peclet::flow
