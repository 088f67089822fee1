"""What bodies that move freely gain in momentum, the fluid loses."""

import numpy as np
import pytest

from tests.validation.helpers import box_of_fluid, fluid_points, put_spheres, velocities

CELLS = (20, 18, 16)
RHO, MU, DT = 1.2, 0.15, 0.4
RADII = (3.1, 2.6)
DENSITY = 3.0


def momentum_of_fluid(solver):
    """Over the points that are unknowns of this step."""
    mask = fluid_points(solver)
    return RHO * np.array([u[m].sum() for u, m in zip(velocities(solver), mask, strict=True)])


@pytest.mark.parametrize("scheme", [None, "sou", "koren", "central"])
def test_momentum_of_fluid_and_free_bodies_is_constant(scheme):
    position = np.array([[5.3, 6.1, 7.8], [13.2, 12.9, 4.3]])
    velocity = np.array([[0.3, 0.1, -0.05], [-0.2, 0.05, 0.1]])
    mass = DENSITY * 4 / 3 * np.pi * np.array(RADII)[:, None] ** 3
    solver = box_of_fluid(CELLS, rho=RHO, mu=MU, dt=DT, scheme=scheme)
    put_spheres(solver, *((x, a, v) for x, a, v in zip(position, RADII, velocity, strict=True)))
    scale = np.abs(mass * velocity).sum()
    for _ in range(12):
        for body in range(2):
            solver.set_instance_transform(body, position[body])
            solver.set_instance_motion(body, velocity[body])
        solver.rebuild_geometry()
        before = momentum_of_fluid(solver) + (mass * velocity).sum(axis=0)
        solver.step()
        velocity = velocity + DT * solver.hydro_force_torque_reaction()[0] / mass
        position = position + DT * velocity
        after = momentum_of_fluid(solver) + (mass * velocity).sum(axis=0)
        assert np.abs(after - before).max() <= 1e-10 * scale
