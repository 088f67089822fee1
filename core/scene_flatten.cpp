#include <algorithm>

#include "core/error.hpp"
#include "core/scene.hpp"

namespace peclet {

namespace {

bool is_leaf(const SceneNode& node) { return node.left < 0; }

/// What it takes to evaluate a node: leaves with shared ones repeated (up to one too many), and entries of
/// the stack if the deeper side goes first.
struct Effort {
  int leaves = 0, stack = 0;
};

std::vector<Effort> efforts_below(const std::vector<SceneNode>& nodes, int root) {
  std::vector<Effort> efforts(nodes.size());
  std::vector<int> pending{root};
  while (!pending.empty()) {
    const int n = pending.back();
    const SceneNode& node = nodes[n];
    if (efforts[n].leaves > 0) {
      pending.pop_back();
    } else if (is_leaf(node)) {
      efforts[n] = {1, 1};
    } else if (efforts[node.left].leaves == 0 || efforts[node.right].leaves == 0) {
      for (int child : {node.left, node.right})
        if (efforts[child].leaves == 0) pending.push_back(child);
    } else {
      const Effort a = efforts[node.left], b = efforts[node.right];
      efforts[n].leaves = std::min(a.leaves + b.leaves, FlatRoot::maximum_leaves + 1);
      efforts[n].stack = a.stack == b.stack ? a.stack + 1 : std::max(a.stack, b.stack);
    }
  }
  return efforts;
}

FlatRoot::Step step_of(Opcode opcode, bool second_goes_first) {
  switch (opcode) {
    case Opcode::Union:
      return FlatRoot::Unite;
    case Opcode::Intersection:
      return FlatRoot::Intersect;
    default:
      return second_goes_first ? FlatRoot::SubtractFromSecond : FlatRoot::Subtract;
  }
}

}  // namespace

FlatRoot flatten(const std::vector<SceneNode>& nodes, int root, const Pose& frame) {
  const std::vector<Effort> efforts = efforts_below(nodes, root);
  require(efforts[root].leaves <= FlatRoot::maximum_leaves, "root",
          "at most " + std::to_string(FlatRoot::maximum_leaves) + " leaves once shared nodes are repeated",
          "more");
  struct Task {
    int node;  // -1: write step
    int step;
    Pose frame;
  };
  FlatRoot flat;
  std::vector<Task> tasks{{root, 0, frame}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.node < 0) {
      flat.steps.push_back(task.step);
      continue;
    }
    const SceneNode& node = nodes[task.node];
    const Pose inner = compose(task.frame, node.pose);
    if (is_leaf(node)) {
      flat.steps.push_back(static_cast<int>(flat.leaves.size()));
      flat.leaves.push_back({task.node, inner});
      continue;
    }
    const bool second_goes_first = efforts[node.right].stack > efforts[node.left].stack;
    const int step = step_of(static_cast<Opcode>(node.opcode), second_goes_first);
    tasks.push_back({-1, step, {}});
    tasks.push_back({second_goes_first ? node.left : node.right, 0, inner});
    tasks.push_back({second_goes_first ? node.right : node.left, 0, inner});
  }
  return flat;
}

}  // namespace peclet
