"""Conduction and transport of scalars against exact solutions."""

import numpy as np
import pytest
from peclet import flow

from tests.python.flow_scenes import spheres
from tests.validation.helpers import Row, orders

# A spherical shell of fluid between a small body and the inside of a hollow solid, off the lattice.
INNER, OUTER = 0.2, 0.45
CENTER = np.array([0.513, 0.521, 0.483])


def shell(cells, inner, outer, *, change=1e-6):
    """Steady conduction with diffusivity 1 and conditions (type, value) on both walls: field and balances.

    Returns the field at fluid cells, their radii, and the amounts per time from the inner and outer wall.
    """
    solver = flow.Solver((cells, cells, cells), extent=(1, 1, 1))
    x, y, z = solver.cell_centers()
    squares = np.add.outer(np.add.outer((x - CENTER[0]) ** 2, (y - CENTER[1]) ** 2), (z - CENTER[2]) ** 2)
    radius = np.sqrt(squares)
    solver.set_scene(*spheres((CENTER, INNER)))
    solver.set_solid(OUTER - radius)
    solver.add_scalar("t", 1.0, iters=2000)
    solver.set_scalar_wall("t", *outer)
    solver.set_scalar_wall("t", *inner, instance=0)
    solver.set_dt(0.05)
    old = solver.get_field("t")
    for _ in range(300):
        solver.advance_scalars()
        new = solver.get_field("t")
        if np.abs(new - old).max() < change:
            break
        old = new
    else:
        raise AssertionError("not steady")
    fluid = (radius > INNER) & (radius < OUTER)
    budget = solver.scalar_budget("t")
    return new[fluid], radius[fluid], budget["bodies"][0], budget["sampled"]


def value_outside_value(cells):
    """Unit difference: largest and rms error, and the Nusselt number Q / (pi d D) of the inner sphere."""
    found, r, given, taken = shell(cells, ("dirichlet", 1.0), ("dirichlet", 0.0))
    error = np.abs(found - (1 / r - 1 / OUTER) / (1 / INNER - 1 / OUTER))
    return error.max(), np.sqrt(np.mean(error**2)), given / (2 * np.pi * INNER), given + taken


def flux_inside(cells):
    """Unit flux from the inner sphere."""
    found, r, given, _ = shell(cells, ("neumann", 1.0), ("dirichlet", 0.0))
    error = np.abs(found - INNER**2 * (1 / r - 1 / OUTER))
    return error.max() / INNER, given / (4 * np.pi * INNER**2) - 1


def flux_outside(cells):
    """Unit flux from the hollow wall."""
    found, r, given, _ = shell(cells, ("dirichlet", 0.0), ("neumann", 1.0))
    error = np.abs(found - OUTER**2 * (1 / INNER - 1 / r))
    return error.max() / OUTER, given / (4 * np.pi * OUTER**2) + 1


def nusselt_row(cells, found, target):
    exact = 2 / (1 - INNER / OUTER)
    return Row(f"concentric spheres, {cells} cells", exact, found, found / exact - 1, target)


def test_conduction_between_concentric_spheres():
    largest, _, nusselt, rest = value_outside_value(16)
    row = nusselt_row(16, nusselt, 5e-3)
    assert abs(row.error) <= row.target
    assert largest <= 0.01
    assert abs(rest) <= 1e-5 * nusselt


def test_flux_from_a_sphere():
    error, area = flux_inside(16)
    assert error <= 0.02
    assert abs(area) <= 0.025


@pytest.mark.slow
def test_conduction_is_of_second_order():
    results = [value_outside_value(cells) for cells in (12, 24, 48)]
    assert orders([rms for _, rms, _, _ in results]).mean() >= 1.9
    row = nusselt_row(48, results[-1][2], 1e-3)
    assert abs(row.error) <= row.target
    for case in (flux_inside, flux_outside):
        errors, areas = np.transpose([case(cells) for cells in (12, 24, 48)])
        assert orders(errors).mean() >= 1.7
        assert orders(np.abs(areas)).mean() >= 1.8


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
