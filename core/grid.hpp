#pragma once
// Uniform Cartesian grid and the memory layout that all fields on it share.
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet {

/// Cells of size spacing; the low corner of cell (0, 0, 0) is at origin.
struct Grid {
  Int3 cells{1, 1, 1};
  Real3 spacing{1, 1, 1};
  Real3 origin{0, 0, 0};

  KOKKOS_INLINE_FUNCTION Vec3 cell_center(int i, int j, int k) const {
    return {origin[0] + (i + 0.5) * spacing[0], origin[1] + (j + 0.5) * spacing[1],
            origin[2] + (k + 0.5) * spacing[2]};
  }
  /// Centre of the low face of cell (i, j, k) along axis: where that velocity component lives.
  KOKKOS_INLINE_FUNCTION Vec3 face_center(int axis, int i, int j, int k) const {
    Vec3 x = cell_center(i, j, k);
    x[axis] -= 0.5 * spacing[axis];
    return x;
  }
  /// Low corner of cell (i, j, k).
  KOKKOS_INLINE_FUNCTION Vec3 corner(int i, int j, int k) const {
    return {origin[0] + i * spacing[0], origin[1] + j * spacing[1], origin[2] + k * spacing[2]};
  }
  KOKKOS_INLINE_FUNCTION Real extent(int axis) const { return cells[axis] * spacing[axis]; }
  KOKKOS_INLINE_FUNCTION Real cell_volume() const { return spacing[0] * spacing[1] * spacing[2]; }
  KOKKOS_INLINE_FUNCTION Real smallest_spacing() const {
    return Kokkos::fmin(spacing[0], Kokkos::fmin(spacing[1], spacing[2]));
  }
  Index number_of_cells() const { return static_cast<Index>(cells[0]) * cells[1] * cells[2]; }
};

/// Linear index of (i, j, k) with x fastest and ghost_width layers around the cells. A row starts on a
/// 64-byte boundary and is padded, and the high ghosts of a row precede the low ghosts of the next one. One
/// plane more than the ghosts is there, so that stencils centred on index n along z stay inside.
/// All fields of one layout share their linear indices, whatever their element type.
struct Layout {
  static constexpr int ghost_width = 2;
  static constexpr int alignment = 16;  // elements: 64 bytes of float

  Int3 cells{0, 0, 0};
  Index pitch_y = 0, pitch_z = 0, offset = 0, size = 0;

  Layout() = default;
  explicit Layout(const Int3& n) : cells(n) {
    const auto round_up = [](Index value) { return (value + alignment - 1) / alignment * alignment; };
    constexpr Index g = ghost_width;
    pitch_y = round_up(n[0] + 2 * g);
    pitch_z = pitch_y * (n[1] + 2 * g);
    offset = round_up(g) + g * pitch_y + g * pitch_z;
    size = round_up(g) + pitch_z * (n[2] + 2 * g + 1) + alignment;
  }
  KOKKOS_INLINE_FUNCTION Index operator()(int i, int j, int k) const {
    return offset + i + pitch_y * j + pitch_z * k;
  }
  /// Step of the linear index along axis.
  KOKKOS_INLINE_FUNCTION Index stride(int axis) const {
    return axis == 0 ? Index{1} : (axis == 1 ? pitch_y : pitch_z);
  }
};

}  // namespace peclet
