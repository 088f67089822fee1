// peclet.dem._dem: the compiled particles. peclet.dem.Simulation is the documented face of it.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "dem/diagnostics.hpp"
#include "dem/simulation.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/runtime.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using peclet::python::any_size;
using peclet::python::Input;
using peclet::python::Output;
using peclet::python::to_numpy;
using peclet::python::to_quaternion;
using peclet::python::to_vec3;
using peclet::python::view_of;

namespace peclet::dem {
namespace {

using Triple = std::tuple<double, double, double>;

Triple to_tuple(Vec3 v) { return {v.x, v.y, v.z}; }

/// One row of columns per particle, or one number.
Input<double> rows_of(const Simulation& simulation, nb::handle value, const char* name,
                      std::int64_t columns) {
  const std::int64_t count = simulation.particles().count();
  Input<double> input =
      columns == 1 ? Input<double>(value, name, {count}) : Input<double>(value, name, {count, columns});
  input.require_finite();
  return input;
}

void set_positions(Simulation& simulation, nb::handle value) {
  const Input<double> rows(value, "positions");
  const bool is_table = rows.shape().size() == 2 && (rows.extent(1) == 3 || rows.extent(1) == 4);
  require(is_table, "positions", "an array of shape (N, 3) or (N, 4)",
          peclet::python::detail::shape_text(rows.shape()));
  rows.require_finite();
  simulation.particles().set_positions(rows.values(), static_cast<int>(rows.extent(1)));
  simulation.forget_contacts();
}

void set_material_ids(Simulation& simulation, nb::handle value) {
  const Input<std::int32_t> ids(value, "ids", {simulation.particles().count()});
  int largest = 0;
  for (const std::int32_t id : ids.values()) {
    Materials::require_id(id, "ids");
    largest = std::max(largest, id);
  }
  simulation.particles().set_materials(ids.values());
  simulation.materials().include(largest);
}

int add_scene_wall(Simulation& simulation, nb::handle node_ints, nb::handle node_reals, int root, bool invert,
                   double restitution, double friction, double rolling_friction) {
  const Input<std::int32_t> ints(node_ints, "node_ints");
  const Input<double> reals(node_reals, "node_reals");
  reals.require_finite();
  return simulation.walls().add_scene(ints.values(), reals.values(), root, invert, restitution, friction,
                                      rolling_friction);
}

void set_wall_material_id(Simulation& simulation, int wall, int material) {
  Materials::require_id(material, "mat");
  simulation.walls().set_material_id(wall, material);
  simulation.materials().include(material);
}

nb::object wall_distances(const Simulation& simulation, int wall, nb::handle points) {
  const Input<double> rows(points, "points", {any_size, 3});
  return to_numpy(simulation.walls().distances(wall, rows.values()));
}

/// Contacts of the last substep as columns.
nb::dict contacts(const Simulation& simulation) {
  const std::vector<ContactRecord> records = contact_records(simulation);
  const auto count = static_cast<std::int64_t>(records.size());
  Output<std::int32_t> bodies({count, 2}), colors({count});
  Output<double> normals({count, 3}), impulses({count, 3}), gaps({count});
  for (std::size_t n = 0; n < records.size(); ++n) {
    const ContactRecord& record = records[n];
    bodies[2 * n] = record.a;
    bodies[2 * n + 1] = record.b;
    colors[n] = record.color;
    gaps[n] = record.gap;
    for (int axis = 0; axis < 3; ++axis) {
      normals[3 * n + static_cast<std::size_t>(axis)] = record.normal[axis];
      impulses[3 * n + static_cast<std::size_t>(axis)] = record.impulse[axis];
    }
  }
  nb::dict result;
  result["bodies"] = bodies.release();
  result["normal"] = normals.release();
  result["impulse"] = impulses.release();
  result["gap"] = gaps.release();
  result["color"] = colors.release();
  return result;
}

constexpr std::int64_t key_columns = 3, carried_columns = 7;

/// What the next substep takes over: (n, 3) first and second body and image, (n, 7) force, friction, normal.
nb::tuple carried_forces(const Simulation& simulation) {
  const std::vector<CarriedForce> carried = simulation.carried_forces();
  std::vector<std::int32_t> keys;
  std::vector<double> forces;
  for (const CarriedForce& c : carried) {
    keys.insert(keys.end(), {c.key.a, c.key.b, c.key.image});
    forces.insert(forces.end(),
                  {c.force, c.friction.x, c.friction.y, c.friction.z, c.normal.x, c.normal.y, c.normal.z});
  }
  const auto count = static_cast<std::int64_t>(carried.size());
  return nb::make_tuple(to_numpy(keys, {count, key_columns}), to_numpy(forces, {count, carried_columns}));
}

void set_carried_forces(Simulation& simulation, nb::handle contacts, nb::handle forces) {
  const Input<std::int32_t> keys(contacts, "contacts", {any_size, key_columns});
  const Input<double> rows(forces, "forces", {keys.extent(0), carried_columns});
  rows.require_finite();
  std::vector<CarriedForce> carried;
  for (Index n = 0; n < keys.extent(0); ++n) {
    const auto key = [&](Index column) { return keys[n * key_columns + column]; };
    const auto at = [&](Index column) { return rows[n * carried_columns + column]; };
    carried.push_back({{key(0), key(1), key(2)}, at(0), {at(1), at(2), at(3)}, {at(4), at(5), at(6)}});
  }
  simulation.set_carried_forces(std::move(carried));
}

nb::dict report(const Simulation& simulation) {
  const SolverReport& last = simulation.report();
  nb::dict result;
  result["impact_sweeps"] = last.impact_sweeps;
  result["force_sweeps"] = last.force_sweeps;
  result["position_sweeps"] = last.position_sweeps;
  result["velocity_residual"] = last.velocity_residual;
  result["position_residual"] = last.position_residual;
  result["search_seconds"] = last.search_seconds;
  result["velocity_seconds"] = last.velocity_seconds;
  result["position_seconds"] = last.position_seconds;
  return result;
}

using Class = nb::class_<Simulation>;

void define_settings(Class& c) {
  c.def(
      "set_gravity", [](Simulation& s, nb::object g) { s.set_gravity(to_vec3(g, "gravity")); }, "gravity"_a);
  c.def(
      "set_domain",
      [](Simulation& s, nb::object origin, nb::object extent) {
        s.set_domain(to_vec3(origin, "origin"), to_vec3(extent, "extent"));
      },
      "origin"_a, "extent"_a);
  c.def("set_periodic", &Simulation::set_periodic, "x"_a, "y"_a, "z"_a);
  c.def(
      "set_iterations", [](Simulation& s, int pos, int vel) { s.set_iterations({pos, vel}); }, "pos"_a,
      "vel"_a);
  c.def(
      "set_default_material",
      [](Simulation& s, double normal, double tangential, double friction, double rolling_friction) {
        s.materials().set_default({normal, tangential, friction, rolling_friction});
      },
      "restitution_normal"_a, "restitution_tangent"_a, "friction"_a, "rolling_friction"_a);
  c.def(
      "set_pair_material",
      [](Simulation& s, int a, int b, double restitution, double friction, double rolling_friction) {
        s.materials().set_pair(a, b, restitution, friction, rolling_friction);
      },
      "a"_a, "b"_a, "restitution"_a, "friction"_a, "rolling_friction"_a);
  c.def(
      "set_elastic_material",
      [](Simulation& s, int mat, double youngs, double poisson) {
        s.materials().set_elastic(mat, {youngs, poisson});
      },
      "mat"_a, "youngs"_a, "poisson"_a);
  c.def_prop_ro("gravity", [](const Simulation& s) { return to_tuple(s.gravity()); });
  c.def_prop_ro("origin", [](const Simulation& s) { return to_tuple(s.domain().origin); });
  c.def_prop_ro("extent", [](const Simulation& s) { return to_tuple(s.domain().extent); });
  c.def_prop_ro("periodic", [](const Simulation& s) {
    const auto& p = s.domain().periodic;
    return std::tuple<bool, bool, bool>(p[0], p[1], p[2]);
  });
  c.def_prop_ro("iterations", [](const Simulation& s) {
    return std::pair<int, int>(s.iterations().position, s.iterations().velocity);
  });
}

template <class Setter>
void define_rows(Class& c, const char* name, const char* argument, std::int64_t columns, Setter setter) {
  c.def(
      name,
      [=](Simulation& s, nb::object value) {
        const Input<double> rows = rows_of(s, value, argument, columns);
        (s.particles().*setter)(rows.values());
      },
      nb::arg(argument));
}

void define_particles(Class& c) {
  c.def(
      "set_shape_radius", [](Simulation& s, double radius) { s.particles().set_shape_radius(radius); },
      "radius"_a);
  c.def("set_positions", [](Simulation& s, nb::object rows) { set_positions(s, rows); }, "positions"_a);
  define_rows(c, "set_velocities", "velocities", 3, &Particles::set_velocities);
  define_rows(c, "set_angular_velocities", "angular_velocities", 3, &Particles::set_angular_velocities);
  define_rows(c, "set_quaternions", "quaternions", 4, &Particles::set_orientations);
  define_rows(c, "set_external_forces", "forces", 3, &Particles::set_forces);
  define_rows(c, "set_external_torques", "torques", 3, &Particles::set_torques);
  define_rows(c, "set_inv_mass", "inv_mass", 1, &Particles::set_inverse_masses);
  define_rows(c, "set_inv_inertia", "inv_inertia", 3, &Particles::set_inverse_inertias);
  define_rows(c, "set_scales", "scales", 1, &Particles::set_scales);
  c.def("set_material_ids", [](Simulation& s, nb::object ids) { set_material_ids(s, ids); }, "ids"_a);
  c.def_prop_ro("count", [](const Simulation& s) { return s.particles().count(); });
  c.def_prop_ro("capacity", [](const Simulation& s) { return s.particles().capacity(); });
  c.def_prop_ro("shape_radius", [](const Simulation& s) { return s.particles().shape_radius(); });
}

/// get_<name>: a copy; <name>_view: the memory itself.
template <class T>
void define_array(Class& c, const std::string& name, Array<T> ParticleArrays::*member) {
  c.def(("get_" + name).c_str(),
        [=](const Simulation& s) { return to_numpy(s.particles().arrays().*member, s.particles().count()); });
  c.def((name + "_view").c_str(),
        [=](const Simulation& s) { return view_of(s.particles().arrays().*member, s.particles().count()); });
}

void define_arrays(Class& c) {
  define_array(c, "positions", &ParticleArrays::position);
  define_array(c, "velocities", &ParticleArrays::velocity);
  define_array(c, "angular_velocities", &ParticleArrays::angular_velocity);
  define_array(c, "quaternions", &ParticleArrays::orientation);
  define_array(c, "external_forces", &ParticleArrays::force);
  define_array(c, "external_torques", &ParticleArrays::torque);
  define_array(c, "inv_mass", &ParticleArrays::inverse_mass);
  define_array(c, "inv_inertia", &ParticleArrays::inverse_inertia);
  define_array(c, "scales", &ParticleArrays::scale);
}

void define_walls(Class& c) {
  c.def(
      "add_plane",
      [](Simulation& s, nb::object point, nb::object normal) {
        s.walls().add_plane(to_vec3(point, "point"), to_vec3(normal, "normal"));
      },
      "point"_a, "normal"_a);
  c.def(
      "add_scene_wall",
      [](Simulation& s, nb::object node_ints, nb::object node_reals, int root, bool invert,
         double restitution, double friction, double rolling_friction) {
        return add_scene_wall(s, node_ints, node_reals, root, invert, restitution, friction,
                              rolling_friction);
      },
      "node_ints"_a, "node_reals"_a, "root"_a, "invert"_a, "restitution"_a, "friction"_a,
      "rolling_friction"_a);
  c.def(
      "set_wall_transform",
      [](Simulation& s, int wall, nb::object translation, nb::object quat) {
        s.walls().set_transform(wall, to_vec3(translation, "translation"), to_quaternion(quat, "quat"));
      },
      "wall_index"_a, "translation"_a, "quat"_a);
  c.def(
      "set_wall_velocity",
      [](Simulation& s, int wall, nb::object linear, nb::object angular, nb::object center) {
        s.walls().set_velocity(wall, {to_vec3(linear, "lin_vel"), to_vec3(angular, "ang_vel")},
                               to_vec3(center, "center"));
      },
      "wall_index"_a, "lin_vel"_a, "ang_vel"_a, "center"_a);
  c.def(
      "set_wall_material_id", [](Simulation& s, int wall, int mat) { set_wall_material_id(s, wall, mat); },
      "wid"_a, "mat"_a);
  c.def(
      "wall_distances",
      [](const Simulation& s, int wall, nb::object points) { return wall_distances(s, wall, points); },
      "wall_index"_a, "points"_a);
}

void define_motion(Class& c) {
  c.def("step", &Simulation::step, "dt"_a, nb::call_guard<nb::gil_scoped_release>());
  c.def("step_hertz", &Simulation::step_hertz, "dt"_a, "substeps"_a, "skin_frac"_a,
        nb::call_guard<nb::gil_scoped_release>());
  c.def("soft_time_scales", [](const Simulation& s) {
    const SoftTimeScales scales = s.soft_time_scales();
    return std::pair<double, double>(scales.rayleigh, scales.impact);
  });
  c.def("relax", &Simulation::relax, "n"_a, nb::call_guard<nb::gil_scoped_release>());
  c.def_prop_ro("time", &Simulation::time);
  c.def("census", [](const Simulation& s) {
    const ContactCensus census = s.census();
    return std::pair<Index, double>(census.number_of_contacts, census.largest_overlap);
  });
  c.def("contacts", [](const Simulation& s) { return contacts(s); });
  c.def("carried_forces", [](const Simulation& s) { return carried_forces(s); });
  c.def(
      "set_carried_forces",
      [](Simulation& s, nb::object contacts, nb::object forces) { set_carried_forces(s, contacts, forces); },
      "contacts"_a, "forces"_a);
  c.def("report", [](const Simulation& s) { return report(s); });
  c.def("coloring_conflicts", [](const Simulation& s) { return coloring_conflicts(s); });
}

}  // namespace
}  // namespace peclet::dem

NB_MODULE(_dem, m) {
  using namespace peclet::dem;
  peclet::python::start_runtime();
  m.attr("execution_space") = peclet::ExecutionSpace::name();
  Class simulation(m, "Simulation");
  simulation.def(nb::init<peclet::Index>(), "capacity"_a);
  define_settings(simulation);
  define_particles(simulation);
  define_arrays(simulation);
  define_walls(simulation);
  define_motion(simulation);
}
