"""Spheres move through a periodic box: what geometry costs, and how time scales with size and threads.

To scale, every block of the box holds one sphere, so that fluid and surface grow alike.
"""

import itertools
import statistics
import time

import harness
import numpy as np

BLOCK = 48  # cells along each axis
RADIUS = 6
PARTS = ("geometry", "momentum", "viscous", "pressure", "loads")
WARM_UP = 3  # steps that allocate, start threads and leave the impulsive start behind


def march(size: int, radius: float, places: np.ndarray, velocities: np.ndarray, steps: int) -> dict:
    """Medians over the steps of spheres that start at places in a periodic box of size^3 cells."""
    from peclet import flow
    from peclet.core import geom

    scene = geom.SceneBuilder()
    ball = scene.add_leaf("sphere", [radius])
    for place in places:
        scene.add_instance(ball, translation=place)
    solver = flow.Solver(size, size, size)
    solver.set_mu(0.005)
    solver.set_dt(1)
    solver.set_advection(True)
    solver.set_advection_scheme(1)
    solver.set_scene(*scene.encode(), periodic=True)
    solver.set_solid_from_scene()
    seconds, parts, iterations = [], [], []
    for step in range(steps + WARM_UP):
        start = time.perf_counter()
        for body, (place, velocity) in enumerate(zip(places, velocities, strict=True)):
            solver.set_instance_transform(body, place + step * velocity)
            solver.set_instance_motion(body, velocity)
        solver.rebuild_geometry()
        solver.step()
        seconds.append(time.perf_counter() - start)
        parts.append(solver.diagnostics.last_step_timers())
        iterations.append(solver.diagnostics.last_pressure_iterations())
    return {
        "seconds": statistics.median(seconds[WARM_UP:]),
        "parts": {name: statistics.median(part[name] for part in parts[WARM_UP:]) for name in parts[0]},
        "iterations": max(iterations[WARM_UP:]),
    }


def measure(blocks: int, steps: int) -> dict:
    """Seconds per step and its parts, iterations, and memory, with blocks^3 spheres."""
    numbers = np.array(list(itertools.product(range(blocks), repeat=3)))
    velocities = np.tile([0.1, 0, 0], (len(numbers), 1))
    found = march(blocks * BLOCK, RADIUS, BLOCK * (numbers + 0.5) + 0.3, velocities, steps)
    return found | {
        "parts": [found["parts"][name] for name in PARTS],
        "peak": harness.peak_memory(),
    }
