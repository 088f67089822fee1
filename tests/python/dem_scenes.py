"""Small simulations and walls that the tests of peclet.dem share."""

import numpy as np
from peclet import dem

BOX = 3  # opcode


def spheres(*positions, radius=0.5):
    sim = dem.Simulation(max(1, len(positions)))
    sim.set_sphere_shape(radius)
    sim.set_positions(np.array(positions, dtype=float) if positions else np.zeros((0, 3)))
    return sim


def leaf(opcode, *parameters):
    """One node in the layout of SceneBuilder.encode()."""
    reals = np.zeros(16)
    reals[: len(parameters)] = parameters
    reals[14] = reals[15] = 1.0
    return np.array([opcode, -1, -1], dtype=np.int32), reals
