#include "core/scene_sampling.hpp"

#include <vector>

#include "core/field_transfer.hpp"
#include "core/loop.hpp"
#include "core/scene_program.hpp"

namespace peclet {

namespace {

KOKKOS_INLINE_FUNCTION Vec3 point_at(const Array<Real>& points, Index n) {
  return {points(3 * n), points(3 * n + 1), points(3 * n + 2)};
}

Array<Real> points_for_kernels(std::span<const Real> points) {
  return copy_from_host("core::points", points.data(), static_cast<Index>(points.size()));
}

Array<Real> result(std::size_t size) {
  return Array<Real>(Kokkos::view_alloc("core::distances", Kokkos::WithoutInitializing), size);
}

}  // namespace

void sample_root(const Scene& scene, int root, std::span<const Real> points, std::span<Real> distances) {
  const SceneProgram program(scene, {root});
  const Array<Real> x = points_for_kernels(points), d = result(distances.size());
  for_each(
      "core::sample_root", static_cast<Index>(distances.size()),
      KOKKOS_LAMBDA(Index n) { d(n) = program.distance(0, point_at(x, n)); });
  copy_to_host(d, distances.data());
}

void sample_root(const Scene& scene, int root, std::span<const Real> points, std::span<Real> distances,
                 std::span<Real> gradients) {
  const SceneProgram program(scene, {root});
  const Array<Real> x = points_for_kernels(points), d = result(distances.size()),
                    g = result(gradients.size());
  for_each(
      "core::sample_root", static_cast<Index>(distances.size()), KOKKOS_LAMBDA(Index n) {
        d(n) = program.distance(0, point_at(x, n));
        const Vec3 gradient = program.gradient(0, point_at(x, n));
        for (int axis = 0; axis < 3; ++axis) g(3 * n + axis) = gradient[axis];
      });
  copy_to_host(d, distances.data());
  copy_to_host(g, gradients.data());
}

void sample_scene(const Scene& scene, std::span<const Real> points, std::span<Real> distances) {
  std::vector<int> roots;
  std::vector<PlacedSlot> placed;
  for (const SceneInstance& instance : scene.instances()) {
    placed.push_back({static_cast<int>(roots.size()), instance.pose});
    roots.push_back(instance.root);
  }
  const SceneProgram program(scene, roots);
  const Array<PlacedSlot> instances = copy_from_host("core::instances", placed);
  const Array<Real> x = points_for_kernels(points), d = result(distances.size());
  for_each(
      "core::sample_scene", static_cast<Index>(distances.size()), KOKKOS_LAMBDA(Index n) {
        Real nearest = far_away;
        for (std::size_t m = 0; m < instances.extent(0); ++m)
          nearest =
              Kokkos::fmin(nearest, program.distance(instances(m).slot, instances(m).pose, point_at(x, n)));
        d(n) = nearest;
      });
  copy_to_host(d, distances.data());
}

void sample_root(const Scene& scene, int root, const Lattice& lattice, std::span<float> distances) {
  const SceneProgram program(scene, {root});
  const Index nx = lattice.points[0], ny = lattice.points[1];
  const Vec3 origin = lattice.origin, h = lattice.spacing;
  const Array<float> d(Kokkos::view_alloc("core::distances", Kokkos::WithoutInitializing), distances.size());
  for_each(
      "core::sample_root", lattice.size(), KOKKOS_LAMBDA(Index n) {
        const auto i = static_cast<Real>(n % nx), j = static_cast<Real>(n / nx % ny),
                   k = static_cast<Real>(n / (nx * ny));
        d(n) = static_cast<float>(
            program.distance(0, {origin.x + i * h.x, origin.y + j * h.y, origin.z + k * h.z}));
      });
  copy_to_host(d, distances.data());
}

}  // namespace peclet
