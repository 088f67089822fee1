"""March to a steady flow: the stop is certified, acceleration saves steps, what fails says why."""

import numpy as np
import pytest
from peclet import flow
from peclet.core import geom


def channel(dt=0.3):
    solver = flow.Solver((3, 10, 2), extent=(1, 1, 1))
    solver.set_domain_bc("-y", "wall")
    solver.set_domain_bc("+y", "wall")
    solver.set_mu(1)
    solver.set_dt(dt)
    solver.set_body_force(12, 0, 0)
    return solver


def array_of_spheres(dt):
    solver = flow.Solver(12, 12, 12)
    builder = geom.SceneBuilder()
    sphere = builder.add_leaf("sphere", [4.1])
    builder.add_instance(sphere, translation=[6.2, 5.9, 6.1])
    solver.set_scene(*builder.encode(), periodic=True)
    solver.set_solid_from_scene()
    solver.set_mu(0.1)
    solver.set_dt(dt)
    solver.set_body_force(1e-3, 0, 0)
    return solver


def mean_velocity(solver):
    return solver.get_u().mean()


def test_reaches_the_discrete_steady_state():
    # the exact mean is 1; the grid of 10 cells, whose stencils are exact for parabolas, samples 1 + 1/200
    result = flow.march_to_steady(channel(), mean_velocity, rtol=1e-8)
    assert result.converged
    assert result.value == pytest.approx(1.005, abs=1e-6)
    assert result.residual < 1e-8
    assert result.history[-1] == (result.steps, result.value)


def test_the_certified_error_holds():
    exact = flow.march_to_steady(array_of_spheres(5), mean_velocity, rtol=1e-9).value
    for accelerate in (True, False):
        result = flow.march_to_steady(
            array_of_spheres(5), mean_velocity, rtol=1e-3, accelerate=accelerate, check_every=3
        )
        assert result.converged
        assert abs(result.value - exact) < 2e-3 * exact


def test_acceleration_saves_steps():
    steps = {
        on: flow.march_to_steady(array_of_spheres(2), mean_velocity, rtol=1e-6, accelerate=on).steps
        for on in (True, False)
    }
    assert steps[True] < 0.6 * steps[False]


def test_ends_at_max_steps_or_by_callback():
    result = flow.march_to_steady(channel(dt=1e-3), mean_velocity, max_steps=7, check_every=3)
    assert (result.converged, result.steps) == (False, 7)
    assert "max_steps" in result.reason
    seen = []
    result = flow.march_to_steady(
        channel(dt=1e-3), mean_velocity, callback=lambda r: seen.append(r.steps) or len(seen) == 2
    )
    assert seen == [5, 10]
    assert (result.converged, result.reason) == (False, "stopped by callback")


def test_monitor_without_arguments_and_callback_with_two():
    solver, seen = channel(), []
    result = flow.march_to_steady(
        solver,
        lambda: solver.get_u().mean(),
        max_steps=10,
        callback=lambda steps, phase: seen.append((steps, phase)),
    )
    assert result.monitor == result.value == solver.get_u().mean()
    assert seen[:2] == [(5, "accelerate"), (10, "accelerate")]


def test_a_slow_drift_is_not_taken_for_the_end():
    values = iter(1 - 0.5 * 0.9995 ** np.arange(1000))
    result = flow.march_to_steady(
        channel(), lambda _: next(values), rtol=1e-2, max_steps=100, check_every=1, accelerate=False
    )
    assert not result.converged


@pytest.mark.parametrize(
    ("error", "name", "options"),
    [
        (ValueError, "rtol", {"rtol": 0.0}),
        (ValueError, "max_steps", {"max_steps": 0}),
        (ValueError, "slow_rate", {"slow_rate": 1.0}),
        (ValueError, "window", {"window": 0}),
        (TypeError, "accelerate", {"accelerate": "yes"}),
        (TypeError, "monitor", {"monitor": 1.0}),
        (RuntimeError, "monitor", {"monitor": lambda _: np.nan}),
    ],
)
def test_bad_arguments_are_named(error, name, options):
    with pytest.raises(error, match=name):
        flow.march_to_steady(channel(), **{"monitor": mean_velocity} | options)


@pytest.mark.parametrize("dt", [0.1, 1.0])
def test_the_viscous_solve_meets_its_tolerance_all_the_way_to_the_steady_state(dt):
    solver = flow.Solver((32, 32, 2), extent=(1, 1, 0.1))
    x, y, z = np.meshgrid(*solver.cell_centers(), indexing="ij")
    solver.set_solid(0.4 - np.hypot(x - 0.5, y - 0.5) + 0 * z)
    solver.set_mu(1.0)
    solver.set_dt(dt)
    solver.set_body_force(0, 0, 1.0)
    for _ in range(15):
        solver.step()
        assert solver.velocity_report.converged
