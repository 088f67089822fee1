"""Conduction and transport of scalars against exact solutions."""

import numpy as np
import pytest
from peclet import flow

from examples.validation.heat import INNER, OUTER, conduct, hot_sphere, hot_sphere_exact
from examples.validation.results import orders


def test_heat_that_enters_a_shell_leaves_it():
    shell = hot_sphere(16)
    assert np.abs(shell.difference(hot_sphere_exact(shell.radius))).max() <= 0.01
    assert shell.inner_flux + shell.outer_flux == pytest.approx(0, abs=1e-5 * shell.inner_flux)


def flux_inside(cells):
    """Unit flux from the inner sphere: largest error, and error of the area."""
    shell = conduct(cells, ("neumann", 1.0), ("dirichlet", 0.0))
    error = shell.difference(INNER**2 * (1 / shell.radius - 1 / OUTER))
    return np.abs(error).max() / INNER, shell.inner_flux / (4 * np.pi * INNER**2) - 1


def flux_outside(cells):
    """Unit flux from the hollow wall."""
    shell = conduct(cells, ("dirichlet", 0.0), ("neumann", 1.0))
    error = shell.difference(OUTER**2 * (1 / INNER - 1 / shell.radius))
    return np.abs(error).max() / OUTER, shell.outer_flux / (4 * np.pi * OUTER**2) - 1


@pytest.mark.parametrize("case", [flux_inside, flux_outside])
def test_flux_from_a_wall(case):
    error, area = case(16)
    assert error <= 0.025
    assert abs(area) <= 0.025


@pytest.mark.slow
def test_conduction_between_values_is_of_second_order():
    errors = []
    for cells in (12, 24, 48):
        shell = hot_sphere(cells)
        errors.append(np.sqrt(np.mean(shell.difference(hot_sphere_exact(shell.radius)) ** 2)))
    assert orders(errors).mean() >= 1.9


@pytest.mark.slow
@pytest.mark.parametrize("case", [flux_inside, flux_outside])
def test_conduction_from_a_flux_is_of_second_order(case):
    errors, areas = np.transpose([case(cells) for cells in (12, 24, 48)])
    assert orders(errors).mean() >= 1.7
    assert orders(areas).mean() >= 1.8


def wave_error(cells, scheme, diffusivity):
    """A wave carried obliquely through half a period while it decays; dt proportional to the spacing."""
    solver = flow.Solver((cells, cells, 1), extent=(1, 1, 0.1))
    solver.set_mu(0)
    shape = (cells, cells, 1)
    solver.set_state(np.full(shape, 1.0), np.full(shape, 0.5), np.zeros(shape))
    solver.set_dt(0.2 / cells)
    x, y, _ = solver.cell_centers()

    def exact(time):
        decay = np.exp(-8 * np.pi**2 * diffusivity * time)
        phase = 2 * np.pi * np.add.outer(x - time, y - 0.5 * time)
        return 1 + decay * np.sin(phase)[:, :, None]

    solver.add_scalar("c", diffusivity, scheme)
    solver.set_field("c", exact(0))
    for _ in range(round(0.5 / solver.dt)):
        solver.step()
    return np.sqrt(np.mean((solver.get_field("c") - exact(0.5)) ** 2))


@pytest.mark.parametrize(("scheme", "order"), [("fou", 0.75), ("sou", 1.9), ("koren", 1.8)])
def test_transport_converges_at_design_order(scheme, order):
    errors = [wave_error(cells, scheme, 2e-3) for cells in (24, 48, 96)]
    assert orders(errors)[-1] >= order
    if scheme == "koren":
        assert errors[-1] < 2e-3


def test_diffusion_is_of_second_order_in_time():
    """The decay of one wave on a fine grid, against its semi-discrete solution."""
    cells, rate = 64, 2 * (1 - np.cos(2 * np.pi / 64)) * 64**2
    errors = []
    for steps in (10, 20, 40):
        solver = flow.Solver((cells, 1, 1), extent=(1, 1 / 64, 1 / 64))
        solver.add_scalar("c", 1.0, iters=5000)
        solver.set_scalar_residual_tolerance("c", 1e-11)
        wave = np.sin(2 * np.pi * np.arange(cells) / cells).reshape(-1, 1, 1)
        solver.set_field("c", wave)
        duration = 1 / rate
        # a short first step, of first order, does not spoil the order of the others
        solver.set_dt(duration / steps**2)
        solver.step()
        solver.set_dt((duration - solver.time) / steps)
        for _ in range(steps):
            solver.step()
        errors.append(np.abs(solver.get_field("c") - np.exp(-1) * wave).max())
    assert orders(errors).mean() >= 1.7
