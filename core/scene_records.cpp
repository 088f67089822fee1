// Flat records of a scene: writing, and reading with every check.
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/scene.hpp"
#include "core/scene_checks.hpp"
#include "core/scene_leaves.hpp"

namespace peclet {

namespace {

constexpr std::size_t parameters_per_node = 8;

Vec3 vector_at(const Real* r) { return {r[0], r[1], r[2]}; }
Pose pose_at(const Real* r) { return {vector_at(r), {r[3], r[4], r[5], r[6]}, r[7]}; }

void append(std::vector<Real>& reals, Vec3 v) { reals.insert(reals.end(), {v.x, v.y, v.z}); }
void append(std::vector<Real>& reals, const Pose& pose) {
  append(reals, pose.translation);
  const Quaternion& q = pose.rotation;
  reals.insert(reals.end(), {q.x, q.y, q.z, q.w, pose.scale});
}

bool is_operation(int opcode) {
  return opcode >= static_cast<int>(Opcode::Union) && opcode <= static_cast<int>(Opcode::Difference);
}

SceneNode read_node(int index, int number_of_nodes, const int* ints, const Real* reals) {
  const std::string subject = "node " + std::to_string(index) + ": ";
  SceneNode node;
  node.opcode = ints[0];
  node.pose = checked(pose_at(reals + parameters_per_node), subject);
  for (std::size_t n = 0; n < parameters_per_node; ++n) node.parameters[n] = reals[n];
  if (is_operation(node.opcode)) {
    node.left = ints[1];
    node.right = ints[2];
    for (int child : {node.left, node.right})
      require(child >= 0 && child < number_of_nodes, subject + "child",
              "a node index from 0 to " + std::to_string(number_of_nodes - 1), child);
    return node;
  }
  const LeafKind* kind = leaf_kind(node.opcode);
  require(kind != nullptr, subject + "opcode", "1 to 9 (leaves) or 32 to 34 (operations)", node.opcode);
  require(ints[1] == -1 && ints[2] == -1, subject + "children", "-1 and -1 for a leaf",
          std::to_string(ints[1]) + " and " + std::to_string(ints[2]));
  const auto used = static_cast<std::size_t>(kind->number_of_parameters);
  require_valid_leaf(*kind, {reals, used}, subject + "parameters");
  for (std::size_t n = used; n < parameters_per_node; ++n)
    require(reals[n] == 0, subject + "parameters",
            "0 after the " + std::to_string(used) + " parameters of " + kind->name, reals[n]);
  return node;
}

/// Columns 14-16, and 17 where there is one.
void read_center(SceneInstance& instance, const Real* reals, int columns, const std::string& subject) {
  const Vec3 center = vector_at(reals + 14);
  const int missing = std::isnan(center.x) + std::isnan(center.y) + std::isnan(center.z);
  require(missing == 0 || missing == 3, subject + "center", "three numbers or three NaN",
          std::to_string(missing) + " NaN");
  if (columns == Scene::reals_per_instance) {
    const Real pinned = reals[17];
    require(pinned == 0 || pinned == 1, subject + "column 17", "1 (centre pinned) or 0", pinned);
    instance.center_pinned = pinned == 1;
    require(!instance.center_pinned || missing == 0, subject + "center", "three numbers for a pinned centre",
            "NaN");
  } else {
    instance.center_pinned = missing == 0 && (center.x != 0 || center.y != 0 || center.z != 0);
  }
  if (instance.center_pinned) instance.center = center;
}

SceneInstance read_instance(int index, const Scene& scene, const int* ints, const Real* reals, int columns) {
  const std::string subject = "instance " + std::to_string(index) + ": ";
  scene.require_node(ints[0], subject + "root");
  SceneInstance instance;
  instance.root = ints[0];
  instance.material = ints[1];
  instance.pose = pose_at(reals);
  instance.twist = {vector_at(reals + 8), vector_at(reals + 11)};
  read_center(instance, reals, columns, subject);
  return checked(instance, subject, true);
}

/// Throws if a node is, through its children, its own child.
void require_acyclic(const std::vector<SceneNode>& nodes) {
  enum State : char { Unseen, Open, Done };
  std::vector<char> state(nodes.size(), Unseen);
  std::vector<int> pending;
  for (int start = 0; start < static_cast<int>(nodes.size()); ++start) {
    pending.push_back(start);
    while (!pending.empty()) {
      const int n = pending.back();
      if (state[n] != Unseen) {
        state[n] = Done;
        pending.pop_back();
        continue;
      }
      state[n] = Open;
      for (int child : {nodes[n].left, nodes[n].right}) {
        if (child < 0 || state[child] == Done) continue;
        require(state[child] != Open, "node " + std::to_string(n) + ": child",
                "a node that does not contain this one", child);
        pending.push_back(child);
      }
    }
  }
}

}  // namespace

Scene::Records Scene::encode() const {
  Records records;
  for (const SceneNode& node : nodes_) {
    records.node_ints.insert(records.node_ints.end(), {node.opcode, node.left, node.right});
    for (std::size_t n = 0; n < parameters_per_node; ++n) records.node_reals.push_back(node.parameters[n]);
    append(records.node_reals, node.pose);
  }
  constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
  for (const SceneInstance& instance : instances_) {
    records.instance_ints.insert(records.instance_ints.end(), {instance.root, instance.material});
    append(records.instance_reals, instance.pose);
    append(records.instance_reals, instance.twist.linear);
    append(records.instance_reals, instance.twist.angular);
    append(records.instance_reals, instance.center_pinned ? instance.center : Vec3{nan, nan, nan});
    records.instance_reals.push_back(instance.center_pinned ? 1 : 0);
  }
  return records;
}

Scene Scene::decode(std::span<const int> node_ints, std::span<const Real> node_reals,
                    std::span<const int> instance_ints, std::span<const Real> instance_reals) {
  require(node_ints.size() % ints_per_node == 0, "node_ints", "3 integers per node", node_ints.size());
  const auto number_of_nodes = static_cast<int>(node_ints.size() / ints_per_node);
  require(node_reals.size() == static_cast<std::size_t>(number_of_nodes) * reals_per_node, "node_reals",
          "16 numbers for each of " + std::to_string(number_of_nodes) + " nodes", node_reals.size());
  require(instance_ints.size() % ints_per_instance == 0, "instance_ints", "2 integers per instance",
          instance_ints.size());
  const auto number_of_instances = static_cast<int>(instance_ints.size() / ints_per_instance);
  const std::size_t columns = number_of_instances > 0 ? instance_reals.size() / number_of_instances : 18;
  require((columns == 17 || columns == 18) && instance_reals.size() == columns * number_of_instances,
          "instance_reals",
          "17 or 18 numbers for each of " + std::to_string(number_of_instances) + " instances",
          instance_reals.size());
  Scene scene;
  for (int n = 0; n < number_of_nodes; ++n)
    scene.nodes_.push_back(
        read_node(n, number_of_nodes, &node_ints[n * ints_per_node], &node_reals[n * reals_per_node]));
  require_acyclic(scene.nodes_);
  for (int n = 0; n < number_of_instances; ++n)
    scene.instances_.push_back(read_instance(n, scene, &instance_ints[n * ints_per_instance],
                                             &instance_reals[n * columns], static_cast<int>(columns)));
  return scene;
}

}  // namespace peclet
