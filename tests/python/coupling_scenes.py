"""Coupled simulations for the tests."""

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.coupling import Body, CoupledSimulation
from peclet.dem import Simulation
from peclet.flow import Solver

CELLS = (16, 20, 12)
RADIUS = 3.0
CENTER = (7.3, 9.1, 5.8)
TOUCHING = ((7.3, 6.1, 5.8), (7.3, 10.6, 5.8))


def build(centers=(CENTER,), *, ratio=2.0, velocities=None, iterations=None, radius=RADIUS, **options):
    """Spheres in a periodic box of fluid at rest."""
    scene = SceneBuilder()
    ball = scene.add_leaf("sphere", [radius])
    for center in centers:
        scene.add_instance(ball, translation=list(center))
    flow = Solver(*CELLS)
    flow.set_advection(True)
    flow.set_scene(*scene.encode(), periodic=True)
    flow.set_solid_from_scene()
    contacts = Simulation(len(centers))
    contacts.set_sphere_shape(radius)
    contacts.set_positions(np.array(centers))
    if velocities is not None:
        contacts.set_velocities(np.array(velocities))
    if iterations is not None:
        contacts.set_solver_iterations(*iterations)
    bodies = [Body.sphere(n, radius=radius, density=ratio) for n in range(len(centers))]
    defaults = {"time_step": 1.0, "viscosity": 0.01, "gravity": (0.0, -1e-3, 0.0)}
    return CoupledSimulation(flow, contacts, bodies, **{**defaults, **options})
