"""What the flow cases share: published values, boxes with spheres, budgets, orders of convergence."""

import csv
import pathlib
from dataclasses import dataclass

import numpy as np
from peclet import flow

from tests.python.flow_scenes import spheres

DATA = pathlib.Path(__file__).parent / "data"


@dataclass(frozen=True)
class Row:
    """One line of the table of results: found is compared with reference, error is what the target bounds."""

    case: str
    reference: float
    found: float
    error: float
    target: float
    order: float | None = None


def published(table, **selection):
    """The rows of data/<table>.csv whose columns have these values."""
    with (DATA / f"{table}.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [row for row in rows if all(row[name] == value for name, value in selection.items())]


def radius_of(solid_fraction, volume):
    """Radius of the sphere that fills this fraction of the volume."""
    return (3 * solid_fraction * volume / (4 * np.pi)) ** (1 / 3)


def box_of_fluid(cells, *, rho=1.0, mu=1.0, dt=1.0, force=(0, 0, 0), scheme=None):
    """A periodic box in cell units; no advection without a scheme."""
    solver = flow.Solver(*((cells,) * 3 if np.isscalar(cells) else cells))
    solver.set_rho(rho)
    solver.set_mu(mu)
    solver.set_dt(dt)
    solver.set_body_force(*force)
    if scheme:
        solver.set_advection_scheme(scheme)
        solver.set_advection(True)
    return solver


def put_spheres(solver, *bodies):
    """Spheres (centre, radius, velocity, angular velocity), repeated with the box; fluid at rest."""
    solver.set_scene(*spheres(*bodies), periodic=True)
    solver.set_solid_from_scene()
    return solver


def velocities(solver):
    """The three components, zero inside bodies, stacked."""
    return np.array([solver.get_u(), solver.get_v(), solver.get_w()])


def fluid_points(solver):
    """Where a velocity component is an unknown."""
    return np.array([solver.get_ox(), solver.get_oy(), solver.get_oz()]) > 0


def stream(solver, velocity):
    """Fluid moving uniformly."""
    shape = tuple(solver.cells)
    solver.set_state(*(np.full(shape, float(component)) for component in velocity))


def march(solver, *, steps, change):
    """Step until the mean velocity changes by less than a fraction of itself; returns the mean velocity."""
    old = velocities(solver).mean(axis=(1, 2, 3))
    for _ in range(steps):
        solver.step()
        new = velocities(solver).mean(axis=(1, 2, 3))
        if np.abs(new - old).max() <= change * np.abs(new).max():
            return new
        old = new
    raise AssertionError(f"not steady after {steps} steps")


def orders(errors, factor=2):
    """Observed orders between successive refinements by factor."""
    errors = np.asarray(errors)
    return np.log(errors[:-1] / errors[1:]) / np.log(factor)
