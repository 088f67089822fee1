"""Every argument is checked where it enters, and a refused call leaves the solver as it was."""

import os
import signal
import threading
import warnings

import numpy as np
import pytest
from peclet import flow

from tests.python.flow_scenes import box_with, spheres, state

NAN, INF = float("nan"), float("inf")
SHAPE = (8, 6, 10)


def small_solver():
    solver = flow.Solver(*SHAPE)
    solver.set_dt(0.5)
    box_with(solver, ((3.3, 2.6, 4.1), 1.9), ((6.1, 4.2, 8.3), 1.2, (0.1, 0.0, -0.05)))
    solver.set_body_force(1e-2, 0, 2e-3)
    solver.step()
    return solver


@pytest.fixture(scope="module")
def solver():
    return small_solver()


def field(shape=SHAPE, entry=0.0, dtype=float):
    array = np.zeros(shape, dtype)
    array.flat[5] = entry
    return array


def changed(which, place, value):
    """The records of one sphere with one entry changed."""
    records = [np.array(record) for record in spheres(((3, 3, 3), 2.0))]
    records[which][place] = value
    return tuple(records)


GOOD = spheres(((3, 3, 3), 2.0))
ZEROS = field()

# call, arguments, error, start of the message
REFUSED = [
    ("set_rho", (0,), ValueError, "rho: expected a positive number, found 0"),
    ("set_rho", (1e-320,), ValueError, "rho: expected a positive number, found 1e-320"),
    ("set_rho", (-1.0,), ValueError, "rho: "),
    ("set_rho", (NAN,), ValueError, "rho: expected a finite number, found nan"),
    ("set_rho", (INF,), ValueError, "rho: "),
    ("set_rho", ("1",), TypeError, "rho: expected a real number, found '1'"),
    ("set_rho", (None,), TypeError, "rho: "),
    ("set_rho", (True,), TypeError, "rho: "),
    ("set_rho", ([1.0],), TypeError, "rho: "),
    ("set_rho", ([[1], [1, 2]],), TypeError, "rho: "),
    ("set_rho", (1j,), TypeError, "rho: "),
    ("set_rho", (10**400,), ValueError, "rho: "),
    ("set_mu", (-1e-9,), ValueError, "mu: expected zero or a positive number"),
    ("set_mu", (NAN,), ValueError, "mu: "),
    ("set_mu", (np.array([0.1]),), TypeError, "mu: "),
    ("set_dt", (0.0,), ValueError, "dt: "),
    ("set_dt", (-INF,), ValueError, "dt: "),
    ("set_dt", (False,), TypeError, "dt: "),
    ("set_body_force", (), TypeError, "set_body_force"),
    ("set_body_force", (1, 2), TypeError, "set_body_force"),
    ("set_body_force", (1, NAN, 2), ValueError, "fy: "),
    ("set_body_force", ([1, 2],), ValueError, "force: "),
    ("set_body_force", ([1, 2, INF],), ValueError, r"force\[2\]: "),
    ("set_body_force", ("abc",), TypeError, "force: "),
    ("set_advection", (1,), TypeError, "on: expected True or False, found 1"),
    ("set_advection", ("yes",), TypeError, "on: "),
    ("set_advection_scheme", (2,), ValueError, "scheme: "),
    ("set_advection_scheme", (-1,), ValueError, "scheme: "),
    ("set_advection_scheme", (True,), TypeError, "scheme: "),
    ("set_advection_scheme", (1.0,), TypeError, "scheme: "),
    ("set_advection_scheme", ("SOU",), ValueError, "scheme: "),
    ("set_advection_scheme", (flow.AdvectionScheme.NONE,), ValueError, "scheme: "),
    ("set_velocity_solver_params", (0,), ValueError, "iters: "),
    ("set_velocity_solver_params", (-5,), ValueError, "iters: "),
    ("set_velocity_solver_params", (2**31,), ValueError, "iters: "),
    ("set_velocity_solver_params", (10.0,), TypeError, "iters: "),
    ("set_velocity_solver_params", (True,), TypeError, "iters: "),
    ("set_velocity_solver_params", (10, -1e-3), ValueError, "rtol: "),
    ("set_velocity_solver_params", (10, NAN), ValueError, "rtol: "),
    ("set_velocity_solver_params", (10, 1.0), ValueError, "rtol: "),
    ("set_velocity_solver_params", (10, 1e-3, -1), ValueError, "min_iters: "),
    ("set_velocity_solver_params", (10, 1e-3, 2.0), TypeError, "min_iters: "),
    ("set_velocity_residual_tolerance", (0.0,), ValueError, "rtol: "),
    ("set_velocity_residual_tolerance", (-2,), ValueError, "rtol: "),
    ("set_velocity_residual_tolerance", (2,), ValueError, "rtol: "),
    ("set_pressure_tolerance", (0,), ValueError, "rtol: "),
    ("set_pressure_solver_params", (0,), ValueError, "iters: "),
    ("set_pressure_solver_params", (1.5,), TypeError, "iters: "),
    ("set_pressure_pcg", (1,), TypeError, "on: "),
    ("set_pressure_pcg", (True, 0), ValueError, "max_iter: "),
    ("set_pressure_pcg", (True, 10, 0), ValueError, "rtol: "),
    ("set_pressure_fcg", (True, 10, NAN), ValueError, "rtol: "),
    ("set_pressure_chebyshev", (None,), TypeError, "on: "),
    ("set_pressure_multigrid", (True, 0), ValueError, "levels: "),
    ("set_pressure_multigrid", (True, "4"), TypeError, "levels: "),
    ("set_velocity_multigrid", (True, 4, -1), ValueError, "vcycles: "),
    ("set_outer_iterations", (0,), ValueError, "n: "),
    ("set_fresh_cell_seed", (1,), TypeError, "on: "),
    ("set_scene", (*GOOD, 1), TypeError, "periodic: "),
    ("set_scene", (GOOD[0][:2], *GOOD[1:]), ValueError, "node_ints: "),
    ("set_scene", (GOOD[0], GOOD[1][:-1], *GOOD[2:]), ValueError, "node_reals: "),
    ("set_scene", (*GOOD[:2], GOOD[2][:1], GOOD[3]), ValueError, "instance_ints: "),
    ("set_scene", (*GOOD[:3], GOOD[3][:16]), ValueError, "instance_reals: expected 17 or 18 numbers"),
    ("set_scene", (*GOOD[:3], "records"), TypeError, "instance_reals: "),
    ("set_scene", (None, *GOOD[1:]), TypeError, "node_ints: "),
    ("set_scene", (GOOD[0] + 0.5, *GOOD[1:]), ValueError, "node_ints: "),
    ("set_scene", changed(0, 0, 77), ValueError, "node 0: opcode"),
    ("set_scene", changed(0, 0, 32), ValueError, "node 0: child"),
    ("set_scene", changed(1, 0, -2.0), ValueError, "node 0: parameters"),
    ("set_scene", changed(1, 0, NAN), ValueError, "node 0: parameters"),
    ("set_scene", changed(1, 15, 0), ValueError, "node 0: scale"),
    ("set_scene", changed(2, 0, 1), ValueError, "instance 0: root"),
    ("set_scene", changed(2, 0, -1), ValueError, "instance 0: root"),
    ("set_scene", changed(3, 0, NAN), ValueError, "instance 0: translation"),
    ("set_scene", changed(3, 6, 0), ValueError, "instance 0: rotation"),
    ("set_scene", changed(3, 7, -1), ValueError, "instance 0: scale"),
    ("set_scene", changed(3, 8, INF), ValueError, "instance 0: lin_vel"),
    ("set_solid_from_scene", (1,), TypeError, "cutcell_pressure: "),
    (
        "set_solid",
        (field((8, 6, 9)),),
        ValueError,
        r"sdf: expected an array of shape \(8, 6, 10\), found \(8, 6, 9\)",
    ),
    ("set_solid", (field(entry=NAN),), ValueError, r"sdf\[0, 0, 5\]: "),
    ("set_solid", ("sphere",), TypeError, "sdf: "),
    ("set_solid", (ZEROS, 1), TypeError, "cutcell_pressure: "),
    ("set_solid", (ZEROS, True, "linea"), ValueError, "pressure_coarse: "),
    (
        "set_instance_transform",
        (2, (1, 1, 1)),
        RuntimeError,
        "instance: expected an index from 0 to 1, found 2",
    ),
    ("set_instance_transform", (-1, (1, 1, 1)), RuntimeError, "instance: "),
    ("set_instance_transform", (1.0, (1, 1, 1)), TypeError, "instance: "),
    ("set_instance_transform", (True, (1, 1, 1)), TypeError, "instance: "),
    ("set_instance_transform", (1, (1, 1)), ValueError, "translation: "),
    ("set_instance_transform", (1, 5.0), ValueError, "translation: "),
    ("set_instance_transform", (1, (1, NAN, 1)), ValueError, r"translation\[1\]: "),
    ("set_instance_transform", (1, None), TypeError, "translation: "),
    ("set_instance_transform", (1, (1, 1, 1), (0, 0, 0)), ValueError, "quat: "),
    ("set_instance_transform", (1, (1, 1, 1), (0, 0, 0, 0)), ValueError, "quat: "),
    ("set_instance_transform", (1, (1, 1, 1), (0, INF, 0, 1)), ValueError, r"quat\[1\]: "),
    ("set_instance_motion", (2,), RuntimeError, "instance: "),
    ("set_instance_motion", ("0",), TypeError, "instance: "),
    ("set_instance_motion", (0, (0, 0)), ValueError, "lin_vel: "),
    ("set_instance_motion", (0, (0, 0, NAN)), ValueError, r"lin_vel\[2\]: "),
    ("set_instance_motion", (0, (0, 0, 0), (INF, 0, 0)), ValueError, r"ang_vel\[0\]: "),
    ("set_instance_motion", (0, (1, 0, 0), (0, 0, 0), (1, 2)), ValueError, "center: "),
    ("set_instance_motion", (0, (1, 0, 0), (0, 0, 0), (1, 2, NAN)), ValueError, r"center\[2\]: "),
    ("instance_center", (2,), RuntimeError, "i: "),
    ("instance_center_pinned", (-1,), RuntimeError, "i: "),
    ("get_field", ("q",), ValueError, "name: expected one of 'p', 'sdf', 'u', 'v', 'w', found 'q'"),
    ("get_field", (0,), TypeError, "name: "),
    ("has_field", (0,), TypeError, "name: "),
    ("set_field", ("sdf", ZEROS), ValueError, "name: "),
    ("set_field", ("u", field((6, 8, 10))), ValueError, "array: "),
    ("set_field", ("p", field(entry=INF)), ValueError, r"array\[0, 0, 5\]: "),
    ("set_field", ("p", field(dtype=complex)), TypeError, "array: "),
    ("set_field", ("p", field(dtype=bool)), TypeError, "array: "),
    ("set_velocity", (3, ZEROS), ValueError, "c: expected an integer from 0 to 2, found 3"),
    ("set_velocity", (-1, ZEROS), ValueError, "c: "),
    ("set_velocity", (0.0, ZEROS), TypeError, "c: "),
    ("set_velocity", (0, ZEROS[0]), ValueError, "array: "),
    ("set_velocity", (0, [[1], [1, 2]]), TypeError, "array: "),
    ("set_state", (ZEROS, ZEROS, ZEROS[..., :-1]), ValueError, "w: "),
    ("set_state", (ZEROS + 1, field(entry=NAN), ZEROS), ValueError, r"v\[0, 0, 5\]: "),
    ("set_state", (ZEROS + 1, ZEROS, None), TypeError, "w: "),
]


@pytest.mark.parametrize(("call", "arguments", "error", "message"), REFUSED)
def test_refuses_and_stays_as_it_was(solver, call, arguments, error, message):
    before = state(solver)
    with pytest.raises(error, match=f"^{message}"):
        getattr(solver, call)(*arguments)
    assert state(solver) == before


@pytest.mark.parametrize(
    ("arguments", "named", "error", "message"),
    [
        ((), {}, TypeError, r"Solver\(\): missing"),
        ((8, 8), {}, TypeError, r"Solver\(\): missing a required argument: 'nz'"),
        ((8, 8, 8, 8), {}, TypeError, r"Solver\(\): too many"),
        ((8, 8, 0), {}, ValueError, "nz: expected an integer from 1 to 1048576, found 0"),
        ((-8, 8, 8), {}, ValueError, "nx: "),
        ((8, 8.0, 8), {}, TypeError, "ny: "),
        ((True, 8, 8), {}, TypeError, "nx: "),
        ((2**40, 8, 8), {}, ValueError, "nx: "),
        ((2**20, 2**20, 2**20), {}, MemoryError, "cells: "),
        (((8, 8),), {}, ValueError, "cells: "),
        (("abc",), {}, TypeError, "nx: |Solver"),
        (((8, 8, 0),), {}, ValueError, r"cells\[2\]: "),
        (((8, 8, 8.5),), {}, TypeError, r"cells\[2\]: "),
        (((8, 8, 8),), {"extent": (1, 1)}, ValueError, "extent: "),
        (((8, 8, 8),), {"extent": (1, 1, 0)}, ValueError, r"extent\[2\]: "),
        (((8, 8, 8),), {"extent": (1, 1, NAN)}, ValueError, r"extent\[2\]: "),
        (((8, 8, 8),), {"extent": 1.0}, ValueError, "extent: "),
        (((8, 8, 8),), {"extent": (1, 1, 1), "origin": (0, INF, 0)}, ValueError, r"origin\[1\]: "),
        (((8, 8, 8),), {"origin": (0, 0, 0)}, ValueError, "origin: "),
        (((8, 8, 8),), {"extent": (1, 1, 1), "global_cells": (16, 8, 8)}, ValueError, "global_cells: "),
        (((8, 8, 8),), {"size": 1}, TypeError, r"Solver\(\): "),
    ],
)
def test_construction_refuses(arguments, named, error, message):
    with pytest.raises(error, match=f"^(?:{message})"):
        flow.Solver(*arguments, **named)


def test_order_of_calls():
    solver = flow.Solver(6, 6, 6)
    with pytest.raises(RuntimeError, match=r"set_scene\(\) first"):
        solver.set_solid_from_scene()
    with pytest.raises(RuntimeError, match=r"set_scene\(\) first"):
        solver.set_instance_transform(0, (1, 1, 1))
    with pytest.raises(RuntimeError, match=r"step\(\) first"):
        solver.reaction_budget_terms()
    assert solver.hydro_force_torque_reaction().shape == (2, 0, 3)
    box_with(solver, ((3, 3, 3), 2.0))
    for call in (solver.hydro_force_torque_reaction, solver.force_shares):
        with pytest.raises(RuntimeError, match=r"call step\(\) first"):
            call()
    solver.step()
    assert solver.hydro_force_torque_reaction().shape == (2, 1, 3)
    solver.set_scene(*spheres(((3, 3, 3), 2.0), ((0, 0, 0), 1.0)))
    with pytest.raises(RuntimeError, match=r"call step\(\) first"):
        solver.hydro_force_torque_reaction()


@pytest.mark.parametrize(
    ("name", "subject"),
    [
        ("enable_vof", "two-phase"),
        ("set_surface_tension", "two-phase"),
        ("apply_phase_change", "phase change"),
        ("set_porous_continuity", "porous"),
        ("set_scalar_solid", "conjugate"),
        ("set_property_model", "variable fluid properties"),
        ("set_collocated_scheme", "collocated"),
    ],
)
def test_what_is_left_out_says_so(solver, name, subject):
    for owner in (solver, solver.diagnostics):
        assert not hasattr(owner, name)
        with pytest.raises(AttributeError, match=f"{subject}.*not part of peclet-resolved"):
            getattr(owner, name)


def test_unknown_names_and_the_collocated_solver_are_plain_attribute_errors(solver):
    with pytest.raises(AttributeError, match="no attribute 'stepp'"):
        solver.stepp()
    with pytest.raises(AttributeError, match="not part of peclet-resolved"):
        _ = flow.SolverColocated


def warned(call, category=RuntimeWarning):
    """The one warning of a call; it must point to this file."""
    with pytest.warns(category) as caught:
        call()
    assert len(caught) == 1
    assert os.path.samefile(caught[0].filename, __file__)
    return str(caught[0].message)


def test_warnings_point_to_the_caller():
    solver = small_solver()
    assert "multigrid" in warned(lambda: solver.set_pressure_multigrid(False))
    assert "set_pressure_pcg" in warned(lambda: solver.set_pressure_pcg(False))
    assert "projected" in warned(lambda: solver.set_solid_from_scene(cutcell_pressure=False))
    assert "always on" in warned(lambda: solver.set_fresh_cell_seed(False))
    assert "always on" in warned(lambda: solver.diagnostics.set_wall_flux_divergence(False))
    assert "one pass" in warned(lambda: solver.set_outer_iterations(3))
    solver.set_velocity_solver_params(1, rtol=1e-13)
    assert "velocity solve met its cap of 1 iterations" in warned(solver.step)
    assert not solver.velocity_report.converged
    solver.set_velocity_solver_params(200, rtol=1e-8)
    solver.set_pressure_pcg(True, 1, 1e-12)
    solver.set_body_force(0.3, 0.2, 0.1)
    assert "pressure solve met its cap of 1 iterations" in warned(solver.step)
    assert solver.pressure_solve_failed()
    assert solver.diagnostics.last_pressure_iterations() == 1


def test_old_force_names_warn_and_return_the_reaction(solver):
    expected = solver.hydro_force_torque_reaction()
    for owner, call in ((solver, "hydro_force_torque"), (solver.diagnostics, "hydro_force_torque_traction")):
        with pytest.warns(DeprecationWarning, match="hydro_force_torque_reaction") as caught:
            np.testing.assert_array_equal(getattr(owner, call)(), expected)
        assert os.path.samefile(caught[0].filename, __file__)


def test_ordinary_use_is_silent():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solver = small_solver()
        solver.set_velocity_solver_params(60)
        solver.set_pressure_multigrid(True, levels=6)
        solver.set_pressure_solver_params(200)
        solver.set_velocity_multigrid(True)
        solver.set_solid(np.full(SHAPE, 5.0))
        solver.step()


def step_for_long(solver):
    for _ in range(10**6):
        solver.step()


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="needs POSIX signals")
def test_control_c_stops_between_steps():
    solver = small_solver()
    main = threading.get_ident()
    timer = threading.Timer(0.3, lambda: signal.pthread_kill(main, signal.SIGINT))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in background jobs
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            step_for_long(solver)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)
    steps = solver.number_of_steps
    solver.step()
    assert solver.number_of_steps == steps + 1
    assert np.isfinite(solver.get_u()).all()


def test_long_calls_let_other_threads_run():
    solver = flow.Solver(32, 32, 32)
    solver.set_dt(1.0)
    solver.set_body_force(1e-3, 0, 0)
    ran_during_a_step = False
    for _ in range(500):  # on a busy machine the other thread misses its chance in many of them
        about_to_step, ran = threading.Event(), threading.Event()
        other = threading.Thread(target=lambda start=about_to_step, end=ran: (start.wait(), end.set()))
        other.start()
        about_to_step.set()
        solver.step()
        ran_during_a_step = ran_during_a_step or ran.is_set()
        other.join()
        if ran_during_a_step:
            break
    assert ran_during_a_step
