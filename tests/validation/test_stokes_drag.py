"""Stokes drag of a simple cubic array of spheres: force budget and order; the page has the drags."""

import numpy as np
import pytest

from examples.validation.arrays import drag_at_rest
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
