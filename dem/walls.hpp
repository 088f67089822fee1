#pragma once
// Planes and scenes as walls.
#include <span>
#include <vector>

#include "core/rigid_body.hpp"
#include "core/scene.hpp"
#include "core/scene_program.hpp"
#include "dem/materials.hpp"

namespace peclet::dem {

/// A half space, or the solid of a scene node (its complement if inverted).
struct Wall {
  static constexpr int of_default_material = 0, of_own_material = -1;

  int slot = -1;       // of the scene program; -1: half space behind point
  Vec3 point, normal;  // of a half space; the normal points into the free side
  Pose pose;           // of a scene
  Twist twist;         // the surface moves with velocity_at(twist, center, x)
  Vec3 center;
  Real sign = 1;  // -1: inverted
  int material_id = of_default_material;
  KOKKOS_INLINE_FUNCTION int elastic_id() const {
    return material_id == of_own_material ? of_default_material : material_id;
  }
  ContactMaterial own_material;
};

/// Where a sphere may touch a wall: tangent plane of the wall there, normal into the free side.
struct WallFeature {
  Vec3 point, normal, velocity;
};

/// Copied by value into kernels.
struct WallArrays {
  static constexpr int maximum_features = 4;  // a corner of three faces, and one to spare

  int count = 0;
  Array<Wall> walls;
  SceneProgram program;

  KOKKOS_INLINE_FUNCTION Real distance(const Wall& wall, Vec3 x) const {
    return wall.slot < 0 ? dot(wall.normal, x - wall.point)
                         : wall.sign * program.distance(wall.slot, wall.pose, x);
  }
  KOKKOS_INLINE_FUNCTION Vec3 normal(const Wall& wall, Vec3 x) const {
    return wall.slot < 0 ? wall.normal : normalized(wall.sign * program.gradient(wall.slot, wall.pose, x));
  }
  /// Features of wall within reach of the centre x of a sphere; returns their number.
  KOKKOS_FUNCTION int features_near(const Wall& wall, Vec3 x, Real radius, Real reach,
                                    WallFeature* features) const;
};

class Walls {
 public:
  Walls();

  void add_plane(Vec3 point, Vec3 normal);
  /// Solid of node root of the records (see Scene); returns the index of the wall among the scenes.
  int add_scene(std::span<const int> node_ints, std::span<const Real> node_reals, int root, bool invert,
                Real restitution, Real friction, Real rolling_friction = 0);
  /// Places the solid. The walls do not move by themselves.
  void set_transform(int scene_wall, Vec3 translation, Quaternion rotation);
  /// Velocity of the surface, felt by what touches it.
  void set_velocity(int scene_wall, const Twist& twist, Vec3 center);
  /// From now on the table of pairs decides, instead of the wall's own numbers.
  void set_material_id(int scene_wall, int material_id);
  /// Signed distances of points (x, y, z, ...) from one wall, positive on the free side.
  std::vector<Real> distances(int scene_wall, std::span<const Real> points) const;

  /// Changes with every change.
  int revision() const { return revision_; }
  /// Material id of a wall that has no elastic constants, or -1.
  int find_material_without_elasticity(const Materials& materials) const;

  int number_of_scenes() const { return static_cast<int>(scene_walls_.size()); }
  const WallArrays& arrays() const { return arrays_; }

 private:
  std::size_t position_of(int scene_wall) const;
  void upload();

  std::vector<Wall> walls_;
  std::vector<std::size_t> scene_walls_;  // positions in walls_
  std::vector<int> node_ints_, roots_;    // of all scenes, one after the other
  std::vector<Real> node_reals_;
  WallArrays arrays_;
  int revision_ = 0;
};

}  // namespace peclet::dem
