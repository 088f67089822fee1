#pragma once
// What becomes of the momentum of velocity points that a moving body covers.
#include "core/scatter_sum.hpp"
#include "flow/solid_sampler.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// A point that a wall has just covered still moves relative to it where friction was too slow to stop it,
/// see smallest_sliding_distance. It takes the velocity U of the body; the momentum u - U that it had beyond
/// that is handed on in equal parts to the points that were beside the same body and are still in the fluid.
/// It would be lost otherwise, and bodies that move would have less drag than bodies at rest.
class CoveredPoints {
 public:
  /// Before the geometry changes: the points of component c beside walls.
  void remember(int c, const WallRows& rows);
  /// After it: hands on what those of them carry that are solid now, both of the velocity of this and of the
  /// step before, so that the change of momentum over a step stays what it is.
  void hand_on(int c, const SolidSampler& solid, const Field<OpenFraction>& open, int number_of_bodies,
               const Field<Real>& velocity, const Field<Real>& previous);

 private:
  Index count_[3] = {0, 0, 0};
  Array<Index> points_[3];  // linear indices
  ScatterSum sums_;
};

}  // namespace peclet::flow
