#pragma once
// Velocity points whose stencil touches a wall: a compact list beside the regular grid sweep.
#include "core/field.hpp"
#include "core/sweep_stage.hpp"
#include "flow/domain_sides.hpp"
#include "flow/near_cells.hpp"
#include "flow/open_fraction.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// Smallest distance to a wall, in spacings, that enters a stencil: bounds the coefficients.
inline constexpr Real smallest_wall_distance = 1e-2;

/// The same beside walls that move along their normal, with a velocity U_n of a high cell Reynolds number
/// R = |U_n| h / nu. Friction slows the point at a distance l down at the rate 2 nu / (l h), and the wall is
/// there within l / U_n: above R = 2 it arrives first, whatever l. Friction that grows like 1 / l would hand
/// over what the point still carries in the last step before it is covered, as a jolt; the distance is
/// therefore at least smallest + (moving - smallest) R / (R + 1/10), and CoveredPoints takes care of the
/// rest. moving is that of sliding for velocity components across the normal n of the wall, that of approach
/// for those along it, and between them it follows n_c^2. Along the normal the projection keeps the fluid at
/// the velocity of the wall, and the derivative of the velocity vanishes there: friction at a small l would
/// only magnify what the splitting of the two leaves.
inline constexpr Real smallest_sliding_distance = 0.09;
inline constexpr Real smallest_approach_distance = 0.4;
inline constexpr Real cell_reynolds_of_half_rise = 0.1;

/// Between two walls closer than this, in spacings, a stencil keeps this width: the forces that the two
/// exchange through it stay those of the fluid in the gap.
inline constexpr Real narrowest_stencil = 1;

/// Rows of one velocity component. Direction d = 2 a + s is the low (s = 0) or high (s = 1) neighbour along
/// axis a. Along each axis, with wall (or neighbour) distances l and h in spacings [ShortleyWeller1938],
///   u'' = [ 2 / (l (l + h)) (u_low - u) + 2 / (h (l + h)) (u_high - u) ] / spacing^2,
/// where u_low or u_high is the wall velocity on the side of a wall: exact for quadratic profiles.
struct WallRows {
  static constexpr int directions = 6;

  Index count = 0;
  Array<Index> face;                                        // linear index of the velocity point
  Kokkos::View<float* [directions], MemorySpace> distance;  // to the wall, or 1, in spacings
  Kokkos::View<float* [directions], MemorySpace> weight;    // 2 / (l (l + h)), not divided by spacing^2
  Kokkos::View<int* [directions], MemorySpace> owner;  // body of each wall; of the nearest body elsewhere
  Array<std::uint8_t> walls;                           // bit d: there is a wall in direction d
  Array<Real> wall_sum;                                // sum over walls of weight * wall velocity / spacing^2
  Array<Real> dilation;                                // v_c div(v), see advective_leak
  Array<std::uint8_t> superseded;                      // rows of fixed bodies inside a moving region
  RowChains chains;                                    // by row of cells

  KOKKOS_INLINE_FUNCTION bool is_wall(Index row, int d) const { return (walls(row) >> d) & 1; }
  /// 0 where there is a wall, else 1: a factor, because branches on walls are mispredicted.
  KOKKOS_INLINE_FUNCTION float openness(Index row, int d) const {
    return static_cast<float>(1 - ((walls(row) >> d) & 1));
  }

  void reserve(Index capacity);
  Index bytes() const {
    constexpr std::size_t per_row =
        sizeof(Index) + directions * (2 * sizeof(float) + sizeof(int)) + 2 * sizeof(Real) + sizeof(int) + 2;
    return static_cast<Index>(face.extent(0) * per_row + chains.first.extent(0) * sizeof(int));
  }
};

/// Indices of the cell that a linear index belongs to.
KOKKOS_INLINE_FUNCTION Int3 cell_of(const Layout& layout, Index n) {
  const Index m = n - layout.offset;
  const int k = static_cast<int>(m / layout.pitch_z);
  const int j = static_cast<int>((m - k * layout.pitch_z) / layout.pitch_y);
  return {static_cast<int>(m - k * layout.pitch_z - j * layout.pitch_y), j, k};
}

/// True where the stencil of component c at the fluid face of cell (i, j, k) touches the wall of a body: a
/// neighbouring point is solid, or a face that carries mass through its control volume is partly closed.
/// Faces on the sides of the box are no walls of bodies, unless a body covers them: ghosts express them.
KOKKOS_INLINE_FUNCTION bool touches_wall(const FaceVector<OpenFraction>& open, const Field<Real>& sdf,
                                         const DomainSides& sides, int c, int i, int j, int k) {
  const Layout& layout = open.x.layout();
  const Index p = layout(i, j, k), own = layout.stride(c);
  const int at[3] = {i, j, k};
  bool touched = open[c][p] < fully_open;
  for (int a = 0; a < 3; ++a) {
    const Index step = layout.stride(a);
    const bool low_side = sides.is_side(a, a == c ? at[a] - 1 : at[a], layout.cells);
    const bool high_side = sides.is_side(a, at[a] + 1, layout.cells);
    if (a == c) {
      touched = touched | (low_side ? sdf[p - step] < 0 : open[c][p - step] < fully_open) |
                (high_side ? sdf[p] < 0 : open[c][p + step] < fully_open);
    } else {
      const OpenFraction low = Kokkos::min(open[a][p], open[a][p - own]);
      const OpenFraction high = Kokkos::min(open[a][p + step], open[a][p + step - own]);
      touched = touched | !is_fluid(open[c][p - step]) | !is_fluid(open[c][p + step]) |
                (!low_side & (low < fully_open)) | (!high_side & (high < fully_open));
    }
  }
  return touched;
}

/// Lists the rows of component c among the cells near walls.
void build_wall_rows(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                     const DomainSides& sides, const CellList& near, const Array<Index>& scratch,
                     WallRows& rows);

/// Chains the rows by row of cells once their faces are known.
void chain_rows(const Layout& layout, WallRows& rows);

/// Recomputes weight and wall_sum from the mean velocities of the bodies in the step. viscosity is the
/// kinematic one.
void refresh_wall_motion(int c, const SolidSampler& solid, Real viscosity, const WallRows& rows);

}  // namespace peclet::flow
