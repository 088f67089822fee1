#pragma once
// Transfer between a level of the multigrid and the next coarser one: restriction sums, prolongation copies.
#include "core/sweep.hpp"
#include "flow/poisson_operator.hpp"

namespace peclet::flow {

/// Coarse cell = sum of its children.
template <int RatioX>
struct SumOfChildren {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  LevelShape fine_shape, coarse_shape;
  Merging merging;
  float* fine;
  float* coarse;

  struct Row {
    const float *first, *next_y, *next_z, *next_yz;
    float has_y, has_z;
    float* coarse;
    int shift, n;  ///< children beyond the ends of the row do not count
    KOKKOS_INLINE_FUNCTION float column(int i) const {
      return first[i] + has_y * next_y[i] + has_z * (next_z[i] + has_y * next_yz[i]);
    }
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      if constexpr (RatioX == 1) {
        coarse[i] = column(i);
      } else {
        const int low = 2 * i - shift, high = low + 1;
        if constexpr (runs_on_host)
          coarse[i] = column(low) + column(high);
        else
          coarse[i] = (low >= 0 ? column(low) : 0) + (high < n ? column(high) : 0);
      }
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int J, int K) const {
    const int j = merging.first_child(1, J), k = merging.first_child(2, K);
    const int n = fine_shape.cells[0], shift = merging.shift[0];
    const bool has_y = j + 1 < merging.end_of_children(1, J) && j + 1 < fine_shape.cells[1];
    const bool has_z = k + 1 < merging.end_of_children(2, K) && k + 1 < fine_shape.cells[2];
    float* const first = fine + fine_shape.layout(0, j, k);
    float* const next_y = first + has_y * fine_shape.layout.pitch_y;
    float* const next_z = first + has_z * fine_shape.layout.pitch_z;
    float* const next_yz = next_y + (next_z - first);
    if (runs_on_host) {
      const int beyond = shift == 1 ? -1 : n;
      first[beyond] = next_y[beyond] = next_z[beyond] = next_yz[beyond] = 0;
    }
    return {first,
            next_y,
            next_z,
            next_yz,
            has_y ? 1.f : 0.f,
            has_z ? 1.f : 0.f,
            coarse + coarse_shape.layout(0, J, K),
            shift,
            n};
  }
};

/// Every child, or every one at a fluid point, += coarse cell; runs over coarse cells along fine rows.
template <int RatioX, bool only_fluid = false>
struct AddToChildren {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  LevelShape fine_shape, coarse_shape;
  Merging merging;
  const float* coarse;
  float* fine;
  const OpenFraction* open = nullptr;  // of the fine points, if only_fluid

  struct Row {
    const float* coarse;
    float* fine;
    const OpenFraction* open;
    KOKKOS_INLINE_FUNCTION void add(int child, float value) const {
      if constexpr (only_fluid)
        fine[child] += static_cast<float>(is_fluid(open[child])) * value;
      else
        fine[child] += value;
    }
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      if constexpr (RatioX == 1) {
        add(i, coarse[i]);
      } else {
        add(2 * i, coarse[i]);  // beyond the ends of an odd row: a ghost, overwritten before it is read
        add(2 * i + 1, coarse[i]);
      }
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = fine_shape.layout(-merging.shift[0], j, k);
    return {coarse + coarse_shape.layout(0, merging.parent(1, j), merging.parent(2, k)), fine + n,
            only_fluid ? open + n : nullptr};
  }
};

}  // namespace peclet::flow
