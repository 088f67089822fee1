#include "core/scene_program.hpp"

#include <map>

#include "core/field_transfer.hpp"

namespace peclet {

PlacedLeaf::PlacedLeaf(const SceneNode& node, const Pose& pose)
    : opcode(static_cast<Opcode>(node.opcode)),
      scale(pose.scale),
      inverse_scale(1 / pose.scale),
      translation(pose.translation),
      axes{rotate(pose.rotation, {1, 0, 0}), rotate(pose.rotation, {0, 1, 0}),
           rotate(pose.rotation, {0, 0, 1})},
      parameters(node.parameters) {}

SceneProgram::SceneProgram(const Scene& scene, const std::vector<int>& roots) {
  std::vector<PlacedLeaf> leaves;
  std::vector<int> steps;
  std::vector<ProgramSlot> slots;
  std::map<int, ProgramSlot> known;
  for (int root : roots) {
    scene.require_node(root, "root");
    const auto [entry, is_new] = known.try_emplace(root);
    ProgramSlot& slot = entry->second;
    if (is_new) {
      const FlatRoot flat = flatten(scene.nodes(), root);
      const auto first_leaf = static_cast<int>(leaves.size());
      slot.first = static_cast<int>(steps.size());
      for (int step : flat.steps) steps.push_back(step >= 0 ? first_leaf + step : step);
      slot.last = static_cast<int>(steps.size());
      for (const FlatRoot::Leaf& leaf : flat.leaves) leaves.emplace_back(scene.nodes()[leaf.node], leaf.pose);
      if (flat.leaves.size() == 1) {
        slot.single_leaf = first_leaf;
        const PlacedLeaf& only = leaves[first_leaf];
        const bool is_centered = norm(only.translation) == 0;
        if (only.opcode == Opcode::Sphere && is_centered)
          slot.centered_sphere_radius = only.scale * only.parameters[0];
      }
    }
    slots.push_back(slot);
  }
  leaves_ = copy_from_host("peclet::SceneProgram::leaves", leaves);
  steps_ = copy_from_host("peclet::SceneProgram::steps", steps);
  slots_ = copy_from_host("peclet::SceneProgram::slots", slots);
}

}  // namespace peclet
