#pragma once
// The discrete geometry of a few spheres in a periodic box.
#include "bodies_in_tests.hpp"
#include "flow/immersed_boundary.hpp"

namespace peclet::flow {

struct BoundaryInTest {
  Bodies bodies;
  ImmersedBoundary boundary;

  explicit BoundaryInTest(const std::vector<SphereInTest>& spheres,
                          const WallFriction& friction = {0.1, 1e-2})
      : bodies(scene_of(spheres), grid_in_tests(), true, {}), boundary(grid_in_tests(), {}) {
    boundary.build(bodies, {}, friction);
    boundary.refresh_friction(bodies);
  }
};

inline SphereInTest moving(SphereInTest sphere, Vec3 linear, Vec3 angular = {}) {
  sphere.twist = {linear, angular};
  return sphere;
}

}  // namespace peclet::flow
