// Scalars on the compiled solver: peclet.flow.Solver is the documented face of it.
#include "python/bindings/flow_scalars.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "python/bindings/arrays.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using peclet::python::Input;
using peclet::python::to_numpy;

namespace peclet::flow {
namespace {

int index_of(const Solver& solver, const std::string& name) {
  const int n = solver.scalars().find(name);
  require(n >= 0, "name", "a scalar that add_scalar() has made", "'" + name + "'");
  return n;
}

Scalar& find(Solver& solver, const std::string& name) { return solver.scalars()[index_of(solver, name)]; }

std::vector<std::string> names(const Solver& solver) {
  std::vector<std::string> result;
  for (int n = 0; n < solver.scalars().count(); ++n) result.push_back(solver.scalars()[n].name);
  return result;
}

void add(Solver& solver, const std::string& name, double diffusivity, ScalarScheme scheme) {
  require(solver.scalars().find(name) < 0, "name", "a name that no scalar has yet", "'" + name + "'");
  require_non_negative(diffusivity, "diffusivity");
  ScalarSettings settings;
  settings.diffusivity = diffusivity;
  settings.scheme = scheme;
  solver.scalars().add(name, settings);
}

nb::object values(Solver& solver, const std::string& name) {
  const int n = index_of(solver, name);
  solver.prepare_scalars();
  return to_numpy(solver.scalars()[n].fields.value);
}

void assign(Solver& solver, const std::string& name, nb::handle array) {
  Scalar& scalar = find(solver, name);
  python::assign(scalar.fields.value, array, "array");
  scalar.value_changed = true;
  scalar.geometry_stale = true;  // walls of given value impose it on solid cells again
}

void set_wall(Solver& solver, const std::string& name, ScalarCondition condition, double value,
              std::optional<int> body) {
  const int n = index_of(solver, name);
  require_finite(value, "value");
  require(!body || (*body >= 0 && *body < solver.number_of_bodies()), "instance",
          "an index from 0 to " + std::to_string(solver.number_of_bodies() - 1), body.value_or(0));
  solver.scalars().set_wall(n, body, ScalarWall{condition, value});
}

void set_side(Solver& solver, const std::string& name, int face, ScalarCondition condition,
              nb::handle value) {
  Scalar& scalar = find(solver, name);
  require(face >= 0 && face < 6, "face", "a side from 0 to 5", face);
  const int axis = face / 2;
  ScalarSide side = scalar.sides.side[axis][face % 2];
  const Int3 n = solver.grid().cells;
  const int s = n[axis == 0 ? 1 : 0], t = n[axis == 2 ? 1 : 2];
  const Input<double> given(value, "value", {s, t}, python::Order::Fortran);
  given.require_finite();
  side.condition = condition;
  side.is_given = true;
  side.profile = copy_from_host("flow::scalar_side", given.data(), static_cast<Index>(given.size()));
  side.size_s = s;
  scalar.sides.side[axis][face % 2] = side;
  scalar.geometry_stale = true;
}

void set_source_field(Solver& solver, const std::string& name, nb::handle source) {
  Scalar& scalar = find(solver, name);
  const Field<Real> field("flow::scalar_source", Layout(solver.grid().cells));
  python::assign(field, source, "source");
  scalar.source_field = field;
  scalar.settings.source = 0;
}

nb::dict report(Solver& solver, const std::string& name) {
  const SolverReport& report = find(solver, name).report;
  nb::dict result;
  result["iterations"] = report.iterations;
  result["residual"] = report.residual;
  result["converged"] = report.converged;
  return result;
}

nb::object given(Solver& solver, const std::string& name) {
  const Scalar& scalar = find(solver, name);
  require_state(!scalar.given.empty(), "scalar_wall_flux(): call step() or advance_scalars() first");
  return to_numpy(scalar.given);
}

void define_conditions(nb::class_<Solver>& solver) {
  solver.def("set_scalar_wall", &set_wall, "name"_a, "condition"_a, "value"_a, "instance"_a.none())
      .def("set_scalar_side", &set_side, "name"_a, "face"_a, "condition"_a, "value"_a)
      .def(
          "set_scalar_source",
          [](Solver& s, const std::string& name, double source) {
            Scalar& scalar = find(s, name);
            require_finite(source, "source");
            scalar.settings.source = source;
            scalar.source_field = Field<Real>();
          },
          "name"_a, "source"_a)
      .def("set_scalar_source_field", &set_source_field, "name"_a, "source"_a)
      .def(
          "set_scalar_mean_gradient",
          [](Solver& s, const std::string& name, nb::handle gradient) {
            Scalar& scalar = find(s, name);
            const Vec3 g = python::to_vec3(gradient, "gradient");
            scalar.settings.mean_gradient = {g.x, g.y, g.z};
          },
          "name"_a, "gradient"_a)
      .def(
          "set_scalar_tolerance",
          [](Solver& s, const std::string& name, double rtol) {
            Scalar& scalar = find(s, name);
            require_positive(rtol, "rtol");
            scalar.settings.tolerance = rtol;
          },
          "name"_a, "rtol"_a)
      .def(
          "set_scalar_iteration_limit",
          [](Solver& s, const std::string& name, int limit) {
            Scalar& scalar = find(s, name);
            require(limit >= 1, "iters", "a positive integer", limit);
            scalar.settings.iteration_limit = limit;
          },
          "name"_a, "iters"_a)
      .def(
          "set_buoyancy",
          [](Solver& s, const std::string& name, double expansion, double reference, nb::handle gravity) {
            const int n = index_of(s, name);
            require_finite(expansion, "expansion");
            require_finite(reference, "reference");
            const Vec3 g = python::to_vec3(gravity, "gravity");
            s.scalars().set_buoyancy({n, expansion, reference, {g.x, g.y, g.z}});
          },
          "name"_a, "expansion"_a, "reference"_a, "gravity"_a);
}

}  // namespace

void define_scalars(nb::module_& m, nb::class_<Solver>& solver) {
  nb::enum_<ScalarScheme>(m, "ScalarScheme")
      .value("FIRST_UPWIND", ScalarScheme::FirstUpwind)
      .value("SECOND_UPWIND", ScalarScheme::SecondUpwind)
      .value("KOREN", ScalarScheme::Koren);
  nb::enum_<ScalarCondition>(m, "ScalarCondition")
      .value("FLUX", ScalarCondition::Flux)
      .value("VALUE", ScalarCondition::Value);
  define_conditions(solver);
  solver.def_prop_ro("scalar_names", &names)
      .def("add_scalar", &add, "name"_a, "diffusivity"_a, "scheme"_a)
      .def("scalar", &values, "name"_a)
      .def("assign_scalar", &assign, "name"_a, "array"_a)
      .def("advance_scalars", &Solver::advance_scalars, nb::call_guard<nb::gil_scoped_release>())
      .def(
          "solve_scalar_steady",
          [](Solver& s, const std::string& name) {
            const int n = index_of(s, name);
            const nb::gil_scoped_release release;
            s.solve_scalar_steady(n);
          },
          "name"_a)
      .def("scalar_report", &report, "name"_a)
      .def("scalar_diffusivity",
           [](const Solver& s, const std::string& name) {
             return s.scalars()[index_of(s, name)].settings.diffusivity;
           })
      .def("scalar_tolerance",
           [](const Solver& s, const std::string& name) {
             return s.scalars()[index_of(s, name)].settings.tolerance;
           })
      .def("scalar_given", &given, "name"_a)
      .def(
          "scalar_amount",
          [](Solver& s, const std::string& name) {
            const int n = index_of(s, name);
            s.prepare_scalars();
            return s.scalars().amount(n);
          },
          "name"_a)
      .def(
          "mean_scalar_flux",
          [](Solver& s, const std::string& name) {
            const Real3 flux = s.mean_scalar_flux(index_of(s, name));
            return std::array<double, 3>{flux[0], flux[1], flux[2]};
          },
          "name"_a);
}

}  // namespace peclet::flow
