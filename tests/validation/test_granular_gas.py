"""Cooling of a gas of smooth inelastic spheres: Haff's law T = T0 / (1 + t/tau)^2."""

import numpy as np
import pytest
from peclet import dem


def gas(per_side, fraction):
    """Spheres of diameter 1 and mass 1 at temperature 1 in a periodic cube, and its length."""
    count = per_side**3
    length = (count * np.pi / 6 / fraction) ** (1 / 3)
    sites = np.stack(np.meshgrid(*[np.arange(per_side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    velocities = np.random.default_rng(1).normal(size=(count, 3))
    velocities -= velocities.mean(axis=0)
    velocities /= np.sqrt(np.mean(velocities**2))
    sim = dem.Simulation(count)
    sim.set_sphere_shape(0.5)
    sim.set_domain((length,) * 3, periodic=(True,) * 3)
    sim.set_positions((sites + 0.5) * length / per_side)
    sim.set_velocities(velocities)
    return sim, length


def temperature(sim):
    """T = m <v^2> / 3"""
    return np.mean(sim.get_velocities() ** 2)


def collision_rate(sim, length, fraction):
    """4 n d^2 g0 sqrt(pi T / m) with g0 = (1 - phi/2) / (1 - phi)^3"""
    contact_value = (1 - fraction / 2) / (1 - fraction) ** 3
    return 4 * int(sim.num_particles) / length**3 * contact_value * np.sqrt(np.pi * temperature(sim))


@pytest.mark.parametrize(
    ("per_side", "fraction", "restitution", "duration"),
    [
        (9, 0.05, 0.95, 1.0),
        pytest.param(16, 0.05, 0.95, 3.0, marks=pytest.mark.slow),
        pytest.param(16, 0.10, 0.97, 1.5, marks=pytest.mark.slow),
    ],
)
def test_granular_gas_cools_by_haffs_law(per_side, fraction, restitution, duration):
    """From a melted lattice; duration in units of tau."""
    sim, length = gas(per_side, fraction)
    rate = collision_rate(sim, length, fraction)
    dt = 0.05 / rate
    sim.set_material_params(1.0)
    for _ in range(200):
        sim.step(dt)
    assert temperature(sim) == pytest.approx(1, rel=1e-12)

    tau = 6 / ((1 - restitution**2) * rate)
    sim.set_material_params(restitution)
    steps = round(0.25 * tau / dt)
    for quarter in range(1, round(4 * duration) + 1):
        for _ in range(steps):
            sim.step(dt)
        time = quarter * steps * dt
        assert temperature(sim) == pytest.approx((1 + time / tau) ** -2, rel=0.02)
    np.testing.assert_allclose(sim.get_velocities().sum(axis=0), 0, atol=1e-9)
