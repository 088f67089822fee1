#include "dem/walls.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/loop.hpp"
#include "dem/wall_features.hpp"

namespace peclet::dem {
namespace {

void require_finite_vector(Vec3 v, const char* argument) {
  for (int axis = 0; axis < 3; ++axis) require_finite(v[axis], argument);
}

void evaluate_distances(const WallArrays& walls, int index, const Array<Vec3>& points,
                        const Array<Real>& values) {
  for_each(
      "dem::evaluate_distances", static_cast<Index>(points.extent(0)),
      KOKKOS_LAMBDA(Index n) { values(n) = walls.distance(walls.walls(index), points(n)); });
}

}  // namespace

Walls::Walls() { upload(); }

void Walls::upload() {
  ++revision_;
  arrays_.count = static_cast<int>(walls_.size());
  arrays_.walls = Array<Wall>("dem.walls", walls_.size());
  const Kokkos::View<const Wall*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host(walls_.data(),
                                                                                   walls_.size());
  Kokkos::deep_copy(arrays_.walls, host);
}

void Walls::add_plane(Vec3 point, Vec3 normal) {
  require_finite_vector(point, "point");
  require_finite_vector(normal, "normal");
  require(norm(normal) > 0 && std::isfinite(norm(normal)), "normal", "a vector of non-zero finite length",
          norm(normal));
  Wall wall;
  wall.point = point;
  wall.normal = normalized(normal);
  walls_.push_back(wall);
  upload();
}

int Walls::add_scene(std::span<const int> node_ints, std::span<const Real> node_reals, int root, bool invert,
                     Real restitution, Real friction, Real rolling_friction) {
  Wall wall;
  wall.own_material = {restitution, 0, friction, rolling_friction, damping_ratio(restitution)};
  require(restitution >= 0 && restitution <= 1, "restitution", "a number in [0, 1]", restitution);
  require_non_negative(friction, "friction");
  require_non_negative(rolling_friction, "rolling_friction");
  Scene::decode(node_ints, node_reals, {}, {}).require_node(root, "root");

  const int first_node = static_cast<int>(node_ints_.size()) / Scene::ints_per_node;
  std::vector<int> ints = node_ints_, roots = roots_;
  for (std::size_t n = 0; n < node_ints.size(); ++n) {
    const bool is_child = n % Scene::ints_per_node != 0 && node_ints[n] >= 0;
    ints.push_back(node_ints[n] + (is_child ? first_node : 0));
  }
  std::vector<Real> reals = node_reals_;
  reals.insert(reals.end(), node_reals.begin(), node_reals.end());
  roots.push_back(first_node + root);
  arrays_.program = SceneProgram(Scene::decode(ints, reals, {}, {}), roots);

  wall.slot = static_cast<int>(roots_.size());
  wall.sign = invert ? -1 : 1;
  wall.material_id = Wall::of_own_material;
  node_ints_ = std::move(ints);
  node_reals_ = std::move(reals);
  roots_ = std::move(roots);
  scene_walls_.push_back(walls_.size());
  walls_.push_back(wall);
  upload();
  return number_of_scenes() - 1;
}

std::size_t Walls::position_of(int scene_wall) const {
  require(scene_wall >= 0 && scene_wall < number_of_scenes(), "wall_index",
          "the index of one of " + std::to_string(number_of_scenes()) + " scene walls", scene_wall);
  return scene_walls_[static_cast<std::size_t>(scene_wall)];
}

void Walls::set_transform(int index, Vec3 translation, Quaternion rotation) {
  Wall& wall = walls_[position_of(index)];
  require_finite_vector(translation, "translation");
  require_finite_vector({rotation.x, rotation.y, rotation.z}, "quat");
  require_finite(rotation.w, "quat");
  const Quaternion q = rotation;
  const Real length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  require(length > 0 && std::isfinite(length), "quat", "a non-zero quaternion", length);
  wall.pose.translation = translation;
  wall.pose.rotation = normalized(rotation);
  upload();
}

void Walls::set_velocity(int index, const Twist& twist, Vec3 center) {
  Wall& wall = walls_[position_of(index)];
  require_finite_vector(twist.linear, "lin_vel");
  require_finite_vector(twist.angular, "ang_vel");
  require_finite_vector(center, "center");
  wall.twist = twist;
  wall.center = center;
  upload();
}

void Walls::set_material_id(int index, int material_id) {
  Wall& wall = walls_[position_of(index)];
  wall.material_id = material_id;
  upload();
}

int Walls::find_material_without_elasticity(const Materials& materials) const {
  for (const Wall& wall : walls_)
    if (!materials.is_elastic(wall.elastic_id())) return wall.elastic_id();
  return -1;
}

std::vector<Real> Walls::distances(int index, std::span<const Real> points) const {
  const int position = static_cast<int>(position_of(index));
  require(points.size() % 3 == 0, "points", "rows of three", points.size());
  for (const Real value : points) require_finite(value, "points");
  const std::size_t count = points.size() / 3;
  const Kokkos::View<const Vec3*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host_points(
      reinterpret_cast<const Vec3*>(points.data()), count);
  const Array<Vec3> x("dem.points", count);
  const Array<Real> values("dem.distances", count);
  Kokkos::deep_copy(x, host_points);
  evaluate_distances(arrays_, position, x, values);
  std::vector<Real> result(count);
  Kokkos::deep_copy(Kokkos::View<Real*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(result.data(), count),
                    values);
  return result;
}

}  // namespace peclet::dem
