#include "core/mass_properties.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "core/error.hpp"
#include "core/field_transfer.hpp"
#include "core/loop.hpp"
#include "core/scene_program.hpp"
#include "core/scene_sampling.hpp"
#include "core/solid_quadrature.hpp"

namespace peclet {

namespace {

constexpr int maximum_cells = 1024;

/// Nodes by Newton's method on the Legendre polynomial, from Chebyshev-like starting points.
GaussRule gauss_rule(int order) {
  GaussRule rule;
  rule.order = order;
  for (int n = 0; n < order; ++n) {
    Real x = std::cos(std::acos(Real(-1)) * (n + 0.75) / (order + 0.5)), slope = 0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      Real p = 1, previous = 0;
      for (int k = 1; k <= order; ++k) {
        const Real next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = order * (x * p - previous) / (x * x - 1);
      const Real step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    const auto entry = static_cast<std::size_t>(n);
    rule.nodes[entry] = 0.5 * (1 - x);
    rule.weights[entry] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

void require_settings(const MassSettings& s) {
  const char* names = "xyz";
  for (int axis = 0; axis < 3; ++axis) {
    require_finite(s.low[axis], std::string("lo ") + names[axis]);
    require_finite(s.high[axis], std::string("hi ") + names[axis]);
    require(s.low[axis] < s.high[axis], std::string("hi ") + names[axis],
            "more than lo = " + std::to_string(s.low[axis]), s.high[axis]);
  }
  require(s.cells >= 1 && s.cells <= maximum_cells, "n", "1 to " + std::to_string(maximum_cells), s.cells);
  require(s.order >= 1 && s.order <= GaussRule::maximum_order, "order",
          "1 to " + std::to_string(GaussRule::maximum_order), s.order);
  require(s.segments >= 1 && s.segments <= SolidQuadrature::maximum_segments, "nseg",
          "1 to " + std::to_string(SolidQuadrature::maximum_segments), s.segments);
  require_positive(s.density, "density");
}

/// By how much the values of root may exceed the distance to its surface.
Real reach_of(const Scene& scene, int root) {
  Real reach = 1;
  for (const FlatRoot::Leaf& leaf : flatten(scene.nodes(), root).leaves) {
    const SceneNode& node = scene.nodes()[static_cast<std::size_t>(leaf.node)];
    if (node.opcode != static_cast<int>(Opcode::Superquadric)) continue;
    // The depth is at least that of the simplex of the surface points along the axes, which for exponents
    // below one is curved inwards.
    const Real exponent = node.parameters[3];
    reach = std::max(reach, std::sqrt(3.0) * std::pow(3.0, std::max(0.0, 1 / exponent - 1)));
  }
  return reach;
}

[[noreturn]] void reject_box(Vec3 x) {
  std::ostringstream found;
  found << "solid at (" << x.x << ", " << x.y << ", " << x.z << ")";
  require(false, "lo, hi", "a box that contains the whole body", found.str());
  throw std::logic_error("unreachable");
}

/// Throw if a lattice point that is not strictly inside the box lies in the solid.
void require_no_solid(const Scene& scene, int root, const Lattice& lattice, const MassSettings& box) {
  std::vector<float> distances(static_cast<std::size_t>(lattice.size()));
  sample_root(scene, root, lattice, distances);
  const Vec3 size = box.high - box.low;
  const Real touching = 1e-6 * norm(size);  // a body may touch its box
  const Index nx = lattice.points[0], ny = lattice.points[1];
  for (Index n = 0; n < lattice.size(); ++n) {
    if (distances[static_cast<std::size_t>(n)] >= -touching) continue;
    const Index index[3] = {n % nx, n / nx % ny, n / (nx * ny)};
    Vec3 x;
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] = lattice.origin[axis] + static_cast<Real>(index[axis]) * lattice.spacing[axis];
      is_inside = is_inside && x[axis] > box.low[axis] && x[axis] < box.high[axis];
    }
    if (!is_inside) reject_box(x);
  }
}

/// Throw unless the box contains the solid. Where the bounds of the solid stick out of it they may be too
/// large, so the faces and the rest of the bounds are sampled.
void require_solid_inside(const Scene& scene, int root, const Scene::Bounds& bounds,
                          const MassSettings& box) {
  constexpr int face_points = 257, volume_points = 129;
  const Vec3 slack = 1e-9 * (box.high - box.low);
  bool sticks_out = false;
  for (int axis = 0; axis < 3; ++axis)
    sticks_out = sticks_out || bounds.low[axis] < box.low[axis] - slack[axis] ||
                 bounds.high[axis] > box.high[axis] + slack[axis];
  if (!sticks_out) return;
  const auto lattice_over = [](Vec3 low, Vec3 high, int points) {
    return Lattice{{points, points, points}, low, (high - low) / (points - 1)};
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const Vec3& corner : {box.low, box.high}) {
      Lattice face = lattice_over(box.low, box.high, face_points);
      face.points[static_cast<std::size_t>(axis)] = 1;
      face.origin[axis] = corner[axis];
      require_no_solid(scene, root, face, box);
    }
  require_no_solid(scene, root, lattice_over(bounds.low, bounds.high, volume_points), box);
}

/// Moments about the middle of the part of the box that can hold solid.
Moments integrate_cells(const SolidQuadrature& quadrature, Vec3 low, Vec3 high, int cells) {
  const Vec3 h = (high - low) / cells;
  const Index columns = static_cast<Index>(cells) * cells;
  const Array<Moments> partial("core::mass_properties", columns);
  for_each_task(
      "core::mass_properties", columns, KOKKOS_LAMBDA(Index column) {
        const auto j = static_cast<Real>(column % cells), k = static_cast<Real>(column / cells);
        Moments sum;
        for (int i = 0; i < cells; ++i) {
          const Vec3 corner = low + Vec3{i * h.x, j * h.y, k * h.z};
          quadrature.add_cell(corner, corner + h, sum);
        }
        partial(column) = sum;
      });
  Moments total;
  for (const Moments& moments : copy_to_host(partial)) total += moments;
  return total;
}

MassProperties from_moments(const Moments& moments, Real density, Vec3 reference_point) {
  MassProperties result;
  result.volume = moments.volume;
  result.mass = density * moments.volume;
  const Vec3 c = moments.first / moments.volume;
  result.center = reference_point + c;
  // second moments about the centre of mass
  const Vec3 squares = moments.squares - moments.volume * Vec3{c.x * c.x, c.y * c.y, c.z * c.z};
  const Vec3 products = moments.products - moments.volume * Vec3{c.x * c.y, c.y * c.z, c.z * c.x};
  result.inertia = {{{squares.y + squares.z, -products.x, -products.z},
                     {-products.x, squares.z + squares.x, -products.y},
                     {-products.z, -products.y, squares.x + squares.y}}};
  for (auto& row : result.inertia)
    for (Real& entry : row) entry *= density;
  const PrincipalAxes principal = principal_axes(result.inertia);
  result.principal = principal.moments;
  result.axes = principal.axes;
  result.rotation = quaternion_of(principal.axes);
  return result;
}

}  // namespace

MassProperties mass_properties(const Scene& scene, int root, const MassSettings& settings) {
  scene.require_node(root, "root");
  require_settings(settings);
  const Scene::Bounds bounds = scene.bounds(root);
  require(!bounds.is_empty(), "root", "a body with some volume", "an empty intersection");
  require_solid_inside(scene, root, bounds, settings);
  Vec3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(settings.low[axis], bounds.low[axis]);
    high[axis] = std::min(settings.high[axis], bounds.high[axis]);
    require(low[axis] < high[axis], "lo, hi", "a box that contains the body", "a box beside it");
  }
  const Vec3 middle = 0.5 * (low + high);
  SolidQuadrature::Settings quadrature;
  quadrature.rule = gauss_rule(settings.order);
  quadrature.check = gauss_rule(settings.order > 2 ? settings.order - 2 : settings.order + 1);
  quadrature.segments = settings.segments;
  quadrature.reach = reach_of(scene, root);
  quadrature.reference_point = middle;
  const Moments moments = integrate_cells(SolidQuadrature(SceneProgram(scene, {root}), quadrature),
                                          low - middle, high - middle, settings.cells);
  require(moments.volume > 0, "root", "a body with some volume", moments.volume);
  return from_moments(moments, settings.density, middle);
}

Pose principal_frame(const MassProperties& properties) {
  const Quaternion to_principal = conjugate(properties.rotation);
  return {-rotate(to_principal, properties.center), to_principal, 1};
}

}  // namespace peclet
