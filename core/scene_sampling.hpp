#pragma once
// Distances of a scene at points and on lattices, from and to host memory.
#include <span>

#include "core/scene.hpp"
#include "core/types.hpp"

namespace peclet {

/// Regular lattice of points origin + (i, j, k) * spacing.
struct Lattice {
  Int3 points{0, 0, 0};
  Vec3 origin, spacing;

  Index size() const { return static_cast<Index>(points[0]) * points[1] * points[2]; }
};

/// Distances at the points (x, y, z triples) in the frame of root. The sizes agree.
void sample_root(const Scene& scene, int root, std::span<const Real> points, std::span<Real> distances);

/// Gradients as well, as triples.
void sample_root(const Scene& scene, int root, std::span<const Real> points, std::span<Real> distances,
                 std::span<Real> gradients);

/// Smallest distance over all instances in the world; far_away if there is none.
void sample_scene(const Scene& scene, std::span<const Real> points, std::span<Real> distances);

/// Distances on a lattice in the frame of root, x fastest.
void sample_root(const Scene& scene, int root, const Lattice& lattice, std::span<float> distances);

}  // namespace peclet
