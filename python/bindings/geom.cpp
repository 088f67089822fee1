// peclet.core.geom._geom: SceneBuilder. Every argument is converted here and checked in core/scene.cpp.
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <limits>
#include <string>

#include "core/mass_properties.hpp"
#include "core/scene.hpp"
#include "core/scene_sampling.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/runtime.hpp"

namespace peclet::python {

namespace {

using namespace nb::literals;

Pose to_pose(const Numbers& translation, const Numbers& rotation, double scale) {
  return {to_vec3(translation, "translation"), to_quaternion(rotation, "rotation"), scale};
}

int to_node(const Scene& scene, std::int64_t index, const char* name) {
  scene.require_node(index, name);
  return static_cast<int>(index);
}

int add_leaf(Scene& scene, const std::string& kind, const Numbers& params, const Numbers& translation,
             const Numbers& rotation, double scale) {
  const Input<double> parameters(params, "params", {any_size});
  return scene.add_leaf(kind, parameters.values(), to_pose(translation, rotation, scale));
}

template <int (Scene::*add)(int, int, const Pose&)>
int add_operation(Scene& scene, std::int64_t a, std::int64_t b, const Numbers& translation,
                  const Numbers& rotation, double scale) {
  return (scene.*add)(to_node(scene, a, "a"), to_node(scene, b, "b"), to_pose(translation, rotation, scale));
}

int add_reframed(Scene& scene, std::int64_t root, const Numbers& translation, const Numbers& rotation,
                 double scale) {
  return scene.add_reframed(to_node(scene, root, "root"), to_pose(translation, rotation, scale));
}

/// Three NaN, or None, mean that the centre follows the translation.
void set_center(SceneInstance& instance, const Numbers& center) {
  if (center.is_none()) return;
  const Input<double> c(center, "center", {3});
  if (std::isnan(c[0]) && std::isnan(c[1]) && std::isnan(c[2])) return;
  instance.center = {c[0], c[1], c[2]};
  instance.center_pinned = true;
}

int add_instance(Scene& scene, std::int64_t root, const Numbers& translation, const Numbers& rotation,
                 double scale, const Numbers& lin_vel, const Numbers& ang_vel, const Numbers& center,
                 int material) {
  SceneInstance instance;
  instance.root = to_node(scene, root, "root");
  instance.material = material;
  instance.pose = to_pose(translation, rotation, scale);
  instance.twist = {to_vec3(lin_vel, "lin_vel"), to_vec3(ang_vel, "ang_vel")};
  set_center(instance, center);
  return scene.add_instance(instance);
}

using Encoded =
    std::tuple<NumpyArray<std::int32_t>, NumpyArray<double>, NumpyArray<std::int32_t>, NumpyArray<double>>;

Encoded encode(const Scene& scene) {
  const Scene::Records records = scene.encode();
  return Encoded(to_numpy(records.node_ints), to_numpy(records.node_reals), to_numpy(records.instance_ints),
                 to_numpy(records.instance_reals));
}

Input<double> to_points(const ArrayLike& points) {
  Input<double> input(points, "points", {any_size, 3});
  input.require_finite();
  return input;
}

NumpyArray<double> eval(const Scene& scene, const ArrayLike& points) {
  const Input<double> x = to_points(points);
  Output<double> distances({x.extent(0)});
  {
    const Scene snapshot = scene;  // another thread may change the scene meanwhile
    const nb::gil_scoped_release release;
    sample_scene(snapshot, x.values(), distances.values());
  }
  return distances.release();
}

NumpyArray<double> eval_root(const Scene& scene, std::int64_t root, const ArrayLike& points) {
  const int node = to_node(scene, root, "root");
  const Input<double> x = to_points(points);
  Output<double> distances({x.extent(0)});
  {
    const Scene snapshot = scene;
    const nb::gil_scoped_release release;
    sample_root(snapshot, node, x.values(), distances.values());
  }
  return distances.release();
}

std::pair<NumpyArray<double>, NumpyArray<double>> eval_root_grad(const Scene& scene, std::int64_t root,
                                                                 const ArrayLike& points) {
  const int node = to_node(scene, root, "root");
  const Input<double> x = to_points(points);
  Output<double> distances({x.extent(0)}), gradients({x.extent(0), 3});
  {
    const Scene snapshot = scene;
    const nb::gil_scoped_release release;
    sample_root(snapshot, node, x.values(), distances.values(), gradients.values());
  }
  return {distances.release(), gradients.release()};
}

NumpyArray<float> bake(const Scene& scene, std::int64_t root, const Numbers& origin, const Numbers& spacing,
                       const Integers& dims) {
  const int node = to_node(scene, root, "root");
  Lattice lattice;
  lattice.origin = to_vec3(origin, "origin");
  lattice.spacing = to_vec3(spacing, "spacing");
  const Input<std::int32_t> points(dims, "dims", {3});
  for (int axis = 0; axis < 3; ++axis) {
    require_positive(lattice.spacing[axis], indexed("spacing", axis));
    require(points[axis] >= 1, indexed("dims", axis), "at least 1", points[axis]);
    lattice.points[axis] = points[axis];
  }
  const double size = 1.0 * points[0] * points[1] * points[2];
  require(size <= 4294967296.0, "dims", "at most 2^32 points in all", size);
  Output<float> distances({lattice.size()});
  {
    const Scene snapshot = scene;
    const nb::gil_scoped_release release;
    sample_root(snapshot, node, lattice, distances.values());
  }
  return distances.release();
}

MassProperties measure(const Scene& scene, std::int64_t root, const Numbers& lo, const Numbers& hi, int n,
                       int order, int nseg, double density) {
  const int node = to_node(scene, root, "root");
  const MassSettings settings{to_vec3(lo, "lo"), to_vec3(hi, "hi"), n, order, nseg, density};
  const Scene snapshot = scene;
  const nb::gil_scoped_release release;
  return mass_properties(snapshot, node, settings);
}

NumpyArray<double> to_numpy(const Matrix3& matrix) {
  Output<double> output({3, 3});
  for (std::size_t n = 0; n < 9; ++n) output[n] = matrix[n / 3][n % 3];
  return output.release();
}

nb::dict body_properties(const Scene& scene, std::int64_t root, const Numbers& lo, const Numbers& hi, int n,
                         int order, int nseg, double density) {
  const MassProperties body = measure(scene, root, lo, hi, n, order, nseg, density);
  const Quaternion& q = body.rotation;
  nb::dict properties;
  properties["volume"] = body.volume;
  properties["mass"] = body.mass;
  properties["com"] = python::to_numpy(body.center);
  properties["inertia_tensor"] = to_numpy(body.inertia);
  properties["principal"] = python::to_numpy(body.principal);
  properties["rotation"] = to_numpy(body.axes);
  properties["quat"] = python::to_numpy(std::vector<double>{q.x, q.y, q.z, q.w});
  return properties;
}

std::pair<NumpyArray<double>, NumpyArray<double>> bounds(const Scene& scene, std::int64_t root) {
  const Scene::Bounds box = scene.bounds(to_node(scene, root, "root"));
  return {python::to_numpy(box.low), python::to_numpy(box.high)};
}

Scene decode(const ArrayLike& node_ints, const ArrayLike& node_reals, const ArrayLike& inst_ints,
             const ArrayLike& inst_reals) {
  const Input<std::int32_t> ni(node_ints, "node_ints"), ii(inst_ints, "inst_ints");
  const Input<double> nr(node_reals, "node_reals"), ir(inst_reals, "inst_reals");
  return Scene::decode(ni.values(), nr.values(), ii.values(), ir.values());
}

std::string repr(const Scene& scene) {
  return "SceneBuilder(num_nodes=" + std::to_string(scene.number_of_nodes()) +
         ", num_instances=" + std::to_string(scene.number_of_instances()) + ")";
}

int principal_frame_of(Scene& scene, std::int64_t root, const Numbers& lo, const Numbers& hi, int n,
                       int order, int nseg) {
  const Pose frame = principal_frame(measure(scene, root, lo, hi, n, order, nseg, 1.0));
  return scene.add_reframed(static_cast<int>(root), frame);
}

std::string build_toolchain() {
#if defined(__clang__)
  const std::string compiler = "Clang " __clang_version__;
#else
  const std::string compiler = "GNU " __VERSION__;
#endif
  return compiler + ", Kokkos " + std::to_string(KOKKOS_VERSION / 10000) + "." +
         std::to_string(KOKKOS_VERSION / 100 % 100) + "." + std::to_string(KOKKOS_VERSION % 100) + " " +
         ExecutionSpace::name();
}

}  // namespace

NB_MODULE(_geom, m) {
  start_runtime();
  m.attr("build_toolchain") = build_toolchain();
  const nb::tuple zero = nb::make_tuple(0.0, 0.0, 0.0), identity = nb::make_tuple(0.0, 0.0, 0.0, 1.0);
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const nb::tuple follow = nb::make_tuple(missing, missing, missing);

  nb::class_<Scene>(m, "SceneBuilder", R"(Solids made of signed distances, and the bodies that they form.

Distances are negative inside. Nodes and instances are numbered from 0 in the order in which they are added.
A node at point q has the value scale * f(R^T (q - translation) / scale); rotation is a quaternion (x, y, z, w)
that turns the solid actively and is normalised.)")
      .def(nb::init<>())
      .def("__repr__", &repr)
      .def("add_leaf", &add_leaf, "kind"_a, "params"_a, "translation"_a = zero, "rotation"_a = identity,
           "scale"_a = 1.0,
           R"(Add a primitive solid and return its node index.

======================  ====================================  ===========
kind                    params                                axis
======================  ====================================  ===========
sphere                  radius
hollow_cylinder         outer radius, height, thickness       y
box                     half extents along x, y, z
hollow_cylinder_shell   outer radius, inner radius, height    z
capsule                 radius, half length without the caps  y
torus                   ring radius, tube radius              y
cone                    bottom radius, top radius, half       y
                        height (bottom at -half height)
ellipsoid               semi-axes along x, y, z
superquadric            semi-axes along x, y, z, exponent
======================  ====================================  ===========

All distances are exact but the superquadric's, which is correct to first order near its surface.)")
      .def("add_union", &add_operation<&Scene::add_union>, "a"_a, "b"_a, "translation"_a = zero,
           "rotation"_a = identity, "scale"_a = 1.0, "Add the union of two nodes and return its node index.")
      .def("add_intersection", &add_operation<&Scene::add_intersection>, "a"_a, "b"_a, "translation"_a = zero,
           "rotation"_a = identity, "scale"_a = 1.0,
           "Add the intersection of two nodes and return its node index.")
      .def("add_difference", &add_operation<&Scene::add_difference>, "a"_a, "b"_a, "translation"_a = zero,
           "rotation"_a = identity, "scale"_a = 1.0, "Add a without b and return its node index.")
      .def("add_reframed", &add_reframed, "root"_a, "translation"_a = zero, "rotation"_a = identity,
           "scale"_a = 1.0, "Add a copy of a node, moved by a further transform, and return its node index.")
      .def("add_instance", &add_instance, "root"_a, "translation"_a = zero, "rotation"_a = identity,
           "scale"_a = 1.0, "lin_vel"_a = zero, "ang_vel"_a = zero, "center"_a = follow, "material"_a = -1,
           R"(Place a body made of node root in the world and return its instance index.

Velocities are along world axes; center is the centre of rotation, which follows the translation if it is NaN.)")
      .def("num_nodes", &Scene::number_of_nodes, "Number of nodes.")
      .def("num_instances", &Scene::number_of_instances, "Number of instances.")
      .def("encode", &encode,
           R"(Flat records (node_ints, node_reals, inst_ints, inst_reals), as solvers take them.

Per node 3 integers (opcode, children or -1) and 16 numbers (8 parameters, translation, rotation, scale); per
instance 2 integers (root, material) and 18 numbers (translation, rotation, scale, lin_vel, ang_vel, center,
1 if the centre is pinned).)")
      .def_static("decode", &decode, "node_ints"_a, "node_reals"_a, "inst_ints"_a, "inst_reals"_a,
                  "SceneBuilder from flat records with 17 or 18 numbers per instance.")
      .def("eval", &eval, "points"_a,
           "Distances, shape (N,), of the nearest instance at points of shape (N, 3).")
      .def("eval_root", &eval_root, "root"_a, "points"_a,
           "Distances, shape (N,), of node root at points of shape (N, 3) in its own frame.")
      .def("eval_root_grad", &eval_root_grad, "root"_a, "points"_a,
           "Distances, shape (N,), and their gradients, shape (N, 3), of node root in its own frame.")
      .def("bake", &bake, "root"_a, "origin"_a, "spacing"_a, "dims"_a,
           R"(Distances of node root at the points origin + (i, j, k) * spacing, flat with i fastest.

``bake(...).reshape(dims, order="F")`` has the index [i, j, k].)")
      .def("bounds", &bounds, "root"_a, "Low and high corner of a box around node root in its own frame.")
      .def("body_properties", &body_properties, "root"_a, "lo"_a, "hi"_a, "n"_a = 32, "order"_a = 5,
           "nseg"_a = 8, "density"_a = 1.0, R"(Mass properties of node root in its own frame.

The box from lo to hi must contain the solid. n is the number of cells per axis, order that of Gauss points per
direction of a cell, nseg the number of segments in which a line across a cell is searched for the surface.

Returns volume, mass, com (centre of mass), inertia_tensor (about it), principal (its moments, ascending),
rotation (columns: the principal axes) and quat (the same as a quaternion).)")
      .def(
          "principal_frame", &principal_frame_of, "root"_a, "lo"_a, "hi"_a, "n"_a = 32, "order"_a = 5,
          "nseg"_a = 8,
          R"(Add a copy of node root with its centre of mass at the origin and its principal axes along x, y, z.

Returns the node index; the arguments are those of body_properties.)");
}

}  // namespace peclet::python
