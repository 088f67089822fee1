"""Stokes drag of a simple cubic array of spheres: force budget and order; the page has the drags."""

import numpy as np
import pytest

from examples.validation.arrays import drag_at_rest, make_array
from examples.validation.comparisons import SHIFTS, exact_drag
from examples.validation.results import orders


@pytest.mark.parametrize("shift", SHIFTS[::3])
def test_force_is_what_drives_the_fluid(shift):
    # the fluid fills 1 - phi of the cell up to the second-order error of counting points
    _, force = drag_at_rest(16, 0.125, shift)
    assert force == pytest.approx(1, abs=6e-3)


@pytest.mark.slow
def test_drag_converges_with_second_order():
    # Shifted positions average out how the lattice of points cuts the sphere.
    exact = exact_drag(0.125)
    errors = [
        np.sqrt(np.mean([(drag_at_rest(cells, 0.125, shift)[0] / exact - 1) ** 2 for shift in SHIFTS]))
        for cells in (6, 12, 24)
    ]
    assert orders(errors).mean() >= 1.8


def test_pressure_in_cut_cells_settles_with_the_rest():
    # 11 steps leave 1.6e-4 of the mean velocity; where the pressure of a cell moves by its open part, 1.5e-3
    solver = make_array(16, 0.125, 7.5 + np.array((0.3, 0.1, -0.2)), 1000.0, 1.0)
    solver.set_body_force(1e-3, 0, 0)
    means = []
    for _ in range(60):
        solver.step()
        means.append(solver.get_u().mean())
    assert means[10] == pytest.approx(means[-1], rel=3e-4)
