"""Bodies that a fluid moves and that touch each other: see CoupledSimulation."""

from peclet.coupling.bodies import Body
from peclet.coupling.simulation import CoupledSimulation
from peclet.coupling.slices import PlaneSlice, draw_plane

__all__ = ["Body", "CoupledSimulation", "PlaneSlice", "draw_plane"]
