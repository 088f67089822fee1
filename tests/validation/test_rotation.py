"""Torque on a sphere that spins in a cubic periodic cell, Stokes flow."""

import numpy as np
import pytest

from tests.validation.helpers import Row, box_of_fluid, orders, published, put_spheres, radius_of

MU, SPIN = 0.5, 0.01


def torque_of_array(cells, solid_fraction, shift, target):
    """-T / (8 pi mu a^3 Omega), Omega along y; and the largest torque across over that one."""
    radius = radius_of(solid_fraction, cells**3)
    solver = box_of_fluid(cells, mu=MU, dt=20 * (cells / 20) ** 2)
    put_spheres(solver, ((cells - 1) / 2 + np.array(shift), radius, (0, 0, 0), (0, SPIN, 0)))
    torque = np.zeros(3)
    for _ in range(60):
        solver.step()
        old, torque = torque, solver.hydro_force_torque_reaction()[1, 0]
        if np.abs(torque - old).max() <= 1e-5 * np.abs(torque).max():
            break
    else:
        raise AssertionError("not steady")
    (line,) = published("sphere_arrays_stokes", solid_fraction=str(solid_fraction))
    exact = float(line["torque_factor_T_over_8pi_mu_a3_Omega"])
    found = -torque[1] / (8 * np.pi * MU * radius**3 * SPIN)
    row = Row(f"phi {solid_fraction}, {cells} cells, shift {shift}", exact, found, found / exact - 1, target)
    return row, np.abs(torque[[0, 2]]).max() / abs(torque[1])


def check(row, across):
    assert abs(row.error) <= row.target
    assert across <= 2e-3


def test_torque_of_a_spinning_sphere():
    check(*torque_of_array(19, 0.125, (0.3, 0.1, -0.2), 0.02))


def test_no_torque_across_by_symmetry():
    _, across = torque_of_array(16, 0.064, (0, 0, 0), 0.03)
    assert across <= 1e-7  # tolerance of the viscous solve


@pytest.mark.slow
@pytest.mark.parametrize(("solid_fraction", "cells"), [(0.027, 32), (0.064, 24), (0.125, 19)])
@pytest.mark.parametrize("shift", [(0, 0, 0), (0.25, 0.37, 0.11)])
def test_torque_at_twelve_cells_per_diameter(solid_fraction, cells, shift):
    check(*torque_of_array(cells, solid_fraction, shift, 0.02))


@pytest.mark.slow
def test_torque_converges():
    shifts = ((0, 0, 0), (0.5, 0.5, 0.5), (0.25, 0.37, 0.11))
    errors = [
        np.sqrt(np.mean([torque_of_array(cells, 0.125, shift, 0.1)[0].error ** 2 for shift in shifts]))
        for cells in (8, 16, 32)
    ]
    assert errors[-1] <= 5e-3
    assert orders(errors).mean() >= 1.5
