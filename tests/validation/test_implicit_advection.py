"""Implicit advection: stable at large Courant numbers, exact budgets, the steady flow of the scheme."""

import numpy as np
import pytest
from peclet import flow

from examples.validation.results import orders
from tests.python.flow_scenes import spheres
from tests.validation.helpers import box_of_fluid, fluid_points, put_spheres, stream, velocities

SCHEMES = ["sou", "koren", "central"]


def tighten(solver):
    solver.set_velocity_residual_tolerance(1e-11)
    solver.set_pressure_tolerance(1e-9)
    return solver


def vortices(dt, scheme):
    """Velocity of decaying vortices in a stream after a time of 0.4, and the largest Courant number."""
    n = 24
    solver = flow.Solver((n, n, 1), extent=(1, 1, 0.1))
    solver.set_mu(0.01)
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    solver.set_implicit_advection(True)
    x, y, _ = solver.cell_centers()
    x, y, h, k = x[:, None, None], y[None, :, None], 1 / n, 2 * np.pi
    u = 0.4 - np.cos(k * (x - h / 2)) * np.sin(k * y)
    v = -0.3 + np.sin(k * x) * np.cos(k * (y - h / 2))
    solver.set_state(u, v, np.zeros((n, n, 1)))
    solver.set_dt(dt)
    largest = 0.0
    for _ in range(round(0.4 / dt)):
        solver.step()
        largest = max(largest, solver.courant_number)
    return np.stack([solver.get_u(), solver.get_v()]), largest


@pytest.mark.parametrize("scheme", SCHEMES)
def test_second_order_in_time(scheme):
    (exact, _), *runs = (vortices(dt, scheme) for dt in (0.000625, 0.01, 0.005, 0.0025))
    assert max(courant for _, courant in runs) < 0.5
    errors = [np.sqrt(np.mean((u - exact) ** 2)) for u, _ in runs]
    assert min(orders(errors)) >= 1.9
    assert errors[-1] <= 1e-4


def cavity(scheme):
    n = 24
    solver = tighten(flow.Solver((n, n, 1), extent=(1, 1, 1 / n)))
    solver.set_mu(1 / 100)
    for face in ("-x", "+x", "-y"):
        solver.set_domain_bc(face, "wall")
    solver.set_domain_bc("+y", "wall", velocity=(1, 0, 0))
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    return solver


def sphere_in_a_stream(scheme):
    cells = (24, 12, 12)
    solver = tighten(flow.Solver(*cells))
    solver.set_mu(0.15)
    solver.set_domain_bc("-x", "inflow", velocity=(1, 0, 0))
    solver.set_domain_bc("+x", "outflow")
    for face in ("-y", "+y", "-z", "+z"):
        solver.set_domain_bc(face, "slip")
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    solver.set_scene(*spheres(((7.5, 5.5, 5.5), 2.5)), periodic=False)
    solver.set_solid_from_scene()
    solver.set_state(np.ones(cells), np.zeros(cells), np.zeros(cells))
    return solver


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("setup", "dt", "small", "courant"),
    [(cavity, 10 / 24, 0.2 / 24, 8), (sphere_in_a_stream, 5.0, 0.1, 5)],
    ids=["cavity", "sphere"],
)
def test_a_steady_flow_is_that_of_the_explicit_scheme(setup, dt, small, courant, scheme):
    solver = setup(scheme)
    solver.set_implicit_advection(True)
    solver.set_dt(dt)
    for _ in range(200):
        solver.step()
        assert solver.velocity_report.converged
    assert solver.courant_number > courant
    steady = velocities(solver)
    solver.step()
    assert np.abs(velocities(solver) - steady).max() < 1e-7
    explicit = setup(scheme)
    explicit.restore(solver.checkpoint())
    explicit.set_dt(small)
    for _ in range(100):
        explicit.step()
    assert np.abs(velocities(explicit) - steady).max() < 1e-6
    if solver.num_scene_instances():
        forces = [s.hydro_force_torque_reaction()[0, 0] for s in (solver, explicit)]
        np.testing.assert_allclose(*forces, rtol=0, atol=1e-6 * np.abs(forces[1]).max())


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dt", [0.5, 20.0])
@pytest.mark.parametrize("moving", [False, True], ids=["fixed", "moving"])
@pytest.mark.parametrize("sides", ["periodic", "slip"])
def test_forces_close_the_momentum_budget(scheme, dt, moving, sides):
    force = np.array([1e-2, 3e-3, -2e-3]) / dt
    solver = box_of_fluid((18, 14, 16), rho=1.3, mu=0.2, dt=dt, force=force, scheme=scheme)
    solver.set_implicit_advection(True)
    # a slip side pushes across itself only
    components = {"periodic": [0, 1, 2], "slip": [0]}[sides]
    if sides == "slip":
        for face in ("-y", "+y", "-z", "+z"):
            solver.set_domain_bc(face, "slip")
    velocity = np.array([0.2, -0.1, 0.05]) * moving * min(1, 2 / dt)
    spin = (0.02 * moving, 0, -0.03 * moving)
    position = np.array([5.3, 6.1, 7.8])
    put_spheres(solver, (position, 2.7, velocity, spin), ((12.2, 8.9, 4.3), 2.9))
    stream(solver, (1, 0.3, 0.5))
    for _ in range(4):
        position = position + dt * velocity
        solver.set_instance_transform(0, position)
        solver.rebuild_geometry()
        before = velocities(solver)
        solver.step()
        fluid = fluid_points(solver)
        gained = [d[m].sum() for d, m in zip(velocities(solver) - before, fluid, strict=True)]
        change, supplied = 1.3 / dt * np.array(gained), force * fluid.sum(axis=(1, 2, 3))
        supplied += solver.reaction_budget_terms()[1]
        loss = solver.hydro_force_torque_reaction()[0].sum(axis=0)
        largest = max(np.abs(term).max() for term in (loss, change, supplied))
        assert np.abs(loss + change - supplied)[components].max() <= 1e-10 * largest
    assert (solver.courant_number > 10) == (dt > 1)


def test_a_body_and_a_stream_move_together():
    velocity = np.array([0.5, -0.3, 0.2])
    solver = box_of_fluid((14, 12, 13), mu=0.1, dt=6.0, scheme="sou")
    solver.set_implicit_advection(True)
    position = np.array([5.3, 6.1, 4.8])
    put_spheres(solver, (position, 2.7, velocity, (0, 0, 0)))
    stream(solver, velocity)
    for _ in range(4):
        position = position + 6 * velocity
        solver.set_instance_transform(0, position)
        solver.rebuild_geometry()
        solver.step()
        moving = fluid_points(solver)
        for u, m, expected in zip(velocities(solver), moving, velocity, strict=True):
            np.testing.assert_allclose(u[m], expected, atol=1e-9)


def test_a_run_goes_on_from_a_checkpoint():
    solver = sphere_in_a_stream("koren")
    solver.set_implicit_advection(True)
    solver.set_dt(3.0)
    for _ in range(3):
        solver.step()
    state = solver.checkpoint()
    other = sphere_in_a_stream("koren")
    other.set_implicit_advection(True)
    other.set_dt(3.0)
    other.restore(state)
    for s in (solver, other):
        for _ in range(2):
            s.step()
    np.testing.assert_array_equal(velocities(solver), velocities(other))


def test_marching_finds_the_steady_flow():
    solver = cavity("koren")
    solver.set_implicit_advection(True)
    solver.set_dt(0.5)
    result = flow.march_to_steady(solver, lambda s: float(np.abs(s.get_v()).mean()), rtol=1e-8)
    assert result.converged
    plain = cavity("koren")
    plain.set_dt(0.2 / 24)
    plain.restore(solver.checkpoint())
    for _ in range(100):
        plain.step()
    assert np.abs(plain.get_v()).mean() == pytest.approx(result.value, rel=1e-6)
