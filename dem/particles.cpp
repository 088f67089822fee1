#include "dem/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/loop.hpp"
#include "dem/body.hpp"

namespace peclet::dem {
namespace {

void require_count(std::size_t found, Index particles, int columns, const char* argument) {
  require(found == static_cast<std::size_t>(particles * columns), argument,
          std::to_string(particles * columns) + " values for " + std::to_string(particles) + " particles",
          found);
}

void require_all_finite(std::span<const Real> values, const char* argument) {
  for (const Real value : values) require_finite(value, argument);
}

template <class T>
void upload(const Array<T>& target, const T* source, Index count) {
  const Kokkos::View<const T*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host(
      source, static_cast<std::size_t>(count));
  Kokkos::deep_copy(Kokkos::subview(target, std::make_pair(Index{0}, count)), host);
}

const Vec3* as_vectors(std::span<const Real> rows) { return reinterpret_cast<const Vec3*>(rows.data()); }

/// Inverse moment of inertia of a solid sphere, 5 / (2 m r^2).
KOKKOS_INLINE_FUNCTION Real inverse_sphere_inertia(Real inverse_mass, Real radius) {
  return 2.5 * inverse_mass / (radius * radius);
}

void fill_sphere_inertias(const ParticleArrays& particles, Real shape_radius) {
  for_each(
      "dem::fill_sphere_inertias", particles.count, KOKKOS_LAMBDA(Index n) {
        const Real value =
            inverse_sphere_inertia(particles.inverse_mass(n), particles.scale(n) * shape_radius);
        particles.inverse_inertia(n) = {value, value, value};
      });
}

enum class Flaw : int { None, Position, Velocity, AngularVelocity, Orientation, Force, Torque, InverseMass };

constexpr const char* flaw_names[] = {"",
                                      "positions",
                                      "velocities",
                                      "angular_velocities",
                                      "quaternions",
                                      "external_forces",
                                      "external_torques",
                                      "inv_mass"};

KOKKOS_INLINE_FUNCTION Flaw first_flaw(const ParticleArrays& p, Index n) {
  if (!is_finite(p.position(n))) return Flaw::Position;
  if (!is_finite(p.velocity(n))) return Flaw::Velocity;
  if (!is_finite(p.angular_velocity(n))) return Flaw::AngularVelocity;
  const Quaternion q = p.orientation(n);
  if (!is_finite({q.x, q.y, q.z}) || !Kokkos::isfinite(q.w)) return Flaw::Orientation;
  if (!is_finite(p.force(n))) return Flaw::Force;
  if (!is_finite(p.torque(n))) return Flaw::Torque;
  if (!Kokkos::isfinite(p.inverse_mass(n)) || p.inverse_mass(n) < 0) return Flaw::InverseMass;
  return Flaw::None;
}

Flaw worst_flaw(const ParticleArrays& particles) {
  const Real code = max_each(
      "dem::worst_flaw", particles.count,
      KOKKOS_LAMBDA(Index n) { return static_cast<Real>(first_flaw(particles, n)); });
  return static_cast<Flaw>(static_cast<int>(code));
}

}  // namespace

Particles::Particles(Index capacity) {
  require(capacity > 0, "capacity", "a positive number of particles", capacity);
  require(capacity <= std::numeric_limits<int>::max(), "capacity", "at most 2147483647 particles", capacity);
  allocate(capacity);
}

void Particles::allocate(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  ParticleArrays fresh;
  fresh.position = Array<Vec3>("dem.position", n);
  fresh.velocity = Array<Vec3>("dem.velocity", n);
  fresh.angular_velocity = Array<Vec3>("dem.angular_velocity", n);
  fresh.orientation = Array<Quaternion>("dem.orientation", n);
  fresh.force = Array<Vec3>("dem.force", n);
  fresh.torque = Array<Vec3>("dem.torque", n);
  fresh.inverse_mass = Array<Real>("dem.inverse_mass", n);
  fresh.inverse_inertia = Array<Vec3>("dem.inverse_inertia", n);
  fresh.scale = Array<Real>("dem.scale", n);
  fresh.material = Array<int>("dem.material", n);
  arrays_ = fresh;
}

void Particles::set_shape_radius(Real radius) {
  require_positive(radius, "radius");
  shape_radius_ = radius;
  follow_mass_and_radius();
}

void Particles::follow_mass_and_radius() {
  ++revision_;
  if (inertia_follows_ && arrays_.count > 0) fill_sphere_inertias(arrays_, shape_radius_);
}

void Particles::set_positions(std::span<const Real> rows, int columns) {
  require_state(shape_radius_ > 0, "set_positions: give the particles a shape first (set_sphere_shape)");
  require(columns == 3 || columns == 4, "positions", "3 or 4 columns", columns);
  require(rows.size() % static_cast<std::size_t>(columns) == 0, "positions", "whole rows", rows.size());
  require_all_finite(rows, "positions");
  const Index count = static_cast<Index>(rows.size()) / columns;
  require(count <= std::numeric_limits<int>::max(), "positions", "at most 2147483647 rows", count);
  std::vector<Vec3> positions(static_cast<std::size_t>(count));
  std::vector<Real> inverse_masses(static_cast<std::size_t>(count), 1.0);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    const Real* row = rows.data() + n * static_cast<std::size_t>(columns);
    positions[n] = {row[0], row[1], row[2]};
    if (columns == 4) {
      require_non_negative(row[3], "positions[:, 3] (inverse mass)");
      inverse_masses[n] = row[3];
    }
  }
  const bool is_same_number = count == arrays_.count;
  if (count > capacity()) allocate(count);
  arrays_.count = count;
  inertia_follows_ = true;
  upload(arrays_.position, positions.data(), count);
  upload(arrays_.inverse_mass, inverse_masses.data(), count);
  Kokkos::deep_copy(arrays_.velocity, Vec3{});
  Kokkos::deep_copy(arrays_.angular_velocity, Vec3{});
  Kokkos::deep_copy(arrays_.orientation, Quaternion{});
  Kokkos::deep_copy(arrays_.scale, 1.0);
  if (!is_same_number) {
    Kokkos::deep_copy(arrays_.force, Vec3{});
    Kokkos::deep_copy(arrays_.torque, Vec3{});
    Kokkos::deep_copy(arrays_.material, 0);
  }
  follow_mass_and_radius();
}

void Particles::set_velocities(std::span<const Real> rows) {
  require_count(rows.size(), count(), 3, "velocities");
  require_all_finite(rows, "velocities");
  upload(arrays_.velocity, as_vectors(rows), count());
}

void Particles::set_angular_velocities(std::span<const Real> rows) {
  require_count(rows.size(), count(), 3, "angular_velocities");
  require_all_finite(rows, "angular_velocities");
  upload(arrays_.angular_velocity, as_vectors(rows), count());
}

void Particles::set_orientations(std::span<const Real> rows) {
  require_count(rows.size(), count(), 4, "quaternions");
  require_all_finite(rows, "quaternions");
  std::vector<Quaternion> unit(static_cast<std::size_t>(count()));
  for (std::size_t n = 0; n < unit.size(); ++n) {
    const Real* q = rows.data() + 4 * n;
    const Real largest = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
    require(largest > 0, "quaternions", "non-zero quaternions", "zeros in row " + std::to_string(n));
    // one that has unit length already stays as it is, so that what a getter returned can be set again
    const Real square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    unit[n] = std::abs(square - 1) <= 4 * std::numeric_limits<Real>::epsilon()
                  ? Quaternion{q[0], q[1], q[2], q[3]}
                  : normalized(Quaternion{q[0] / largest, q[1] / largest, q[2] / largest, q[3] / largest});
  }
  upload(arrays_.orientation, unit.data(), count());
}

void Particles::set_forces(std::span<const Real> rows) {
  require_count(rows.size(), count(), 3, "forces");
  require_all_finite(rows, "forces");
  upload(arrays_.force, as_vectors(rows), count());
}

void Particles::set_torques(std::span<const Real> rows) {
  require_count(rows.size(), count(), 3, "torques");
  require_all_finite(rows, "torques");
  upload(arrays_.torque, as_vectors(rows), count());
}

void Particles::set_inverse_masses(std::span<const Real> values) {
  require_count(values.size(), count(), 1, "inv_mass");
  for (const Real value : values) require_non_negative(value, "inv_mass");
  upload(arrays_.inverse_mass, values.data(), count());
  follow_mass_and_radius();
}

void Particles::set_inverse_inertias(std::span<const Real> rows) {
  require_count(rows.size(), count(), 3, "inv_inertia");
  for (const Real value : rows) require_non_negative(value, "inv_inertia");
  upload(arrays_.inverse_inertia, as_vectors(rows), count());
  inertia_follows_ = false;
}

void Particles::set_scales(std::span<const Real> values) {
  require_count(values.size(), count(), 1, "scales");
  for (const Real value : values) require_positive(value, "scales");
  upload(arrays_.scale, values.data(), count());
  follow_mass_and_radius();
}

void Particles::set_materials(std::span<const int> ids) {
  require_count(ids.size(), count(), 1, "ids");
  upload(arrays_.material, ids.data(), count());
  ++revision_;
}

Real Particles::largest_radius() const {
  const Array<Real> scale = arrays_.scale;
  return shape_radius_ *
         max_each("dem::largest_scale", arrays_.count, KOKKOS_LAMBDA(Index n) { return scale(n); });
}

void Particles::require_valid_state() const {
  const Flaw flaw = worst_flaw(arrays_);
  require_state(flaw == Flaw::None, std::string(flaw_names[static_cast<int>(flaw)]) +
                                        ": expected finite values (and inv_mass >= 0), found others, written "
                                        "through a view");
}

}  // namespace peclet::dem
