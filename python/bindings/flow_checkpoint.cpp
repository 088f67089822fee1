// Whole state of the compiled solver, for runs that go on bit by bit.
#include "python/bindings/flow_checkpoint.hpp"

#include <nanobind/stl/string.h>

#include "core/field_transfer.hpp"
#include "python/bindings/arrays.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using peclet::python::Input;
using peclet::python::Output;
using peclet::python::to_numpy;

namespace peclet::flow {
namespace {

constexpr std::int64_t motion_columns = 24;

/// Everything that the flow needs to go on: fields of unknowns, clock (time, last time step, steps, whether
/// the body force is still to be balanced), and bodies (n, 24): translation, rotation, linear and angular
/// velocity, the same two at the end of the last step, centre, pinned, dynamic.
nb::dict checkpoint(Solver& solver) {
  nb::dict state;
  for (const StoredField& stored : solver.stored_fields()) {
    const Box& box = stored.box;
    Output<double> values({box.extent(0), box.extent(1), box.extent(2)}, python::Order::Fortran);
    copy_to_host(stored.field, box, values.data());
    state[stored.name.c_str()] = values.release();
  }
  const Clock clock = solver.clock();
  std::vector<double> times{clock.time, clock.previous_time_step, static_cast<double>(clock.steps),
                            static_cast<double>(clock.force_unbalanced)};
  times.insert(times.end(), clock.scalar_time_steps.begin(), clock.scalar_time_steps.end());
  state["clock"] = to_numpy(times);
  std::vector<double> motions;
  for (int b = 0; b < solver.number_of_bodies(); ++b) {
    const BodyMotion m = solver.bodies().motion(b);
    const Quaternion q = m.pose.rotation;
    for (const Vec3& v : {m.pose.translation, Vec3{q.x, q.y, q.z}})
      motions.insert(motions.end(), {v.x, v.y, v.z});
    motions.push_back(q.w);
    for (const Vec3& v :
         {m.twist.linear, m.twist.angular, m.former_twist.linear, m.former_twist.angular, m.center})
      motions.insert(motions.end(), {v.x, v.y, v.z});
    motions.push_back(m.pinned);
    motions.push_back(m.dynamic);
  }
  state["bodies"] = to_numpy(motions, {solver.number_of_bodies(), motion_columns});
  return state;
}

BodyMotion to_motion(const Input<double>& rows, Index b, double scale) {
  const auto at = [&](Index column) { return rows[b * motion_columns + column]; };
  const auto vector = [&](Index first) { return Vec3{at(first), at(first + 1), at(first + 2)}; };
  BodyMotion motion;
  motion.pose = Pose{vector(0), Quaternion{at(3), at(4), at(5), at(6)}, scale};
  motion.twist = Twist{vector(7), vector(10)};
  motion.former_twist = Twist{vector(13), vector(16)};
  motion.center = vector(19);
  motion.pinned = at(22) != 0;
  motion.dynamic = at(23) != 0;
  return motion;
}

/// The state has been checked by the caller to have the names and shapes that checkpoint() returns.
void restore(Solver& solver, const nb::dict& state) {
  const auto scalars = static_cast<std::size_t>(solver.scalars().count());
  const Input<double> clock(state["clock"], "clock", {static_cast<std::int64_t>(4 + scalars)});
  const Input<double> rows(state["bodies"], "bodies", {solver.number_of_bodies(), motion_columns});
  std::vector<BodyMotion> motions;
  for (int b = 0; b < solver.number_of_bodies(); ++b)
    motions.push_back(to_motion(rows, b, solver.bodies()[b].pose.scale));
  solver.restore_bodies(motions);
  for (const StoredField& stored : solver.stored_fields()) {
    const Box& box = stored.box;
    const Input<double> values(state[stored.name.c_str()], stored.name,
                               {box.extent(0), box.extent(1), box.extent(2)}, python::Order::Fortran);
    copy_from_host(values.data(), box, stored.field);
  }
  Clock past{clock[0], clock[1], static_cast<long>(clock[2]), clock[3] != 0, {}};
  past.scalar_time_steps.assign(clock.data() + 4, clock.data() + 4 + scalars);
  solver.restore_clock(past);
}

/// The memory of a field of the checkpoint.
nb::object field_view(Solver& solver, const std::string& name) {
  for (const StoredField& stored : solver.stored_fields())
    if (stored.name == name) return python::view_of(stored.field);
  require(false, "name", "a field of the checkpoint", "'" + name + "'");
  return nb::none();
}

}  // namespace

void define_checkpoint(nb::class_<Solver>& solver) {
  solver.def("checkpoint", &checkpoint)
      .def("restore", &restore, "state"_a)
      .def("field_view", &field_view, "name"_a);
}

}  // namespace peclet::flow
