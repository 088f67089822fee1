#pragma once
// State of all particles: spheres with individual radii, masses and inertias.
#include <span>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet::dem {

/// Copied by value into kernels. Arrays are as long as the capacity; the first count entries count.
struct ParticleArrays {
  Index count = 0;
  Array<Vec3> position, velocity, angular_velocity;  // along world axes
  Array<Quaternion> orientation;
  Array<Vec3> force, torque;    // external, along world axes
  Array<Real> inverse_mass;     // 0: fixed, moves with its own velocity only
  Array<Vec3> inverse_inertia;  // diagonal, along body axes; 0: no torque turns it about that axis
  Array<Real> scale;            // radius = scale * radius of the shape
  Array<int> material;
};

/// Force and torque on each particle, along world axes.
struct ParticleLoads {
  Array<Vec3> force, torque;
};

class Particles {
 public:
  /// Storage for capacity particles; it grows when set_positions brings more.
  explicit Particles(Index capacity);

  /// Inverse inertias follow, unless set_inverse_inertias was called.
  void set_shape_radius(Real radius);
  Real shape_radius() const { return shape_radius_; }

  /// x, y, z (and, with four columns, inverse mass) of each particle, row after row. Sets the number of
  /// particles; all else goes back to its default, except that forces and torques stay if the number does.
  void set_positions(std::span<const Real> rows, int columns);

  void set_velocities(std::span<const Real> rows);
  void set_angular_velocities(std::span<const Real> rows);
  /// Any non-zero quaternions (x, y, z, w); stored normalised.
  void set_orientations(std::span<const Real> rows);
  void set_forces(std::span<const Real> rows);
  void set_torques(std::span<const Real> rows);
  /// Inverse inertias follow (2 / (5 m r^2)), unless set_inverse_inertias was called.
  void set_inverse_masses(std::span<const Real> values);
  void set_inverse_inertias(std::span<const Real> rows);
  void set_scales(std::span<const Real> values);
  void set_materials(std::span<const int> ids);

  Index count() const { return arrays_.count; }
  Index capacity() const { return static_cast<Index>(arrays_.position.extent(0)); }
  const ParticleArrays& arrays() const { return arrays_; }
  /// Radius of the largest particle.
  Real largest_radius() const;
  /// Throws std::runtime_error naming the first array that holds what the setters would refuse: arrays
  /// can be written through views.
  void require_valid_state() const;
  /// Changes with the number, radii, masses and materials of the particles.
  int revision() const { return revision_; }

 private:
  void allocate(Index capacity);
  void follow_mass_and_radius();

  ParticleArrays arrays_;
  Real shape_radius_ = 0;  // 0: no shape yet
  bool inertia_follows_ = true;
  int revision_ = 0;
};

}  // namespace peclet::dem
