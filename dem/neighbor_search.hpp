#pragma once
// Neighbours within a distance, in linear time for any mix of radii: a cell list in a hash table, so that
// memory follows the number of particles and not the size of the domain.
#include "core/loop.hpp"
#include "core/types.hpp"
#include "dem/domain.hpp"

namespace peclet::dem {

/// Copied by value into kernels.
struct CellList {
  struct Entry {
    Vec3 position;
    Real reach = 0;
    int particle = 0;
    Int3 cell{0, 0, 0};
  };

  Domain domain;
  Vec3 cell_size;
  Int3 number_of_cells{0, 0, 0};  // along periodic axes
  Index bucket_mask = 0;
  Array<Index> bucket_begin;
  Array<Entry> entries;  // bucket after bucket

  /// May lie outside the domain; far away cells are one.
  KOKKOS_INLINE_FUNCTION int cell_along(int axis, Real x) const {
    constexpr Real limit = 1 << 30;
    const Real cell = Kokkos::floor((x - domain.origin[axis]) / cell_size[axis]);
    return static_cast<int>(Kokkos::max(-limit, Kokkos::min(limit, cell)));
  }
  /// The cell inside the domain that an image of it stands for.
  KOKKOS_INLINE_FUNCTION int home_cell(int axis, int cell) const {
    if (!domain.wraps(axis)) return cell;
    const int n = number_of_cells[axis];
    return ((cell % n) + n) % n;
  }
  KOKKOS_INLINE_FUNCTION Index bucket(const Int3& cell) const {
    const auto hash = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[0])) +
                      static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[1])) * 73856093u +
                      static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[2])) * 83492791u;
    return static_cast<Index>(hash) & bucket_mask;
  }
  KOKKOS_INLINE_FUNCTION Int3 home_cell_of(Vec3 x) const {
    Int3 cell{0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) cell[axis] = home_cell(axis, cell_along(axis, x[axis]));
    return cell;
  }

  /// visit(entry, shift, image) for every particle, and every periodic image of it (at entry.position +
  /// shift), in the cells that lie within range of x.
  template <class Visitor>
  KOKKOS_FUNCTION void visit_near(Vec3 x, Real range, Visitor& visit) const {
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = cell_along(axis, x[axis] - range);
      high[axis] = cell_along(axis, x[axis] + range);
    }
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i) visit_cell(Int3{i, j, k}, visit);
  }

 private:
  /// How many domain lengths a cell is away from its home.
  KOKKOS_INLINE_FUNCTION int image_along(int axis, int cell, int home) const {
    return domain.wraps(axis) ? (cell - home) / number_of_cells[axis] : 0;
  }

  template <class Visitor>
  KOKKOS_INLINE_FUNCTION void visit_cell(const Int3& cell, Visitor& visit) const {
    Int3 home{0, 0, 0};
    Vec3 shift;
    int image = 0;
    for (int axis = 0; axis < 3; ++axis) {
      home[axis] = home_cell(axis, cell[axis]);
      const int turns = image_along(axis, cell[axis], home[axis]);
      shift[axis] = turns * domain.extent[axis];
      image = 256 * image + turns + 128;
    }
    const Index b = bucket(home);
    for (Index n = bucket_begin(b); n < bucket_begin(b + 1); ++n) {
      const Entry& entry = entries(n);
      if (entry.cell[0] == home[0] && entry.cell[1] == home[1] && entry.cell[2] == home[2])
        visit(entry, shift, image);
    }
  }
};

class NeighborSearch {
 public:
  /// Positions must lie inside the domain along its periodic axes.
  const CellList& sort(Index count, const Array<Vec3>& positions, const Array<Real>& reaches,
                       const Domain& domain);

 private:
  CellList cells_;
  Array<Index> bucket_size_;
};

}  // namespace peclet::dem
