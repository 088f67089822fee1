// peclet.flow._flow: the compiled solver. peclet.flow.Solver is the documented face of it.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <limits>

#include "flow/solver.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/flow_checkpoint.hpp"
#include "python/bindings/flow_scalars.hpp"
#include "python/bindings/runtime.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using peclet::python::Input;
using peclet::python::Output;
using peclet::python::to_numpy;

namespace peclet::flow {
namespace {

Grid make_grid(const std::array<int, 3>& cells, const std::array<double, 3>& spacing,
               const std::array<double, 3>& origin) {
  Grid grid;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    require(cells[n] >= 1, "cells", "at least one cell per axis", cells[n]);
    require_positive(spacing[n], "spacing");
    require_finite(origin[n], "origin");
    grid.cells[a] = cells[n];
    grid.spacing[a] = spacing[n];
    grid.origin[a] = origin[n];
  }
  return grid;
}

int checked_body(const Solver& solver, int body) {
  if (body < 0 || body >= solver.number_of_bodies())
    throw std::out_of_range("instance: expected an index from 0 to " +
                            std::to_string(solver.number_of_bodies() - 1) + ", found " +
                            std::to_string(body));
  return body;
}

/// Copies one settings value in, checks and all.
template <class Change>
void change(Solver& solver, const Change& apply) {
  Settings settings = solver.settings();
  apply(settings);
  solver.change_settings(settings);
}

void set_scene(Solver& solver, nb::handle node_ints, nb::handle node_reals, nb::handle instance_ints,
               nb::handle instance_reals, bool periodic) {
  const Input<std::int32_t> ni(node_ints, "node_ints"), ii(instance_ints, "instance_ints");
  const Input<double> nr(node_reals, "node_reals"), ir(instance_reals, "instance_reals");
  solver.set_scene(Scene::decode(ni.values(), nr.values(), ii.values(), ir.values()), periodic);
}

/// (2, n, 3): force and torque on every body.
nb::object loads(const Solver& solver) {
  const auto& loads = solver.loads();
  Output<double> result({2, static_cast<std::int64_t>(loads.size()), 3});
  for (std::size_t b = 0; b < loads.size(); ++b)
    for (int a = 0; a < 3; ++a) {
      result[3 * b + static_cast<std::size_t>(a)] = loads[b].force[a];
      result[3 * (loads.size() + b) + static_cast<std::size_t>(a)] = loads[b].torque[a];
    }
  return result.release();
}

nb::object load_share(const Solver& solver, Vec3 BodyLoad::*share) {
  const auto& loads = solver.loads();
  Output<double> result({static_cast<std::int64_t>(loads.size()), 3});
  for (std::size_t b = 0; b < loads.size(); ++b)
    for (int a = 0; a < 3; ++a) result[3 * b + static_cast<std::size_t>(a)] = (loads[b].*share)[a];
  return result.release();
}

const Field<Real>& component(const Solver& solver, int c) {
  require(c >= 0 && c < 3, "c", "a component 0, 1 or 2", c);
  return solver.velocity()[c];
}

/// Zero at solid points, where the solver keeps the velocity of the body; with_slits: those that carry mass
/// are shown.
nb::object velocity(const Solver& solver, int c, bool with_slits) {
  const Int3 n = solver.grid().cells;
  Output<double> result({n[0], n[1], n[2]}, python::Order::Fortran);
  std::vector<OpenFraction> open(result.size());
  copy_to_host(component(solver, c), result.data());
  copy_to_host(solver.open()[c], open.data());
  const std::size_t steps[3] = {1, static_cast<std::size_t>(n[0]), static_cast<std::size_t>(n[0] * n[1])};
  const auto is_on_side = [&](std::size_t i) {
    return !solver.requested_sides().is_periodic(c) && i / steps[c] % static_cast<std::size_t>(n[c]) == 0;
  };
  for (std::size_t i = 0; i < open.size(); ++i)
    if (!is_fluid(open[i]) && !(with_slits && is_slit(open[i])) && !is_on_side(i)) result[i] = 0;
  return result.release();
}

nb::object open_fraction(const Solver& solver, int axis) {
  require(axis >= 0 && axis < 3, "axis", "an axis 0, 1 or 2", axis);
  const Int3 n = solver.grid().cells;
  Output<double> result({n[0], n[1], n[2]}, python::Order::Fortran);
  std::vector<OpenFraction> open(result.size());
  copy_to_host(solver.open()[axis], open.data());
  for (std::size_t i = 0; i < open.size(); ++i) result[i] = open[i] * open_fraction_unit;
  return result.release();
}

nb::tuple distance_and_owner(Solver& solver) {
  const Layout layout(solver.grid().cells);
  const Field<Real> distance("flow::distance", layout);
  const Field<int> owner("flow::nearest_body", layout);
  solver.sample_distance(distance, owner);
  return nb::make_tuple(to_numpy(distance), to_numpy(owner));
}

void set_sampled_solid(Solver& solver, nb::handle distance) {
  const Field<Real> samples("flow::samples", Layout(solver.grid().cells));
  python::assign(samples, distance, "sdf");
  solver.set_sampled_solid(samples);
}

nb::dict times(const Solver& solver) {
  nb::dict result;
  const StepTimes& t = solver.times();
  result["geometry"] = t.geometry;
  result["momentum"] = t.momentum;
  result["viscous"] = t.viscous;
  result["pressure"] = t.pressure;
  result["loads"] = t.loads;
  result["rest"] = t.rest;
  return result;
}

nb::dict report(const SolverReport& report) {
  nb::dict result;
  result["iterations"] = report.iterations;
  result["residual"] = report.residual;
  result["converged"] = report.converged;
  return result;
}

template <bool Settings::*flag>
void define_flag(nb::class_<Solver>& solver, const char* name) {
  solver.def_prop_rw(
      name, [](const Solver& s) { return s.settings().*flag; },
      [](Solver& s, bool on) { change(s, [&](Settings& settings) { settings.*flag = on; }); });
}

template <Real Settings::*member>
void define_positive(nb::class_<Solver>& solver, const char* name, const char* argument) {
  solver.def_prop_rw(
      name, [](const Solver& s) { return s.settings().*member; },
      [argument](Solver& s, double value) {
        require_positive(value, argument);
        change(s, [&](Settings& settings) { settings.*member = value; });
      });
}

template <int Settings::*limit>
void define_iteration_limit(nb::class_<Solver>& solver, const char* name) {
  solver.def_prop_rw(
      name, [](const Solver& s) { return s.settings().*limit; },
      [](Solver& s, int value) {
        require(value >= 1, "iters", "a positive integer", value);
        change(s, [&](Settings& settings) { settings.*limit = value; });
      });
}

void define_settings(nb::class_<Solver>& solver) {
  define_flag<&Settings::implicit_advection>(solver, "implicit_advection");
  define_flag<&Settings::prescribed_motion>(solver, "prescribed_motion");
  define_positive<&Settings::density>(solver, "density", "rho");
  define_positive<&Settings::time_step>(solver, "time_step", "dt");
  define_positive<&Settings::velocity_tolerance>(solver, "velocity_tolerance", "rtol");
  define_positive<&Settings::pressure_tolerance>(solver, "pressure_tolerance", "rtol");
  define_iteration_limit<&Settings::velocity_iteration_limit>(solver, "velocity_iteration_limit");
  define_iteration_limit<&Settings::pressure_iteration_limit>(solver, "pressure_iteration_limit");
  solver
      .def_prop_rw(
          "viscosity", [](const Solver& s) { return s.settings().viscosity; },
          [](Solver& s, double value) {
            require_non_negative(value, "mu");
            change(s, [&](Settings& settings) { settings.viscosity = value; });
          })
      .def_prop_rw(
          "body_force",
          [](const Solver& s) {
            const Real3 f = s.settings().body_force;
            return std::array<double, 3>{f[0], f[1], f[2]};
          },
          [](Solver& s, const std::array<double, 3>& f) {
            for (const double value : f) require_finite(value, "force");
            change(s, [&](Settings& settings) { settings.body_force = {f[0], f[1], f[2]}; });
          })
      .def_prop_rw(
          "advection_scheme", [](const Solver& s) { return s.settings().advection; },
          [](Solver& s, AdvectionScheme scheme) {
            change(s, [&](Settings& settings) { settings.advection = scheme; });
          });
}

DomainSide& checked_side(DomainSides& sides, int axis, int high) {
  require(axis >= 0 && axis < 3, "axis", "an axis 0, 1 or 2", axis);
  require(high == 0 || high == 1, "high", "0 or 1", high);
  return sides.side[axis][high];
}

void set_side_profile(Solver& solver, int axis, int high, nb::handle values) {
  DomainSides sides = solver.requested_sides();
  DomainSide& side = checked_side(sides, axis, high);
  const Int3 n = solver.grid().cells;
  side.kind = SideKind::Inflow;
  side.size_s = n[axis == 0 ? 1 : 0];
  side.size_t = n[axis == 2 ? 1 : 2];
  const Input<double> profile(values, "profile", {side.size_s, side.size_t, 3}, python::Order::Fortran);
  profile.require_finite();
  const auto given = profile.values();
  side.profile = Array<Real>("flow::side_profile", given.size());
  const Kokkos::View<const double*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> host(
      given.data(), given.size());
  Kokkos::deep_copy(side.profile, host);
  const std::size_t faces = given.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t m = 0; m < faces; ++m) sum += given[c * faces + m];
    side.velocity[static_cast<int>(c)] = sum / static_cast<double>(faces);
  }
  solver.set_side(axis, high, side);
}

void define_sides(nb::class_<Solver>& solver) {
  solver
      .def(
          "set_side",
          [](Solver& s, int axis, int high, SideKind kind, nb::handle velocity) {
            DomainSides sides = s.requested_sides();
            DomainSide& side = checked_side(sides, axis, high);
            side = DomainSide{};
            side.kind = kind;
            side.velocity = python::to_vec3(velocity, "velocity");
            s.set_side(axis, high, side);
          },
          "axis"_a, "high"_a, "kind"_a, "velocity"_a)
      .def("set_side_profile", &set_side_profile, "axis"_a, "high"_a, "profile"_a)
      .def(
          "side",
          [](const Solver& s, int axis, int high) {
            DomainSides sides = s.requested_sides();
            const DomainSide& side = checked_side(sides, axis, high);
            return std::make_tuple(side.kind,
                                   std::array<double, 3>{side.velocity.x, side.velocity.y, side.velocity.z});
          },
          "axis"_a, "high"_a)
      .def_prop_ro("courant_number", &Solver::courant_number)
      .def_prop_ro("body_courant_rate", [](const Solver& s) { return s.bodies().largest_courant_rate(); })
      .def_prop_ro("courant_number_bound", &Solver::courant_number_bound);
}

void define_geometry(nb::class_<Solver>& solver) {
  solver
      .def("set_scene", &set_scene, "node_ints"_a, "node_reals"_a, "instance_ints"_a, "instance_reals"_a,
           "periodic"_a = false)
      .def("set_sampled_solid", &set_sampled_solid, "sdf"_a)
      .def("build_geometry", &Solver::build_geometry, "keep_flow"_a, nb::call_guard<nb::gil_scoped_release>())
      .def("update_geometry", &Solver::update_geometry, nb::call_guard<nb::gil_scoped_release>())
      .def("refresh_wall_velocity", &Solver::refresh_wall_velocity, nb::call_guard<nb::gil_scoped_release>())
      .def(
          "set_pose",
          [](Solver& s, int body, nb::handle translation, nb::handle rotation) {
            const Vec3 t = python::to_vec3(translation, "translation");
            const Quaternion q = python::to_quaternion(rotation, "quat");
            require(q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0, "quat", "a non-zero quaternion",
                    "all zeros");
            s.set_pose(checked_body(s, body), t, q);
          },
          "instance"_a, "translation"_a, "quat"_a)
      .def(
          "set_motion",
          [](Solver& s, int body, nb::handle linear, nb::handle angular, nb::handle center) {
            const Twist twist{python::to_vec3(linear, "lin_vel"), python::to_vec3(angular, "ang_vel")};
            std::optional<Vec3> pinned;
            if (!center.is_none()) pinned = python::to_vec3(center, "center");
            s.set_motion(checked_body(s, body), twist, pinned);
          },
          "instance"_a, "lin_vel"_a, "ang_vel"_a, "center"_a.none())
      .def_prop_ro("number_of_bodies", &Solver::number_of_bodies)
      .def("body_center",
           [](const Solver& s, int body) {
             const Vec3 c = s.bodies()[checked_body(s, body)].center;
             return std::array<double, 3>{c.x, c.y, c.z};
           })
      .def("body_center_pinned",
           [](const Solver& s, int body) { return s.bodies().center_pinned(checked_body(s, body)); })
      .def("thinnest_body",
           [](const Solver& s) {
             int thinnest = -1;
             Real smallest = std::numeric_limits<Real>::infinity();
             for (int b = 0; b < s.bodies().count(); ++b) {
               const Real thickness = s.bodies().thickness(b);
               if (thickness < smallest) thinnest = b;
               smallest = std::min(smallest, thickness);
             }
             return std::tuple<int, Real>(thinnest, smallest);
           })
      .def("any_body_moves", [](const Solver& s) { return s.bodies().any_moves(); })
      .def("distance_and_owner", &distance_and_owner)
      .def("image_overlap_cells", &Solver::image_overlap_cells)
      .def("open_fraction", &open_fraction, "axis"_a);
}

void define_results(nb::class_<Solver>& solver) {
  solver.def("step", &Solver::step, nb::call_guard<nb::gil_scoped_release>())
      .def_prop_ro("time", &Solver::time)
      .def_prop_ro("number_of_steps", &Solver::number_of_steps)
      .def("loads", &loads)
      .def("pressure_force", [](const Solver& s) { return load_share(s, &BodyLoad::pressure_force); })
      .def("viscous_force", [](const Solver& s) { return load_share(s, &BodyLoad::viscous_force); })
      .def("velocity", &velocity, "c"_a, "with_slits"_a)
      .def(
          "assign_velocity",
          [](Solver& s, nb::handle u, nb::handle v, nb::handle w) {
            const nb::handle arrays[3] = {u, v, w};
            const char* names[3] = {"u", "v", "w"};
            const Int3 n = s.grid().cells;
            for (int c = 0; c < 3; ++c)  // check all before changing any
              if (!arrays[c].is_none())
                Input<double>(arrays[c], names[c], {n[0], n[1], n[2]}, python::Order::Fortran)
                    .require_finite();
            for (int c = 0; c < 3; ++c)
              if (!arrays[c].is_none()) python::assign(s.velocity()[c], arrays[c], names[c]);
            s.velocity_changed();
          },
          "u"_a.none(), "v"_a.none(), "w"_a.none())
      .def("pressure", [](const Solver& s) { return to_numpy(s.pressure()); })
      .def("assign_pressure",
           [](Solver& s, nb::handle p) {
             python::assign(s.pressure(), p, "p");
             s.pressure_changed();
           })
      .def("largest_open_divergence", &Solver::largest_open_divergence)
      .def("largest_velocity", &Solver::largest_velocity)
      .def("fluid_points",
           [](const Solver& s) {
             return nb::make_tuple(s.fluid_points(0), s.fluid_points(1), s.fluid_points(2));
           })
      .def("momentum_change",
           [](const Solver& s) {
             const Vec3 change = s.momentum_change();
             return std::array<double, 3>{change.x, change.y, change.z};
           })
      .def("force_on_defects",
           [](const Solver& s) {
             const Vec3 force = s.force_on_defects();
             return std::array<double, 3>{force.x, force.y, force.z};
           })
      .def("velocity_report", [](const Solver& s) { return report(s.velocity_report()); })
      .def("pressure_report", [](const Solver& s) { return report(s.pressure_report()); })
      .def("times", &times)
      .def_prop_ro("bytes", &Solver::bytes);
}

}  // namespace
}  // namespace peclet::flow

NB_MODULE(_flow, m) {
  using namespace peclet::flow;
  peclet::python::start_runtime();
  m.attr("execution_space") = peclet::ExecutionSpace::name();
  nb::enum_<AdvectionScheme>(m, "AdvectionScheme")
      .value("NONE", AdvectionScheme::None)
      .value("SECOND_UPWIND", AdvectionScheme::SecondUpwind)
      .value("KOREN", AdvectionScheme::Koren)
      .value("CENTRAL", AdvectionScheme::Central);
  nb::enum_<SideKind>(m, "SideKind")
      .value("PERIODIC", SideKind::Periodic)
      .value("WALL", SideKind::Wall)
      .value("INFLOW", SideKind::Inflow)
      .value("OUTFLOW", SideKind::Outflow)
      .value("SLIP", SideKind::Slip);
  nb::class_<Solver> solver(m, "Solver");
  solver.def(
      "__init__",
      [](Solver* self, const std::array<int, 3>& cells, const std::array<double, 3>& spacing,
         const std::array<double, 3>& origin) { new (self) Solver(make_grid(cells, spacing, origin)); },
      "cells"_a, "spacing"_a, "origin"_a);
  define_settings(solver);
  define_sides(solver);
  define_geometry(solver);
  define_results(solver);
  define_scalars(m, solver);
  define_checkpoint(solver);
}
