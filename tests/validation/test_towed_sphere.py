"""An array of spheres towed through the grid: the same drag as at rest, without noise."""

import numpy as np
import pytest

from tests.validation.helpers import Row, box_of_fluid, published, put_spheres, radius_of

FRACTION = 0.064
SPEED, MU = 0.01, 1.0


def towed_array(cells, courant, distance, settle):
    """Drag factors K of the steps that cover the distance, after settle steps.

    A body force f with f V_fluid = F of the step before holds the total momentum of the fluid, so that the
    mean flow settles; K = F / (1 - phi) / (6 pi mu a U), U the mean velocity relative to the spheres with
    zero inside.
    """
    radius = radius_of(FRACTION, cells**3)
    dt = courant / SPEED
    solver = box_of_fluid(cells, mu=MU, dt=dt)
    center = (cells - 1) / 2 + np.array([0.1, 0.3, -0.2])
    put_spheres(solver, (center, radius, (SPEED, 0, 0)))
    force, factors = 0.0, []
    for step in range(settle + round(distance / courant)):
        center[0] += SPEED * dt
        solver.set_instance_transform(0, center)
        solver.set_body_force(force / (cells**3 * (1 - FRACTION)), 0, 0)
        solver.step()
        force = solver.hydro_force_torque_reaction()[0, 0, 0]
        relative = solver.get_u().mean() - SPEED * (1 - FRACTION)
        if step >= settle:
            factors.append(force / (1 - FRACTION) / (6 * np.pi * MU * radius * relative))
    return np.array(factors)


def check(factors, mean_target, rms_target, largest_target):
    (line,) = published("sphere_arrays_stokes", solid_fraction=str(FRACTION))
    exact = float(line["K_computed"])
    mean = factors.mean()
    deviation = factors / mean - 1
    row = Row("towed array, phi 0.064", exact, mean, mean / exact - 1, mean_target)
    assert abs(row.error) <= row.target
    assert np.sqrt(np.mean(deviation**2)) <= rms_target
    assert np.abs(deviation).max() <= largest_target


def test_towed_array():
    check(towed_array(16, 0.25, 2, 20), 1e-2, 2e-3, 5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("courant", "rms"), [(0.1, 1e-3), (0.25, 1e-3)])
def test_towed_array_at_twelve_cells_per_diameter(courant, rms):
    check(towed_array(24, courant, 3, 30), 5e-3, rms, 2.2e-3)
