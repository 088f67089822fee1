"""Time to march a simple cubic array of spheres to its steady flow, and the reference beside it.

Stokes flow driven by a body force through a periodic cube with one sphere. The residual of a step is the
larger of two: what the force on the sphere differs from the driving force, and what the mean velocity
changes, both relative. In long steps the first alone is small by accident before the flow is steady. Both
run the calls of 0.5.1 with the same time steps, the first of which is the default of the reference. The ratio
counts the time of the steps until the residual stays below what both reach, in the fastest of several rounds
of each, taken in turn.
"""

import argparse
import itertools
import sys
import time

import harness
import newer_reference

VISCOSITY = 0.1
STEADY_STEPS = 3  # in a row that make the end


def measure(size: int, tolerance: float, time_step: float, most_steps: int) -> dict:
    """Residuals after each step up to the tolerance or most_steps, and the seconds until then."""
    newer_reference.use_older_names()
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
    driving = force * np.count_nonzero(solver.get_ox() > 0)
    residuals, seconds, spent, before = [], [], 0.0, np.inf
    while len(residuals) < most_steps:
        start = time.perf_counter()
        solver.step()
        spent += time.perf_counter() - start
        drag = float(solver.hydro_force_torque_reaction()[0, 0, 0])
        velocity = float(np.mean(solver.get_u()))
        residuals.append(max(abs(drag / driving - 1), abs(1 - before / velocity)))
        seconds.append(spent)
        before = velocity
        if len(residuals) >= STEADY_STEPS and max(residuals[-STEADY_STEPS:]) <= tolerance:
            break
    return {"seconds": seconds, "residuals": residuals}


def lasting(one: dict) -> list[float]:
    """After each step, the largest residual from there on."""
    return list(itertools.accumulate(reversed(one["residuals"]), max))[::-1]


def seconds_to(residual: float, one: dict) -> float:
    """Until the residual stays no larger."""
    return next(s for s, r in zip(one["seconds"], lasting(one), strict=True) if r <= residual)


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Ratios, then steps and times."""
    table = harness.Table("static_array", ("nu dt / h2", *harness.QUANTITIES))
    interpreters = {"ours": sys.executable}
    if options.reference:
        interpreters["reference"] = options.reference
    ratios, rows = [], []
    for time_step in options.time_steps:
        task = {
            "size": options.size,
            "tolerance": options.tolerance,
            "time_step": time_step,
            "most_steps": options.steps,
        }
        rounds = [
            {name: harness.run_child(__file__, task, python=python) for name, python in interpreters.items()}
            for _ in range(options.rounds)
        ]
        found = {
            name: min((r[name] for r in rounds), key=lambda one: one["seconds"][-1]) for name in interpreters
        }
        number = f"{VISCOSITY * time_step:g}"
        for name, one in found.items():
            rows.append([number, f"{name}, steps", len(one["residuals"]), None, None])
            rows.append([number, f"{name}, residual after them", one["residuals"][-1], None, None])
            rows.append([number, f"{name}, per step", one["seconds"][-1] / len(one["seconds"]), "s", None])
        if options.reference:
            residual = max(min(lasting(one)[: -STEADY_STEPS + 1]) for one in found.values())
            ours, reference = (seconds_to(residual, found[name]) for name in ("ours", "reference"))
            quantity = f"reference / ours, to residual {residual:.2g}"
            ratios.append([number, quantity, reference / ours, None, ">= 30"])
            rows.append([number, f"ours, to residual {residual:.2g}", ours, "s", None])
            rows.append([number, f"reference, to residual {residual:.2g}", reference, "s", None])
    if options.reference:
        release = harness.release_of_reference(options.reference)
        ratios.append([None, "release of the reference", release, None, None])
    table.rows = ratios + rows
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The case."""
    parser.add_argument("--size", type=int, default=64, help="cells along each axis")
    parser.add_argument("--tolerance", type=float, default=1e-3)
    parser.add_argument("--steps", type=int, default=40, help="at most")
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--time-steps", type=float, nargs="+", default=[50.0, 100.0, 1000.0, 1e4])
    harness.add_reference(parser)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
