"""Time to import the modules and to make a solver with its scene."""

import argparse
import json
import statistics
import subprocess
import sys
import time

import harness

IMPORTS = """
import json, time
times = [time.perf_counter()]
import numpy
times.append(time.perf_counter())
import peclet.core.geom, peclet.dem, peclet.flow
times.append(time.perf_counter())
print(json.dumps({"numpy": times[1] - times[0], "modules": times[2] - times[0]}))
"""


def measure() -> dict:
    """Seconds of the calls that make the solver of drafting, kissing and tumbling."""
    from peclet import flow
    from peclet.core import geom

    start = time.perf_counter()
    cells = [88, 304, 88]
    scene = geom.SceneBuilder()
    slab = scene.add_leaf("box", [n / 2 + 1 for n in cells])
    tank = scene.add_difference(slab, scene.add_leaf("box", [36, 144, 36]))
    scene.add_instance(tank, translation=[n / 2 + 0.3 for n in cells])
    for height in (189.6, 210.0):
        scene.add_instance(scene.add_leaf("sphere", [6]), translation=[44.3, height, 44.3])
    solver = flow.Solver(*cells)
    solver.set_scene(*scene.encode(), periodic=True)
    solver.set_solid_from_scene()
    made = time.perf_counter()
    solver.step()
    return {"solver": made - start, "step": time.perf_counter() - made}


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Medians of several processes."""
    table = harness.Table("startup", harness.QUANTITIES)
    found = []
    for _ in range(options.repetitions):
        command = [sys.executable, "-c", IMPORTS]
        imports = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        found.append({**json.loads(imports.stdout), **harness.run_child(__file__, {})})
    median = {name: statistics.median(one[name] for one in found) for name in found[0]}
    table.add("import of peclet.core.geom, flow, dem", median["modules"], "s", "<= 0.3")
    table.add("of NumPy, contained in it", median["numpy"], "s")
    table.add("Solver(88, 304, 88) with its scene", median["solver"], "s", "<= 1")
    table.add("its first step", median["step"], "s")
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """Number of processes."""
    parser.add_argument("--repetitions", type=int, default=5)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
