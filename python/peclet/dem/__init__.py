"""Spheres in contact: gravity, external loads, restitution, friction, walls and periodic boxes.

>>> import numpy as np
>>> from peclet import dem
>>> sim = dem.Simulation(1)
>>> sim.set_sphere_shape(0.5)
>>> sim.set_gravity(0.0, 0.0, -10.0)
>>> sim.set_positions(np.array([[0.0, 0.0, 1.0]]))
>>> sim.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
>>> for _ in range(100):
...     sim.step(0.01)
>>> float(sim.get_positions()[0, 2])
0.5
"""

from peclet import _environment  # noqa: F401
from peclet.dem._dem import execution_space
from peclet.dem.diagnostics import Diagnostics
from peclet.dem.simulation import Simulation

__all__ = ["Diagnostics", "Simulation", "execution_space", "finalize"]


def finalize() -> None:
    """Does nothing: the compute runtime, which all modules share, ends with the process. Safe to call at
    any time.
    """
