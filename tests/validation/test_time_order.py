"""Bodies that accelerate, in time: prescribed motion, and motion that follows from the forces."""

import numpy as np
import pytest
from peclet.core.geom import SceneBuilder
from peclet.coupling import Body, CoupledSimulation
from peclet.dem import Simulation
from peclet.flow import Solver

from examples.validation import walls
from examples.validation.results import orders


def test_prescribed_oscillation_is_of_second_order():
    forces = np.array([walls.oscillation(3, 18, per_period=steps) for steps in (24, 48, 96, 192)])
    differences = np.linalg.norm(np.diff(forces, axis=0), axis=1)
    assert orders(differences).min() >= 1.7
    assert differences[-1] <= 2e-3 * np.linalg.norm(forces[-1])


def velocity_of_fall(density_ratio, time_step, times):
    """From rest, at times over a^2 / nu; in Stokes flow."""
    radius, cells = 3.0, 20
    scene = SceneBuilder()
    center = [9.8, 9.8, 9.8]
    scene.add_instance(scene.add_leaf("sphere", [radius]), translation=center)
    flow = Solver(cells, cells, cells)
    flow.set_scene(*scene.encode(), periodic=True)
    flow.set_solid_from_scene()
    contacts = Simulation(1)
    contacts.set_sphere_shape(radius)
    contacts.set_positions([center])
    simulation = CoupledSimulation(
        flow,
        contacts,
        [Body.sphere(0, radius=radius, density=density_ratio)],
        time_step=time_step * radius**2,
        viscosity=1.0,
        gravity=(0, 0, -1e-4 / (density_ratio - 1)),
    )
    simulation.run(round(times[-1] / time_step), progress=False)
    history = simulation.history
    return np.interp(times, history["time"] / radius**2, history["velocity"][:, 0, 2])


@pytest.mark.parametrize(
    ("density_ratio", "early", "late"), [(0.2, 0.05, 0.01), (1.5, 0.012, 0.003), (7.8, 0.005, 0.001)]
)
def test_bodies_and_fluid_meet_at_the_same_time(density_ratio, early, late):
    """With nothing predicted, the later errors are 0.9, 1.0 and 0.4 %."""
    times = np.array([0.2, 0.4, 0.8])
    coarse, fine = (velocity_of_fall(density_ratio, dt, times) for dt in (0.05, 0.0125))
    error = np.abs(coarse / fine - 1)
    # the start from rest is singular: the history force goes like the inverse root of the time
    assert error[0] <= early
    assert error[1:].max() <= late
