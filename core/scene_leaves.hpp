#pragma once
// The nine kinds of leaves: names, parameters, their checks and their extents.
#include <span>
#include <string>

#include "core/rigid_body.hpp"
#include "core/scene.hpp"
#include "core/sdf_operations.hpp"

namespace peclet {

struct LeafKind {
  const char* name;
  Opcode opcode;
  int number_of_parameters;
  const char* parameters;  // for messages
};

std::span<const LeafKind> leaf_kinds();
/// Throws and lists the kinds if there is none of this name.
const LeafKind& leaf_kind(const std::string& name);
/// nullptr if the code is not that of a leaf.
const LeafKind* leaf_kind(int opcode);

/// Throws unless the parameters make a solid.
void require_valid_leaf(const LeafKind& kind, std::span<const Real> parameters, const std::string& argument);

/// Largest coordinate along the unit vector direction of the leaf in its own frame.
Real leaf_support(Opcode opcode, const Kokkos::Array<Real, 8>& parameters, Vec3 direction);

/// Smallest axis-aligned box around the placed leaf.
Scene::Bounds leaf_bounds(Opcode opcode, const Kokkos::Array<Real, 8>& parameters, const Pose& pose);

}  // namespace peclet
