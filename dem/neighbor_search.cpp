#include "dem/neighbor_search.hpp"

#include <algorithm>
#include <cmath>

namespace peclet::dem {
namespace {

void count_per_bucket(const CellList& cells, Index count, const Array<Vec3>& positions,
                      const Array<Index>& sizes) {
  Kokkos::deep_copy(sizes, Index{0});
  for_each(
      "dem::count_per_bucket", count,
      KOKKOS_LAMBDA(Index n) { Kokkos::atomic_inc(&sizes(cells.bucket(cells.home_cell_of(positions(n))))); });
}

/// The order within a bucket is arbitrary.
void fill_buckets(const CellList& cells, Index count, const Array<Vec3>& positions,
                  const Array<Real>& reaches, const Array<Index>& sizes) {
  for_each(
      "dem::fill_buckets", count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = cells.home_cell_of(positions(n));
        const Index b = cells.bucket(cell);
        const Index place = cells.bucket_begin(b) + Kokkos::atomic_fetch_sub(&sizes(b), Index{1}) - 1;
        cells.entries(place) = {positions(n), reaches(n), static_cast<int>(n), cell};
      });
}

void sum_bucket_sizes(const Array<Index>& sizes, const Array<Index>& begin) {
  exclusive_sum(
      "dem::sum_bucket_sizes", static_cast<Index>(sizes.extent(0)), begin,
      KOKKOS_LAMBDA(Index n) { return sizes(n); });
}

/// Twice the mean reach; more where a few large particles would otherwise have to visit too many cells.
Real choose_cell_size(Index count, const Array<Real>& reaches) {
  if (count == 0) return 1;
  const Real mean = sum_each(
                        "dem::mean_reach", count, KOKKOS_LAMBDA(Index n) { return reaches(n); }) /
                    static_cast<Real>(count);
  const Real largest = max_each("dem::largest_reach", count, KOKKOS_LAMBDA(Index n) { return reaches(n); });
  const Real mean_cube = sum_each(
                             "dem::mean_cube", count,
                             KOKKOS_LAMBDA(Index n) {
                               const Real ratio = reaches(n) / largest;
                               return ratio * ratio * ratio;
                             }) /
                         static_cast<Real>(count);
  return std::max(2 * mean, largest * std::cbrt(mean_cube));
}

}  // namespace

const CellList& NeighborSearch::sort(Index count, const Array<Vec3>& positions, const Array<Real>& reaches,
                                     const Domain& domain) {
  Index buckets = 64;
  while (buckets < 2 * count) buckets *= 2;
  if (static_cast<Index>(bucket_size_.extent(0)) < buckets) {
    bucket_size_ = Array<Index>("dem.bucket_size", static_cast<std::size_t>(buckets));
    cells_.bucket_begin = Array<Index>("dem.bucket_begin", static_cast<std::size_t>(buckets) + 1);
  }
  if (static_cast<Index>(cells_.entries.extent(0)) < count)
    cells_.entries = Array<CellList::Entry>("dem.cell_entries", static_cast<std::size_t>(count));
  cells_.bucket_mask = static_cast<Index>(bucket_size_.extent(0)) - 1;

  cells_.domain = domain;
  const Real size = choose_cell_size(count, reaches);
  for (int axis = 0; axis < 3; ++axis) {
    cells_.cell_size[axis] = size;
    if (!domain.wraps(axis)) continue;
    const Real n = std::clamp(std::floor(domain.extent[axis] / size), 1.0, 1048576.0);
    cells_.number_of_cells[axis] = static_cast<int>(n);
    cells_.cell_size[axis] = domain.extent[axis] / n;
  }
  count_per_bucket(cells_, count, positions, bucket_size_);
  sum_bucket_sizes(bucket_size_, cells_.bucket_begin);
  fill_buckets(cells_, count, positions, reaches, bucket_size_);
  return cells_;
}

}  // namespace peclet::dem
