#pragma once
// The fluid has another volume than its velocity points, which count as a whole cell each or not at all. The
// body force f acts on the points, N h^3 of them, where the fluid has the volume V: what f pushes with
// f (V - N h^3) is missing in the forces on the bodies, by which a body at rest in a driven flow would feel
// f N h^3 and one in a tank the buoyancy of its points. The difference varies by the place of a body in its
// cell: 0.1 to 1 % of the force on spheres of 12 to 16 cells. It is given to the body beside the points.
#include <vector>

#include "core/scatter_sum.hpp"
#include "flow/domain_sides.hpp"
#include "flow/immersed_boundary.hpp"

namespace peclet::flow {

/// Of one body and the points of each component c around it.
struct VolumeDefect {
  Vec3 volume;       // [c]: volume of the fluid less that of its points
  Vec3 leverage[3];  // [c]: torque of a unit force density along c on that volume
};

/// Integral of (1 + cos(pi s)) / 2 from -1 to s.
KOKKOS_INLINE_FUNCTION Real smooth_step(Real s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 * (1 + s + Kokkos::sin(Kokkos::numbers::pi * s) / Kokkos::numbers::pi);
}

/// Part of a cell that is fluid, from the distance d of its centre and the width w of cells along the
/// normal: the integral of the kernel (4 k(w) - k(2 w)) / 3 with k(w) = (1 + cos(pi d / w)) / (2 w). The sum
/// over the cells is exact for planes along the grid and has no error from the curvature of a surface, whose
/// second moment with the kernel vanishes.
KOKKOS_INLINE_FUNCTION Real smooth_fluid_part(Real distance, Real width) {
  return (4 * smooth_step(distance / width) - smooth_step(distance / (2 * width))) / 3;
}

/// Finds the defects when the boundary has changed.
class VolumeDefects {
 public:
  /// One per body, and one more for solid that is no instance.
  const std::vector<VolumeDefect>& find(const ImmersedBoundary& boundary, const DomainSides& sides,
                                        int bodies);

 private:
  ScatterSum sums_;
  std::vector<VolumeDefect> defects_;
  Index revision_ = -1;
};

}  // namespace peclet::flow
