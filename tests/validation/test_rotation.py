"""Torque on a sphere that spins in a cubic periodic cell, Stokes flow: its order; values are on the page."""

import numpy as np
import pytest

from examples.validation.arrays import torque
from examples.validation.comparisons import SHIFTS
from examples.validation.results import orders, published


def test_no_torque_across_by_symmetry():
    _, across = torque(16, 0.064)
    assert across <= 1e-7  # tolerance of the viscous solve


@pytest.mark.slow
def test_torque_converges():
    (line,) = published("sphere_arrays_stokes", solid_fraction="0.125")
    exact = float(line["torque_factor_T_over_8pi_mu_a3_Omega"])
    errors = [
        np.sqrt(np.mean([(torque(cells, 0.125, SHIFTS[n])[0] / exact - 1) ** 2 for n in (0, 1, 3)]))
        for cells in (8, 16, 32)
    ]
    assert errors[-1] <= 5e-3
    assert orders(errors).mean() >= 0.9
