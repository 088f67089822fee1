"""Motion of bodies that is prescribed: what friction follows, and runs that go on."""

import numpy as np
import pytest
from peclet.flow import Solver

from tests.python.flow_scenes import assert_same_flow, box_with

START = (6.3, 5.6, 6.2)


def make(prescribed):
    solver = Solver(14, 12, 13)
    solver.set_dt(2.0)
    solver.set_prescribed_motion(prescribed)
    return box_with(solver, (START, 3.2, (0.05, 0.0, 0.0), (0.0, 0.0, 0.02)))


def run(solver, speeds, steps):
    """The sphere moves along x with these speeds, and spins faster and faster."""
    for n in steps:
        solver.set_instance_transform(0, (START[0] + sum(speeds[: n + 1]) * solver.dt, *START[1:]))
        solver.set_instance_motion(0, (speeds[n], 0, 0), (0, 0, 0.02 * speeds[n] / speeds[0]))
        solver.step()
    return np.array(solver.hydro_force_torque_reaction())[:, 0]


def test_is_off_until_switched_on():
    solver = Solver(8, 8, 8)
    assert solver.prescribed_motion is False
    solver.set_prescribed_motion(True)
    assert solver.prescribed_motion is True
    with pytest.raises(TypeError, match="on: expected"):
        solver.set_prescribed_motion("yes")
    assert solver.prescribed_motion is True


def test_changes_nothing_for_a_constant_velocity():
    speeds = [0.05] * 4
    one, other = make(True), make(False)
    for solver in (one, other):
        run(solver, speeds, range(4))
    assert_same_flow(one, other)


def test_friction_follows_the_mean_velocity():
    """Where inertia is negligible, the torque is that of the mean spin in the step."""
    speeds = [0.05, 0.05, 0.05, 0.05, 0.1]
    torques = {}
    for prescribed in (True, False):
        solver = make(prescribed)
        solver.set_mu(50.0)
        before = run(solver, speeds, range(4))[1, 2]
        torques[prescribed] = run(solver, speeds, range(4, 5))[1, 2] / before
    # momentum diffuses through the box in a fraction of the step, implicitly by 9/16 of it
    assert torques[True] == pytest.approx(1.5, abs=0.1)
    assert torques[False] == pytest.approx(2.0, abs=0.1)


def test_goes_on_bit_by_bit_while_the_body_accelerates():
    speeds = [0.05, 0.07, 0.11, 0.12, 0.09]
    whole = make(True)
    run(whole, speeds, range(5))
    first, second = make(True), make(True)
    run(first, speeds, range(3))
    second.restore(first.checkpoint())
    run(second, speeds, range(3, 5))
    assert_same_flow(whole, second)


@pytest.mark.parametrize("viscosity", [0.06, 0.08, 0.12])
def test_points_that_a_body_uncovers_carry_no_more_than_the_fluid_beside_it(viscosity):
    """Viscosity that reaches a cell or two in a step: slits hold back most of what passes through them."""
    solver = Solver(16, 16, 16)
    solver.set_mu(viscosity)
    solver.set_dt(25.0)
    speed, center = 0.01, np.array([7.7, 7.75, 7.6])
    box_with(solver, (center, 3.97, (speed, 0, 0)))
    for _ in range(50):
        center[0] += speed * solver.dt
        solver.set_instance_transform(0, center)
        solver.step()
    # the sphere displaces a quarter of its speed sideways, and drags the fluid along
    assert np.abs(solver.get_v()).max() < 0.3 * speed
    assert np.abs(solver.get_u()).max() < 1.3 * speed
