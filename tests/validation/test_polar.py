"""The reference for the oscillating cylinder beside an exact solution, published numbers and its record."""

import numpy as np
import pytest
from scipy.special import kv

from examples.validation import polar
from examples.validation.cylinder import OMEGA, PERIOD, Oscillation, unbounded_force

STEPS = 400


def stokes_force(time, reynolds):
    """Without advection, velocity -cos(omega t): -rho pi a^2 (1 + 4 K1(z) / (z K0(z))) dU/dt [Stokes1851]."""
    z = polar.RADIUS * np.sqrt(1j * OMEGA * reynolds)
    amplitude = 2j * OMEGA * np.pi * polar.RADIUS**2 * (1 + 4 * kv(1, z) / (z * kv(0, z)))
    return (amplitude * np.exp(1j * OMEGA * time)).real


def test_force_without_advection_is_that_of_stokes_with_second_order():
    errors = []
    for rings in (100, 200):
        time, force = polar.run(polar.PolarGrid(1, rings, 60, advection=False), STEPS, 6)
        exact = stokes_force(time, polar.REYNOLDS)
        errors.append(np.abs(force - exact)[-STEPS:].max() / np.abs(exact).max())
    assert errors[1] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 1.8


def test_recorded_force_is_what_the_module_computes():
    time, force = polar.run(polar.PolarGrid(24, 150, 40), STEPS, 6)
    assert Oscillation(time, force, STEPS).deviation(*unbounded_force()) < 0.01


def test_recorded_force_has_the_published_coefficients():
    phase, force = unbounded_force()
    drag, added = Oscillation(phase * PERIOD, force, len(phase)).morison()
    assert drag == pytest.approx(2.09, rel=0.01)
    assert added == pytest.approx(1.45, rel=0.01)


def test_recorded_force_is_odd_under_half_a_period():
    _, force = unbounded_force()
    half = len(force) // 2
    assert force[half:] == pytest.approx(-force[:half], abs=0.01 * np.abs(force).max())
