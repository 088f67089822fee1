#pragma once
// Volume, centre of mass and inertia of a homogeneous solid.
#include <array>

#include "core/rigid_body.hpp"
#include "core/scene.hpp"

namespace peclet {

using Matrix3 = std::array<std::array<Real, 3>, 3>;

struct MassProperties {
  Real volume = 0, mass = 0;
  Vec3 center;          // of mass
  Matrix3 inertia{};    // about the centre of mass
  Vec3 principal;       // moments, ascending
  Matrix3 axes{};       // columns: the principal axes, right-handed
  Quaternion rotation;  // from the principal axes to the frame of the root
};

/// The box low..high must contain the solid; the part of it around the solid is cut into cells.
struct MassSettings {
  Vec3 low, high;
  int cells = 32;    // per axis
  int order = 5;     // Gauss points per direction of a cell
  int segments = 8;  // in which a line across a cell is searched for the surface
  Real density = 1;
};

MassProperties mass_properties(const Scene& scene, int root, const MassSettings& settings);

/// The frame in which the centre of mass is the origin and the principal axes are the axes: the pose to give
/// to Scene::add_reframed.
Pose principal_frame(const MassProperties& properties);

/// Moments and axes of a symmetric matrix: axes^T inertia axes is diagonal. Axes of equal moments stay
/// as close to the coordinate axes as they can.
struct PrincipalAxes {
  Vec3 moments;
  Matrix3 axes{};
};
PrincipalAxes principal_axes(const Matrix3& symmetric);

Quaternion quaternion_of(const Matrix3& rotation);

}  // namespace peclet
