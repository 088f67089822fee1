#pragma once
// Codes of the nodes of a scene and the set operations on signed distances (negative inside).
#include "core/sdf_dual.hpp"
#include "core/types.hpp"

namespace peclet {

enum class Opcode : int {
  Sphere = 1,
  HollowCylinder = 2,
  Box = 3,
  HollowCylinderShell = 4,
  Capsule = 5,
  Torus = 6,
  Cone = 7,
  Ellipsoid = 8,
  Superquadric = 9,
  Union = 32,
  Intersection = 33,
  Difference = 34,
};

namespace sdf {

template <class T>
KOKKOS_INLINE_FUNCTION T unite(T a, T b) {
  return smaller(a, b);
}

template <class T>
KOKKOS_INLINE_FUNCTION T intersect(T a, T b) {
  return larger(a, b);
}

/// a without b
template <class T>
KOKKOS_INLINE_FUNCTION T subtract(T a, T b) {
  return larger(a, -b);
}

}  // namespace sdf
}  // namespace peclet
