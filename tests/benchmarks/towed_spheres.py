"""Spheres move side by side through a periodic box: the case behind the scaling of sizes and threads.

Every block of the box holds one sphere, so that fluid and surface grow alike.
"""

import itertools
import statistics
import time

import harness

BLOCK = 48  # cells along each axis
RADIUS = 6
PARTS = ("geometry", "momentum", "viscous", "pressure", "loads")
WARM_UP = 3  # steps that allocate, start threads and leave the impulsive start behind


def measure(blocks: int, steps: int) -> dict:
    """Seconds per step and its parts, iterations, and memory, with blocks^3 spheres."""
    from peclet import flow
    from peclet.core import geom

    size, speed = blocks * BLOCK, 0.1
    places = [
        [BLOCK * (n + 0.5) + 0.3 for n in place] for place in itertools.product(range(blocks), repeat=3)
    ]
    scene = geom.SceneBuilder()
    ball = scene.add_leaf("sphere", [RADIUS])
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
        for number, (x, y, z) in enumerate(places):
            solver.set_instance_transform(number, [x + speed * step, y, z])
            solver.set_instance_motion(number, [speed, 0, 0])
        solver.rebuild_geometry()
        solver.step()
        seconds.append(time.perf_counter() - start)
        parts.append(solver.diagnostics.last_step_timers())
        iterations.append(solver.diagnostics.last_pressure_iterations())
    return {
        "seconds": statistics.median(seconds[WARM_UP:]),
        "parts": [statistics.median(part[name] for part in parts[WARM_UP:]) for name in PARTS],
        "iterations": max(iterations[WARM_UP:]),
        "peak": harness.peak_memory(),
    }
