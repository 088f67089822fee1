#pragma once
// A scene on the host: a graph of signed distance nodes and the instances that place its roots in the
// world. Everything is checked on entry, so that programs made from a scene need no checks.
#include <span>
#include <string>
#include <vector>

#include "core/rigid_body.hpp"
#include "core/sdf_operations.hpp"
#include "core/types.hpp"

namespace peclet {

/// value(q) = scale f((R^T (q - t)) / scale), f being a leaf or a combination of two earlier nodes.
struct SceneNode {
  int opcode = 0;
  int left = -1, right = -1;  // -1 for leaves
  Kokkos::Array<Real, 8> parameters{};
  Pose pose{};
};

struct SceneInstance {
  int root = 0;
  int material = -1;  // -1: none
  Pose pose{};
  Twist twist{};
  Vec3 center{};  // of rotation; means nothing unless pinned
  bool center_pinned = false;

  /// A centre that is not pinned follows the translation.
  Vec3 center_of_rotation() const { return center_pinned ? center : pose.translation; }
};

class Scene {
 public:
  static constexpr int ints_per_node = 3, reals_per_node = 16;
  static constexpr int ints_per_instance = 2, reals_per_instance = 18;

  /// Axis-aligned box around a solid: finite, maybe larger than needed.
  struct Bounds {
    Vec3 low, high;
    bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  };

  /// Flat records as Python sees them; the columns are listed in core/README.md.
  struct Records {
    std::vector<int> node_ints;
    std::vector<Real> node_reals;
    std::vector<int> instance_ints;
    std::vector<Real> instance_reals;
  };

  /// Each returns the index of the new node. pose moves the finished node.
  int add_leaf(const std::string& kind, std::span<const Real> parameters, const Pose& pose = {});
  int add_union(int a, int b, const Pose& pose = {});
  int add_intersection(int a, int b, const Pose& pose = {});
  int add_difference(int a, int b, const Pose& pose = {});  // a without b
  /// Copy of node root seen in another frame.
  int add_reframed(int root, const Pose& pose);
  /// Returns the index of the new instance.
  int add_instance(const SceneInstance& instance);

  const std::vector<SceneNode>& nodes() const { return nodes_; }
  const std::vector<SceneInstance>& instances() const { return instances_; }
  int number_of_nodes() const { return static_cast<int>(nodes_.size()); }
  int number_of_instances() const { return static_cast<int>(instances_.size()); }

  /// Box around the solid of root placed at pose; tight for leaves and their unions. Empty if an intersection
  /// is.
  Bounds bounds(int root, const Pose& pose = {}) const;
  void require_node(long long index, const std::string& argument) const;

  Records encode() const;
  /// Accepts 17 or 18 reals per instance, and instances of scale zero (vanished bodies).
  static Scene decode(std::span<const int> node_ints, std::span<const Real> node_reals,
                      std::span<const int> instance_ints, std::span<const Real> instance_reals);

 private:
  int add_operation(Opcode opcode, int a, int b, const Pose& pose);

  std::vector<SceneNode> nodes_;
  std::vector<SceneInstance> instances_;
};

/// A root as a list of leaves with their whole transforms, and steps in postfix order: a step >= 0 puts that
/// leaf on a stack, the others combine the two topmost entries.
struct FlatRoot {
  enum Step : int { Unite = -1, Intersect = -2, Subtract = -3, SubtractFromSecond = -4 };
  /// A stack of this size suffices for maximum_leaves leaves, because the deeper side goes first.
  static constexpr int stack_size = 16;
  static constexpr int maximum_leaves = 1 << (stack_size - 1);

  struct Leaf {
    int node;
    Pose pose;  // from the frame of the root, seen through frame
  };
  std::vector<Leaf> leaves;
  std::vector<int> steps;
};

/// Shared nodes are repeated. Throws if root has more than maximum_leaves leaves then.
FlatRoot flatten(const std::vector<SceneNode>& nodes, int root, const Pose& frame = {});

}  // namespace peclet
