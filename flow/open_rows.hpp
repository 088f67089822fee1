#pragma once
// The cells that are not solid for good, row by row.
#include "core/loop.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// Per row of cells, the range outside which every face is closed; it begins on whole vectors.
RowRanges open_row_ranges(const FaceVector<OpenFraction>& open, const Int3& cells);

/// The smallest box around the cells with an open face; empty if there are none.
Box box_of_open_cells(const FaceVector<OpenFraction>& open, const RowRanges& rows);

}  // namespace peclet::flow
