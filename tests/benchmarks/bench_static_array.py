"""Time to march a simple cubic array of spheres to its steady flow, and the reference beside it.

Stokes flow driven by a body force through a periodic cube with one sphere. The residual of a step is what the
mean velocity and the force on the sphere still have to change, the larger of the two, relative; the end is
that of the run with the longest steps. Both run the calls of 0.5.1. The first ratio is that of the times to
the residual, each with the time step that is fastest for it; the others are with the same time steps.

Machines slow down and speed up again within seconds, and wake up slowly. Both take turns, marches that are
over soon are repeated until the machine is awake, and every step counts with the shortest of its times.
"""

import argparse
import itertools
import math
import statistics
import sys
import time

import harness
import newer_reference

VISCOSITY = 0.1


def march(size: int, time_step: float, steps: int) -> dict:
    """Mean velocity and force on the sphere after each step, and the seconds that it took."""
    import numpy as np
    from peclet import flow
    from peclet.core import geom

    force, radius = 1e-4, size * (3 * 0.125 / (4 * np.pi)) ** (1 / 3)
    scene = geom.SceneBuilder()
    ball = scene.add_leaf("sphere", [radius])
    node_ints, node_reals, _, _ = scene.encode()
    instance = np.zeros(17)
    instance[:3] = size / 2 + 0.3
    instance[6:8] = 1
    solver = flow.Solver(size, size, size)
    solver.set_rho(1.0)
    solver.set_mu(VISCOSITY)
    solver.set_dt(time_step)
    solver.set_velocity_solver_params(200)
    solver.set_pressure_solver_params(200)
    solver.set_body_force(force, 0.0, 0.0)
    solver.set_scene(node_ints, node_reals, np.array([ball, -1], dtype=np.int32), instance, True)
    solver.set_solid_from_scene(True)
    found: dict = {"velocity": [], "force": [], "seconds": []}
    for _ in range(steps):
        start = time.perf_counter()
        solver.step()
        found["seconds"].append(time.perf_counter() - start)
        found["velocity"].append(float(np.mean(solver.get_u())))
        found["force"].append(float(solver.hydro_force_torque_reaction()[0, 0, 0]))
    return found


def measure(size: int, time_step: float, steps: int, least_seconds: float) -> dict:
    """The last of the marches that take least_seconds together."""
    newer_reference.use_older_names()
    begin = time.perf_counter()
    while True:
        found = march(size, time_step, steps)
        if time.perf_counter() - begin >= least_seconds:
            return found


def seconds_to(tolerance: float, run: dict, end: dict) -> float:
    """Until the residual stays below the tolerance; infinite where it does not."""
    residuals = [
        max(abs(u / end["velocity"][-1] - 1), abs(f / end["force"][-1] - 1))
        for u, f in zip(run["velocity"], run["force"], strict=True)
    ]
    largest_from_here = list(itertools.accumulate(reversed(residuals), max))[::-1]
    until = itertools.accumulate(run["seconds"])
    reached = (s for s, r in zip(until, largest_from_here, strict=True) if r <= tolerance)
    return next(reached, math.inf)


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Ratios, then steps and times."""
    table = harness.Table("static_array", ("nu dt / h2", *harness.QUANTITIES))
    interpreters = {"ours": sys.executable}
    if options.reference:
        interpreters["reference"] = options.reference
    runs: dict = {name: {} for name in interpreters}
    for time_step in options.time_steps:
        task = {
            "size": options.size,
            "time_step": time_step,
            "steps": options.steps,
            "least_seconds": options.least_seconds,
        }
        turns: dict = {name: [] for name in interpreters}
        for _ in range(options.turns):
            for name, python in interpreters.items():
                turns[name].append(harness.run_child(__file__, task, python=python))
        for name, found in turns.items():
            shortest = [min(times) for times in zip(*(turn["seconds"] for turn in found), strict=True)]
            runs[name][time_step] = {**found[0], "seconds": shortest}
    seconds = {
        name: {
            step: seconds_to(options.tolerance, run, of_steps[max(of_steps)])
            for step, run in of_steps.items()
        }
        for name, of_steps in runs.items()
    }
    if options.reference:
        fastest = min(seconds["reference"].values()) / min(seconds["ours"].values())
        quantity = f"reference / ours, to residual {options.tolerance:g}"
        table.rows.append(["fastest of each", quantity, fastest, None, ">= 30"])
    for step in options.time_steps:
        number = f"{VISCOSITY * step:g}"
        both = [seconds[name][step] for name in interpreters]
        if options.reference and all(map(math.isfinite, both)):
            table.rows.append([number, quantity, both[1] / both[0], None, None])
        for name in interpreters:
            spent = statistics.fmean(runs[name][step]["seconds"])
            table.rows.append([number, f"{name}, per step", spent, "s", None])
            if math.isfinite(seconds[name][step]):
                found = seconds[name][step]
                table.rows.append([number, f"{name}, to residual {options.tolerance:g}", found, "s", None])
    if options.reference:
        release = harness.release_of_reference(options.reference)
        table.rows.append([None, "release of the reference", release, None, None])
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The case."""
    parser.add_argument("--size", type=int, default=64, help="cells along each axis")
    parser.add_argument("--tolerance", type=float, default=1e-3)
    parser.add_argument("--steps", type=int, default=30)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--least-seconds", type=float, default=3.0, help="that a turn lasts")
    parser.add_argument("--time-steps", type=float, nargs="+", default=[1000.0, 3000.0, 1e4])
    harness.add_reference(parser)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
