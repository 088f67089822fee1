#pragma once
// Roots of a scene flattened for kernels: every leaf carries its whole transform, and the operations run
// over a small fixed stack.
#include <vector>

#include "core/rigid_body.hpp"
#include "core/scene.hpp"
#include "core/sdf_primitives.hpp"
#include "core/types.hpp"

namespace peclet {

/// Distance of a body that is not there.
inline constexpr Real far_away = 1e30;

/// Leaf with the transform from the frame of its root: local = axes^T (x - translation) / scale.
struct PlacedLeaf {
  Opcode opcode = Opcode::Sphere;
  Real scale = 1, inverse_scale = 1;
  Vec3 translation;
  Vec3 axes[3];  // columns of the rotation
  sdf::Parameters parameters{};

  PlacedLeaf() = default;
  PlacedLeaf(const SceneNode& node, const Pose& pose);

  KOKKOS_INLINE_FUNCTION Vec3 to_leaf(Vec3 x) const {
    const Vec3 d = inverse_scale * (x - translation);
    return {dot(axes[0], d), dot(axes[1], d), dot(axes[2], d)};
  }
  KOKKOS_INLINE_FUNCTION Real evaluate(Vec3 x, Real) const {
    const Vec3 p = to_leaf(x);
    return scale * sdf::leaf_distance<Real>(opcode, p.x, p.y, p.z, parameters);
  }
  KOKKOS_INLINE_FUNCTION sdf::Dual evaluate(Vec3 x, sdf::Dual) const {
    const Vec3 p = to_leaf(x);
    const sdf::Dual d =
        sdf::leaf_distance<sdf::Dual>(opcode, {p.x, axes[0]}, {p.y, axes[1]}, {p.z, axes[2]}, parameters);
    return {scale * d.value, d.gradient};
  }
};

/// One root of a program.
struct ProgramSlot {
  int first = 0, last = 0;          // steps
  int single_leaf = -1;             // the leaf, if there is only one
  Real centered_sphere_radius = 0;  // positive if the root is a sphere around the origin
};

/// Copied by value into kernels. Slot s evaluates roots[s]; equal roots share their program.
class SceneProgram {
 public:
  SceneProgram() = default;
  SceneProgram(const Scene& scene, const std::vector<int>& roots);

  /// Signed distance in the frame of the root.
  KOKKOS_FUNCTION Real distance(int slot, Vec3 local) const { return evaluate<Real>(slots_(slot), local); }

  /// Radius if the root is a sphere around the origin, else 0.
  KOKKOS_INLINE_FUNCTION Real sphere_radius(int slot) const { return slots_(slot).centered_sphere_radius; }

  /// Signed distance of the placed body; far_away where it has vanished.
  KOKKOS_FUNCTION Real distance(int slot, const Pose& pose, Vec3 world) const {
    if (pose.scale == 0) return far_away;
    const ProgramSlot& program = slots_(slot);
    if (program.centered_sphere_radius > 0)
      return norm(world - pose.translation) - pose.scale * program.centered_sphere_radius;
    return pose.scale * evaluate<Real>(program, to_local(pose, world));
  }

  /// Gradient of the distance in the frame of the root, of unit length for exact distances. Where several
  /// surface points are equally near it belongs to one of them.
  KOKKOS_FUNCTION Vec3 gradient(int slot, Vec3 local) const {
    return evaluate<sdf::Dual>(slots_(slot), local).gradient;
  }

  /// Gradient of the distance of the placed body, along world axes.
  KOKKOS_FUNCTION Vec3 gradient(int slot, const Pose& pose, Vec3 world) const {
    if (pose.scale == 0) return {};
    return rotate(pose.rotation, gradient(slot, to_local(pose, world)));
  }

  KOKKOS_FUNCTION sdf::Dual distance_and_gradient(int slot, Vec3 local) const {
    return evaluate<sdf::Dual>(slots_(slot), local);
  }

  int number_of_slots() const { return static_cast<int>(slots_.extent(0)); }

 private:
  template <class T>
  KOKKOS_INLINE_FUNCTION T evaluate(const ProgramSlot& program, Vec3 x) const {
    if (program.single_leaf >= 0) return leaves_(program.single_leaf).evaluate(x, T{});
    T stack[FlatRoot::stack_size];
    int top = -1;
    for (int n = program.first; n < program.last; ++n) {
      const int step = steps_(n);
      if (step >= 0) {
        stack[++top] = leaves_(step).evaluate(x, T{});
        continue;
      }
      const T second = stack[top--];
      const T first = stack[top];
      stack[top] = step == FlatRoot::Unite       ? sdf::unite(first, second)
                   : step == FlatRoot::Intersect ? sdf::intersect(first, second)
                   : step == FlatRoot::Subtract  ? sdf::subtract(first, second)
                                                 : sdf::subtract(second, first);
    }
    return stack[0];
  }

  Array<PlacedLeaf> leaves_;
  Array<int> steps_;
  Array<ProgramSlot> slots_;
};

/// A body for kernels.
struct PlacedSlot {
  int slot = 0;
  Pose pose;
};

}  // namespace peclet
