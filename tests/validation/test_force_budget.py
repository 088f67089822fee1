"""Forces are the momentum that the fluid lost, torques the angular momentum, to rounding."""

import numpy as np
import pytest

from tests.validation.helpers import box_of_fluid, fluid_points, put_spheres, velocities

CELLS = (18, 14, 16)
FORCE = np.array([1e-2, 3e-3, -2e-3])
RHO, DT = 1.3, 0.5


def two_bodies(scheme, velocity, spin):
    """A sphere that may move beside one at rest, the latter across an edge of the box."""
    solver = box_of_fluid(CELLS, rho=RHO, mu=0.2, dt=DT, force=FORCE, scheme=scheme)
    return put_spheres(solver, ((5.3, 6.1, 7.8), 2.7, velocity, spin), ((12.2, 12.9, 4.3), 2.9))


def budget_defect(solver, before):
    """|sum F + rho/dt sum(u_new - u_old) - f V| over the largest of the three, worst component."""
    fluid = fluid_points(solver)
    change = (
        RHO / DT * np.array([d[m].sum() for d, m in zip(velocities(solver) - before, fluid, strict=True)])
    )
    supplied = FORCE * fluid.sum(axis=(1, 2, 3)) + solver.diagnostics.reaction_budget_terms()[1]
    force = solver.hydro_force_torque_reaction()[0].sum(axis=0)
    largest = max(np.abs(force).max(), np.abs(change).max(), np.abs(supplied).max())
    return np.abs(force + change - supplied).max() / largest


@pytest.mark.parametrize("scheme", [None, "sou", "koren", "central"])
@pytest.mark.parametrize("moving", [False, True], ids=["fixed", "moving"])
def test_forces_close_the_momentum_budget(scheme, moving):
    velocity = np.array([0.2, -0.1, 0.05]) * moving
    solver = two_bodies(scheme, velocity, (0.02 * moving, 0, -0.03 * moving))
    position = np.array([5.3, 6.1, 7.8])
    for _ in range(4):
        position = position + DT * velocity
        solver.set_instance_transform(0, position)
        solver.rebuild_geometry()
        # uncovered points start from the velocity of the body, so the old state is read after the update
        before = velocities(solver)
        solver.step()
        assert budget_defect(solver, before) <= 1e-10  # sums of some thousand terms of order one
