#pragma once
// Small helpers for tests of particles: states on the host.
#include <random>
#include <vector>

#include "dem/simulation.hpp"

namespace peclet::dem::testing {

inline std::span<const Real> flat(const std::vector<Vec3>& rows) {
  return {reinterpret_cast<const Real*>(rows.data()), 3 * rows.size()};
}

template <class T>
std::vector<T> on_host(const Array<T>& array, Index count) {
  std::vector<T> values(static_cast<std::size_t>(count));
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, array);
  for (std::size_t n = 0; n < values.size(); ++n) values[n] = mirror(n);
  return values;
}

inline std::vector<Vec3> positions(const Simulation& s) {
  return on_host(s.particles().arrays().position, s.particles().count());
}

inline std::vector<Vec3> velocities(const Simulation& s) {
  return on_host(s.particles().arrays().velocity, s.particles().count());
}

inline std::vector<Vec3> random_vectors(int count, Vec3 low, Vec3 high, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<Real> uniform(0, 1);
  std::vector<Vec3> rows(static_cast<std::size_t>(count));
  for (Vec3& row : rows)
    for (int axis = 0; axis < 3; ++axis)
      row[axis] = low[axis] + (high[axis] - low[axis]) * uniform(generator);
  return rows;
}

inline Simulation spheres(const std::vector<Vec3>& at, Real radius) {
  Simulation simulation(1);
  simulation.particles().set_shape_radius(radius);
  simulation.particles().set_positions(flat(at), 3);
  return simulation;
}

}  // namespace peclet::dem::testing
