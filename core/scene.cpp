#include "core/scene.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/scene_checks.hpp"
#include "core/scene_leaves.hpp"

namespace peclet {

namespace {

Scene::Bounds hull(const Scene::Bounds& a, const Scene::Bounds& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  Scene::Bounds box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(a.low[axis], b.low[axis]);
    box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return box;
}

Scene::Bounds overlap(const Scene::Bounds& a, const Scene::Bounds& b) {
  Scene::Bounds box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::max(a.low[axis], b.low[axis]);
    box.high[axis] = std::min(a.high[axis], b.high[axis]);
  }
  return box;
}

}  // namespace

int Scene::add_leaf(const std::string& kind, std::span<const Real> parameters, const Pose& pose) {
  const LeafKind& leaf = leaf_kind(kind);
  require_valid_leaf(leaf, parameters, "params");
  SceneNode node;
  node.opcode = static_cast<int>(leaf.opcode);
  std::copy(parameters.begin(), parameters.end(), &node.parameters[0]);
  node.pose = checked(pose, "");
  nodes_.push_back(node);
  return number_of_nodes() - 1;
}

int Scene::add_operation(Opcode opcode, int a, int b, const Pose& pose) {
  require_node(a, "a");
  require_node(b, "b");
  SceneNode node{static_cast<int>(opcode), a, b, {1.0}, checked(pose, "")};
  nodes_.push_back(node);
  return number_of_nodes() - 1;
}

int Scene::add_union(int a, int b, const Pose& pose) { return add_operation(Opcode::Union, a, b, pose); }

int Scene::add_intersection(int a, int b, const Pose& pose) {
  return add_operation(Opcode::Intersection, a, b, pose);
}

int Scene::add_difference(int a, int b, const Pose& pose) {
  return add_operation(Opcode::Difference, a, b, pose);
}

int Scene::add_reframed(int root, const Pose& pose) {
  require_node(root, "root");
  SceneNode node = nodes_[root];
  node.pose = compose(checked(pose, ""), node.pose);
  nodes_.push_back(node);
  return number_of_nodes() - 1;
}

int Scene::add_instance(const SceneInstance& instance) {
  require_node(instance.root, "root");
  instances_.push_back(checked(instance, "", false));
  return number_of_instances() - 1;
}

void Scene::require_node(long long index, const std::string& argument) const {
  require(index >= 0 && index < number_of_nodes(), argument,
          nodes_.empty() ? "the index of a node (there is none yet)"
                         : "a node index from 0 to " + std::to_string(number_of_nodes() - 1),
          index);
}

Scene::Bounds Scene::bounds(int root, const Pose& pose) const {
  require_node(root, "root");
  const FlatRoot flat = flatten(nodes_, root, pose);
  std::vector<Bounds> stack;
  for (int step : flat.steps) {
    if (step >= 0) {
      const SceneNode& node = nodes_[flat.leaves[step].node];
      stack.push_back(leaf_bounds(static_cast<Opcode>(node.opcode), node.parameters, flat.leaves[step].pose));
      continue;
    }
    const Bounds second = stack.back();
    stack.pop_back();
    Bounds& first = stack.back();
    if (step == FlatRoot::Unite) first = hull(first, second);
    if (step == FlatRoot::Intersect) first = overlap(first, second);
    if (step == FlatRoot::SubtractFromSecond) first = second;
  }
  return stack.back();
}

}  // namespace peclet
