#pragma once
// Scenes of spheres for the tests of the flow library.
#include <vector>

#include "core/field_transfer.hpp"
#include "flow/bodies.hpp"

namespace peclet::flow {

struct SphereInTest {
  Vec3 center;
  Real radius = 1;
  Twist twist{};
};

inline Scene scene_of(const std::vector<SphereInTest>& spheres) {
  Scene scene;
  for (const SphereInTest& sphere : spheres) {
    SceneInstance instance;
    instance.root = scene.add_leaf("sphere", std::vector<Real>{sphere.radius});
    instance.pose.translation = sphere.center;
    instance.twist = sphere.twist;
    scene.add_instance(instance);
  }
  return scene;
}

/// values[i + nx (j + ny k)]
template <class T>
std::vector<T> host_values(const Field<T>& field) {
  const Int3 n = field.layout().cells;
  std::vector<T> values(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                        static_cast<std::size_t>(n[2]));
  copy_to_host(field, values.data());
  return values;
}

/// Unequal cells, and an origin that is not zero.
inline Grid grid_in_tests() { return {{14, 11, 9}, {0.5, 0.625, 0.75}, {-1, 2, 0.5}}; }

}  // namespace peclet::flow
