#pragma once
// A solid given by samples of its distance on a lattice.
#include <span>

#include "core/scene_sampling.hpp"
#include "core/sdf_dual.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet {

/// Copied by value into kernels. Trilinear between the samples; outside the lattice the distance to the
/// lattice is added to the value at its nearest point.
class SampledShape {
 public:
  SampledShape() = default;
  /// Values with x fastest; at least two points per axis.
  SampledShape(const Lattice& lattice, std::span<const float> values);

  KOKKOS_FUNCTION Real distance(Vec3 x) const { return distance_and_gradient(x).value; }
  KOKKOS_FUNCTION Vec3 gradient(Vec3 x) const { return distance_and_gradient(x).gradient; }

  KOKKOS_FUNCTION sdf::Dual distance_and_gradient(Vec3 x) const {
    int low[3];
    Vec3 t, beyond;  // t: place between the samples low and low + 1
    for (int axis = 0; axis < 3; ++axis) {
      const Real h = lattice_.spacing[axis];
      const int last = lattice_.points[axis] - 1;
      const Real place = (x[axis] - lattice_.origin[axis]) / h;
      const Real s = Kokkos::fmin(Kokkos::fmax(place, Real(0)), Real(last));
      low[axis] = Kokkos::min(static_cast<int>(s), last - 1);
      t[axis] = s - low[axis];
      beyond[axis] = (place - s) * h;
    }
    sdf::Dual d = interpolate(low, t);
    const Real outside = norm(beyond);
    if (!(outside > 0)) return d;
    for (int axis = 0; axis < 3; ++axis)
      if (beyond[axis] != 0) d.gradient[axis] = 0;
    return {d.value + outside, d.gradient + beyond / outside};
  }

  const Lattice& lattice() const { return lattice_; }

 private:
  KOKKOS_INLINE_FUNCTION Real sample(int i, int j, int k) const {
    return values_(i + lattice_.points[0] * (j + static_cast<Index>(lattice_.points[1]) * k));
  }
  KOKKOS_INLINE_FUNCTION sdf::Dual interpolate(const int (&low)[3], Vec3 t) const {
    sdf::Dual sum;
    for (int n = 0; n < 8; ++n) {
      const int offset[3] = {n & 1, (n >> 1) & 1, n >> 2};
      Real weight[3], slope[3];
      for (int axis = 0; axis < 3; ++axis) {
        weight[axis] = offset[axis] ? t[axis] : 1 - t[axis];
        slope[axis] = (offset[axis] ? 1 : -1) / lattice_.spacing[axis];
      }
      const Real value = sample(low[0] + offset[0], low[1] + offset[1], low[2] + offset[2]);
      sum.value += weight[0] * weight[1] * weight[2] * value;
      sum.gradient += value * Vec3{slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                   weight[0] * weight[1] * slope[2]};
    }
    return sum;
  }

  Lattice lattice_;
  Array<float> values_;
};

}  // namespace peclet
