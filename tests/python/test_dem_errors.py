"""Bad input to peclet.dem: the error names argument, expected and found; the state stays as it was."""

import numpy as np
import pytest
from peclet import dem

from tests.python import views

NAN = float("nan")
GOOD_INTS, GOOD_REALS = [1, -1, -1], [1.0] + [0.0] * 13 + [1.0, 1.0]


def make():
    sim = dem.Simulation(4)
    sim.set_sphere_shape(0.5)
    sim.set_positions([[1, 2, 3], [4, 5, 6]])
    sim.set_velocities([[1, 0, 0], [0, 1, 0]])
    sim.add_analytic_wall(GOOD_INTS, GOOD_REALS, 0, False)
    return sim


def state(sim):
    arrays = [
        sim.get_positions(),
        sim.get_velocities(),
        sim.get_angular_velocities(),
        sim.get_quaternions(),
        sim.get_masses(),
        sim.get_inv_inertia(),
        sim.get_scales(),
    ]
    if views.readable:
        arrays.append(sim.get_external_forces_view().copy())
    return arrays, (sim.time, sim.dt, sim.gravity, sim.origin, sim.extent, sim.periodic)


BAD = [
    (TypeError, "capacity", lambda s: dem.Simulation(2.5)),
    (TypeError, "capacity", lambda s: dem.Simulation("8")),
    (ValueError, "capacity", lambda s: dem.Simulation(0)),
    (ValueError, "capacity", lambda s: dem.Simulation(-3)),
    (ValueError, "radius", lambda s: s.set_sphere_shape(-1.0)),
    (ValueError, "radius", lambda s: s.set_sphere_shape(NAN)),
    (TypeError, "radius", lambda s: s.set_sphere_shape("large")),
    (ValueError, "shape", lambda s: s.initialize_shape("cube", 1.0)),
    (ValueError, "shape", lambda s: s.initialize(7, 1.0)),
    (ValueError, "gravity", lambda s: s.set_gravity(0, 0, NAN)),
    (ValueError, "gravity", lambda s: s.set_gravity([0, 1])),
    (TypeError, "gravity", lambda s: s.set_gravity(0, 1)),
    (ValueError, "positions", lambda s: s.set_positions([[1, 2]])),
    (ValueError, "positions", lambda s: s.set_positions([1, 2, 3])),
    (ValueError, "positions", lambda s: s.set_positions([[1, 2, NAN]])),
    (TypeError, "positions", lambda s: s.set_positions([["a", "b", "c"]])),
    (ValueError, "inverse mass", lambda s: s.set_positions([[1, 2, 3, -1]])),
    (ValueError, "velocities", lambda s: s.set_velocities(np.zeros((3, 3)))),
    (ValueError, "velocities", lambda s: s.set_velocities(np.zeros(6))),
    (ValueError, "velocities", lambda s: s.set_velocities([[0, 0, 0], [0, np.inf, 0]])),
    (ValueError, "angular_velocities", lambda s: s.set_angular_velocities(np.zeros((2, 4)))),
    (ValueError, "quaternions", lambda s: s.set_quaternions(np.zeros((2, 4)))),
    (ValueError, "quaternions", lambda s: s.set_quaternions(np.ones((2, 3)))),
    (ValueError, "forces", lambda s: s.set_external_forces(np.zeros((1, 3)))),
    (ValueError, "torques", lambda s: s.set_external_torques([[0, 0, NAN], [0, 0, 0]])),
    (ValueError, "inv_mass", lambda s: s.set_inv_mass([1, -1])),
    (ValueError, "inv_mass", lambda s: s.set_inv_mass([[1], [1]])),
    (ValueError, "inv_inertia", lambda s: s.set_inv_inertia([[1, 1, -1], [1, 1, 1]])),
    (ValueError, "scales", lambda s: s.set_scales([1, 0])),
    (ValueError, "scale", lambda s: s.set_scales_uniform(-2)),
    (ValueError, "restitution_normal", lambda s: s.set_material_params(1.5)),
    (ValueError, "restitution_tangent", lambda s: s.set_material_params(0.5, 2.0)),
    (ValueError, "friction", lambda s: s.set_material_params(0.5, 0.0, -0.1)),
    (ValueError, "a", lambda s: s.set_pair_material(-1, 0, 0.5, 0.1)),
    (ValueError, "ids", lambda s: s.set_material_ids([0, 5000])),
    (ValueError, "ids", lambda s: s.set_material_ids([0])),
    (ValueError, "pos", lambda s: s.set_solver_iterations(-1, 0)),
    (TypeError, "vel", lambda s: s.set_solver_iterations(10, 0.5)),
    (ValueError, "lx", lambda s: s.set_domain(-1.0, 1.0, 1.0)),
    (ValueError, "max", lambda s: s.set_domain((0, 0, 0), (1, -1, 1))),
    (TypeError, "set_domain", lambda s: s.set_domain(1.0, 2.0)),
    (TypeError, "set_domain", lambda s: s.set_domain(extent=(1, 1, 1), size=3)),
    (TypeError, "periodic", lambda s: s.set_periodic(True, True, "yes")),
    (ValueError, "normal", lambda s: s.add_plane((0, 0, 0), (0, 0, 0))),
    (TypeError, "add_plane", lambda s: s.add_plane(0, 0, 0)),
    (ValueError, "root", lambda s: s.add_analytic_wall(GOOD_INTS, GOOD_REALS, 1, False)),
    (ValueError, "node", lambda s: s.add_analytic_wall([99, -1, -1], GOOD_REALS, 0, False)),
    (ValueError, "node", lambda s: s.add_analytic_wall(GOOD_INTS, GOOD_REALS[:-1], 0, False)),
    (TypeError, "invert", lambda s: s.add_analytic_wall(GOOD_INTS, GOOD_REALS, 0, "no")),
    (ValueError, "restitution", lambda s: s.add_analytic_wall(GOOD_INTS, GOOD_REALS, 0, True, 2.0)),
    (ValueError, "wall_index", lambda s: s.set_wall_transform(1)),
    (ValueError, "quat", lambda s: s.set_wall_transform(0, quat=(0, 0, 0, 0))),
    (ValueError, "lin_vel", lambda s: s.set_wall_velocity(0, (NAN, 0, 0))),
    (ValueError, "wall_index", lambda s: s.diagnostics.wall_sdf_at(3, [[0, 0, 0]])),
    (ValueError, "points", lambda s: s.wall_sdf_at(0, [0, 0, 0])),
    (ValueError, "dt", lambda s: s.set_dt(0)),
    (ValueError, "dt", lambda s: s.step(-0.1)),
    (ValueError, "dt", lambda s: s.step(NAN)),
    (TypeError, "dt", lambda s: s.step("0.1")),
    (ValueError, "n", lambda s: s.relax(-1)),
    (ValueError, "rolling_friction", lambda s: s.set_material_params(0.5, rolling_friction=-1)),
    (ValueError, "rolling_friction", lambda s: s.set_pair_material(0, 1, 0.5, 0.1, NAN)),
    (ValueError, "mat", lambda s: s.set_hertz_material(-1, 1e6, 0.3)),
    (ValueError, "youngs", lambda s: s.set_hertz_material(0, 0.0, 0.3)),
    (ValueError, "poisson", lambda s: s.set_hertz_material(0, 1e6, 0.6)),
    (ValueError, "poisson", lambda s: s.set_hertz_material(0, 1e6, -1.0)),
    (ValueError, "dt", lambda s: s.step_hertz(-0.1)),
    (TypeError, "substeps", lambda s: s.step_hertz(0.1, 2.5)),
    (ValueError, "skin_frac", lambda s: s.step_hertz(0.1, 1, 0.0)),
    (TypeError, "step_hertz", lambda s: s.step_hertz(0.1, 1, 0.3, 4)),
    (TypeError, "step_hertz", lambda s: s.step_hertz(0.1, skin=0.3)),
    (RuntimeError, "dt", lambda s: s.step_hertz()),
    (RuntimeError, "material 0 has no Young's modulus", lambda s: s.step_hertz(0.1)),
    (RuntimeError, "material 0 has no Young's modulus", lambda s: s.hertz_times()),
    (ValueError, "new_factor", lambda s: s.set_growth_params(1.0, 2.0)),
    (ValueError, "rate", lambda s: s.set_growth_params(NAN)),
    (ValueError, "scale", lambda s: s.set_global_scale(0.0)),
    (ValueError, "mode", lambda s: s.set_stabilization("on")),
    (ValueError, "name", lambda s: s.diagnostics.set_velocity_solver("direct")),
]


@pytest.mark.parametrize(("error", "name", "call"), BAD, ids=[f"{n}-{case[1]}" for n, case in enumerate(BAD)])
def test_bad_input_is_refused_and_changes_nothing(error, name, call):
    sim = make()
    arrays, values = state(sim)
    with pytest.raises(error, match=name):
        call(sim)
    now, values_now = state(sim)
    for before, after in zip(arrays, now, strict=True):
        np.testing.assert_array_equal(before, after)
    assert values == values_now


def test_wrong_order_of_calls():
    sim = dem.Simulation(1)
    with pytest.raises(RuntimeError, match="shape"):
        sim.set_positions([[0, 0, 0]])
    sim.set_sphere_shape(0.5)
    with pytest.raises(ValueError, match="velocities"):
        sim.set_velocities([[0, 0, 0]])
    sim.set_positions([[0, 0, 0]])
    sim.set_periodic(True, False, False)
    with pytest.raises(RuntimeError, match="set_domain"):
        sim.step(0.1)


def test_box_narrower_than_a_sphere_is_refused():
    sim = make()
    sim.set_domain(0.9, 5.0, 5.0)
    with pytest.raises(RuntimeError, match="diameter"):
        sim.step(0.1)


def test_count_after_set_dt_must_not_be_negative():
    sim = make()
    sim.set_dt(0.1)
    with pytest.raises(ValueError, match="n:"):
        sim.step(-1)


def test_huge_values_do_not_crash():
    sim = dem.Simulation(3)
    sim.set_sphere_shape(1e-3)
    sim.set_positions([[1e300, 0, 0], [-1e300, 1e200, 0], [0, 0, 0]])
    sim.set_velocities([[1e200, 0, 0], [0, 0, 0], [1, 1, 1]])
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.step(1e-3)
    sim.set_velocities([[1e300, 0, 0], [0, 0, 0], [1, 1, 1]])
    with pytest.raises(RuntimeError, match="finite"):
        sim.step(1e300)
    assert np.isfinite(sim.get_positions()).all()
