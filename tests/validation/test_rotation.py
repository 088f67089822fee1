"""Torque in Stokes flow: on a sphere in a cubic periodic cell, and on what holds fluid inside.

The torque on the sphere has its order here; the values are on the page.
"""

import numpy as np
import pytest
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

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


def test_a_spinning_tank_full_of_fluid_needs_no_torque():
    scene = SceneBuilder()
    tank = scene.add_difference(scene.add_leaf("box", [20, 20, 20]), scene.add_leaf("sphere", [5.2]))
    scene.add_instance(tank, [7.5, 7.5, 7.5])
    solver = Solver(16, 16, 16)
    solver.set_mu(1.0)
    solver.set_dt(20.0)
    solver.set_scene(*scene.encode())
    solver.set_solid_from_scene()
    solver.set_instance_motion(0, [0, 0, 0], [0, 0, 0.01])
    for _ in range(15):
        solver.step()
    assert np.abs(solver.hydro_force_torque_reaction()[1, 0]).max() <= 5e-3 * 8 * np.pi * 5.2**3 * 0.01


@pytest.mark.parametrize("turning", ["inner", "outer"])
def test_cylinders_that_turn_in_each_other(turning):
    inner, outer, height = 0.2, 0.45, 0.1
    scene = SceneBuilder()
    middle = [0.5, 0.5, height / 2]
    scene.add_instance(scene.add_leaf("hollow_cylinder_shell", [inner, 0, 4]), middle)
    scene.add_instance(scene.add_leaf("hollow_cylinder_shell", [2, outer, 4]), middle)
    exact = 4 * np.pi * height / (1 / inner**2 - 1 / outer**2)  # on the cylinder at rest, mu = Omega = 1
    errors = []
    for cells in (20, 40):
        solver = Solver((cells, cells, 2), extent=(1, 1, height))
        solver.set_mu(1.0)
        solver.set_dt(1.0)
        solver.set_scene(*scene.encode())
        solver.set_solid_from_scene()
        solver.set_instance_motion(("inner", "outer").index(turning), [0, 0, 0], [0, 0, 1])
        for _ in range(12):
            solver.step()
        torque = solver.hydro_force_torque_reaction()[1, :, 2]
        expected = [-exact, exact] if turning == "inner" else [exact, -exact]
        errors.append(np.abs(torque - expected).max() / exact)
    assert errors[1] <= 0.01
    assert orders(errors)[0] >= 1.0
