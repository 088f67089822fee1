#include "core/scene_leaves.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"

namespace peclet {

namespace {

constexpr std::array<LeafKind, 9> kinds{{
    {"sphere", Opcode::Sphere, 1, "radius"},
    {"hollow_cylinder", Opcode::HollowCylinder, 3, "outer radius, height, thickness"},
    {"box", Opcode::Box, 3, "half extents along x, y, z"},
    {"hollow_cylinder_shell", Opcode::HollowCylinderShell, 3, "outer radius, inner radius, height"},
    {"capsule", Opcode::Capsule, 2, "radius, half length"},
    {"torus", Opcode::Torus, 2, "ring radius, tube radius"},
    {"cone", Opcode::Cone, 3, "bottom radius, top radius, half height"},
    {"ellipsoid", Opcode::Ellipsoid, 3, "semi-axes along x, y, z"},
    {"superquadric", Opcode::Superquadric, 4, "semi-axes along x, y, z, exponent"},
}};

/// Parameters that may be zero: the inner radius of a shell, the half length of a capsule, the radii of a
/// cone (not both).
bool may_vanish(Opcode opcode, int parameter) {
  return (opcode == Opcode::HollowCylinderShell && parameter == 1) ||
         (opcode == Opcode::Capsule && parameter == 1) || (opcode == Opcode::Cone && parameter <= 1);
}

}  // namespace

std::span<const LeafKind> leaf_kinds() { return kinds; }

const LeafKind& leaf_kind(const std::string& name) {
  std::string names;
  for (const LeafKind& kind : kinds) {
    if (name == kind.name) return kind;
    names += (names.empty() ? "'" : ", '") + std::string(kind.name) + "'";
  }
  throw std::invalid_argument("kind: expected one of " + names + ", found '" + name + "'");
}

const LeafKind* leaf_kind(int opcode) {
  for (const LeafKind& kind : kinds)
    if (static_cast<int>(kind.opcode) == opcode) return &kind;
  return nullptr;
}

void require_valid_leaf(const LeafKind& kind, std::span<const Real> p, const std::string& argument) {
  const std::string subject = argument + " of " + kind.name + " (" + kind.parameters + ")";
  require(p.size() == static_cast<std::size_t>(kind.number_of_parameters), subject,
          std::to_string(kind.number_of_parameters) + " numbers", p.size());
  for (int n = 0; n < kind.number_of_parameters; ++n) {
    const std::string entry = subject + "[" + std::to_string(n) + "]";
    if (may_vanish(kind.opcode, n))
      require_non_negative(p[n], entry);
    else
      require_positive(p[n], entry);
  }
  switch (kind.opcode) {
    case Opcode::HollowCylinder:
      return require(p[2] <= p[0], subject, "a thickness of at most the outer radius", p[2]);
    case Opcode::HollowCylinderShell:
      return require(p[1] < p[0], subject, "an inner radius below the outer radius", p[1]);
    case Opcode::Cone:
      return require(p[0] > 0 || p[1] > 0, subject, "at least one positive radius", "two zeros");
    default:
      return;
  }
}

Real leaf_support(Opcode opcode, const Kokkos::Array<Real, 8>& p, Vec3 n) {
  const auto across = [](Real axial) { return std::sqrt(std::max(Real(0), 1 - axial * axial)); };
  switch (opcode) {
    case Opcode::Sphere:
      return p[0];
    case Opcode::HollowCylinder:
      return p[0] * across(n.y) + 0.5 * p[1] * std::abs(n.y);
    case Opcode::Box:
      return p[0] * std::abs(n.x) + p[1] * std::abs(n.y) + p[2] * std::abs(n.z);
    case Opcode::HollowCylinderShell:
      return p[0] * across(n.z) + 0.5 * p[2] * std::abs(n.z);
    case Opcode::Capsule:
      return p[0] + p[1] * std::abs(n.y);
    case Opcode::Torus:
      return p[0] * across(n.y) + p[1];
    case Opcode::Cone:
      return std::max(p[0] * across(n.y) - p[2] * n.y, p[1] * across(n.y) + p[2] * n.y);
    case Opcode::Ellipsoid:
      return norm(Vec3{p[0] * n.x, p[1] * n.y, p[2] * n.z});
    case Opcode::Superquadric: {
      const Vec3 reach{p[0] * std::abs(n.x), p[1] * std::abs(n.y), p[2] * std::abs(n.z)};
      const Real largest = std::max({reach.x, reach.y, reach.z});
      if (p[3] <= 1) return largest;
      const Real dual = p[3] / (p[3] - 1);  // the dual of the e-norm is the norm with 1/e + 1/dual = 1
      Real sum = 0;
      for (int a = 0; a < 3; ++a) sum += std::pow(reach[a] / largest, dual);
      return largest * std::pow(sum, 1 / dual);
    }
    default:
      throw std::logic_error("leaf_support: not a leaf");
  }
}

Scene::Bounds leaf_bounds(Opcode opcode, const Kokkos::Array<Real, 8>& parameters, const Pose& pose) {
  Scene::Bounds box;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 up;
    up[axis] = 1;
    const Vec3 direction = rotate_back(pose.rotation, up);
    box.low[axis] = pose.translation[axis] - pose.scale * leaf_support(opcode, parameters, -direction);
    box.high[axis] = pose.translation[axis] + pose.scale * leaf_support(opcode, parameters, direction);
  }
  return box;
}

}  // namespace peclet
