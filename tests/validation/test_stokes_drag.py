"""Stokes drag of a simple cubic array of spheres against values from a singularity method."""

import numpy as np
import pytest

from tests.validation.helpers import (
    Row,
    box_of_fluid,
    march,
    orders,
    published,
    put_spheres,
    radius_of,
)

FORCE = 1e-3
# Where the sphere sits in its cell: on a cell centre, on a corner, and anywhere.
SHIFTS = ((0, 0, 0), (0.5, 0.5, 0.5), (0.3, 0.1, -0.2), (0.25, 0.37, 0.11))


def drag_of_array(cells, solid_fraction, shift):
    """K = f L^3 / (6 pi mu a U), U the mean velocity with zero inside the sphere, and the force on it.

    The force is in units of (1 - phi) f L^3, what the fluid receives from the body force.
    """
    radius = radius_of(solid_fraction, cells**3)
    center = (cells - 1) / 2 + np.array(shift)
    solver = box_of_fluid(cells, dt=2.0 * (cells / 16) ** 2, force=(FORCE, 0, 0))
    put_spheres(solver, (center, radius))
    mean = march(solver, steps=400, change=1e-7)[0]
    force = solver.hydro_force_torque_reaction()[0, 0, 0]
    return FORCE * cells**3 / (6 * np.pi * radius * mean), force / ((1 - solid_fraction) * FORCE * cells**3)


def rows_of(cells, solid_fraction, shifts, target):
    """One row per shift, and the force ratios."""
    (line,) = published("sphere_arrays_stokes", solid_fraction=str(solid_fraction))
    exact = float(line["K_computed"])
    results = [drag_of_array(cells, solid_fraction, shift) for shift in shifts]
    rows = [
        Row(f"phi {solid_fraction}, {cells} cells, shift {shift}", exact, K, K / exact - 1, target)
        for shift, (K, _) in zip(shifts, results, strict=True)
    ]
    return rows, [ratio for _, ratio in results]


def check(rows, force_ratios):
    assert max(abs(row.error) for row in rows) <= rows[0].target
    # The grid must not be felt: the same array at any place.
    drags = [row.found for row in rows]
    assert max(drags) - min(drags) <= 2e-3 * min(drags)
    # The steady force is the one that drives the fluid; the fluid fills 1 - phi of the cell up to the
    # second-order error of counting points.
    assert force_ratios == pytest.approx(np.ones(len(rows)), abs=6e-3)


def test_drag_at_16_cells_per_side():
    check(*rows_of(16, 0.125, SHIFTS[::2], 5e-3))


@pytest.mark.slow
@pytest.mark.parametrize("solid_fraction", [0.027, 0.064, 0.125])
@pytest.mark.parametrize(("cells", "target"), [(16, 5e-3), (32, 3.5e-3)])
def test_drag_of_dilute_and_dense_arrays(solid_fraction, cells, target):
    check(*rows_of(cells, solid_fraction, SHIFTS, target))


@pytest.mark.slow
def test_drag_converges_with_second_order():
    # Shifted positions average out how the lattice of points cuts the sphere.
    errors = []
    for cells in (6, 12, 24):
        rows, _ = rows_of(cells, 0.125, SHIFTS, 1.0)
        errors.append(np.sqrt(np.mean([row.error**2 for row in rows])))
    assert orders(errors).mean() >= 1.8
