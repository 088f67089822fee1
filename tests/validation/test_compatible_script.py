"""A script written against the reference 0.5.1 runs unchanged, and what it computes is physical."""

import numpy as np
import pytest

from tests.conftest import REPOSITORY, load_script

script = load_script(REPOSITORY / "tests" / "validation" / "compatible_script.py")
STEPS = 3


@pytest.fixture(scope="module")
def finished():
    rows = []

    def report(step, sim, s, force):
        rows.append((force.copy(), sim.get_velocities()))

    return script.run(STEPS, report) | {"rows": rows}


def test_a_fluid_at_rest_exerts_no_force(finished):
    first_force, velocities = finished["rows"][0]
    assert np.abs(first_force).max() == 0
    # m + m_a = 3.14 V carries the weight 0.14 V g; loads are given in single precision
    fall = -0.14 / 3.14 * script.G * script.DT
    np.testing.assert_allclose(velocities, [[0, fall, 0]] * 2, rtol=1e-6, atol=1e-12)


def test_spheres_fall_ever_faster_against_the_fluid(finished):
    speeds = np.array([velocities[:, 1] for _, velocities in finished["rows"]])
    assert (np.diff(speeds, axis=0) < 0).all()
    assert (finished["rows"][-1][0][:, 1] > 0).all()
    assert (finished["particles"].get_positions()[:, 1] < finished["start"][:, 1]).all()


def test_forces_on_all_bodies_are_what_the_fluid_lost(finished):
    solver = finished["flow"]
    forces = solver.hydro_force_torque_reaction()[0]
    change = solver.reaction_budget_terms()[0]
    # sums over a quarter of a million faces: 1e-10 of the largest force is rounding
    np.testing.assert_allclose(forces.sum(axis=0), -change, atol=1e-10 * np.abs(forces).max())


def test_no_fluid_is_made_or_lost(finished):
    largest = np.abs(finished["flow"].get_v()).max()
    assert finished["flow"].max_open_divergence() < 1e-8 * largest


def test_the_two_spheres_are_almost_equal(finished):
    leader, follower = finished["rows"][-1][1]
    # no wake yet, but their surfaces cut the grid in different places, six cells per diameter
    assert leader[1] == pytest.approx(follower[1], rel=0.05)
