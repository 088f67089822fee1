"""Time of one coupled step of drafting, kissing and tumbling, its parts, and the reference beside it.

Both run tests/validation/compatible_script.py, round after round in turn, and the fastest round of each
counts: other users of the machine make them slower, nothing makes them faster. GB/s: bytes that a part cannot
avoid to move, every array read or written once per pass over the grid, over its time.
"""

import argparse
import itertools
import statistics
import sys
import time

import harness
import newer_reference
import numpy as np

SCRIPT = harness.ROOT / "tests" / "validation" / "compatible_script.py"
WARM_UP = 2  # steps that allocate and start threads

# Bytes per cell, in passes: arrays are Real 8, corrections 4, open fractions 2 per face.
MOMENTUM = 3 * 56  # three velocities, the old two of one component, pressure, residual; three components
VISCOUS = 3 * (10 + 34)  # norm of the residual; all sweeps of a component in one pass
PRESSURE_START = 80  # norm of the right-hand side, first and last residual
PRESSURE_ITERATION = (
    100  # smooth and restrict 19, prolong and smooth 22, search 18, advance 34, coarse levels 7
)
REST = 72 + 96 + 38 + 86  # extrapolation, correction, divergence, projection


def swept_cells(solver) -> int:
    """Cells between the first and the last open face of every row."""
    fluid = (np.stack([solver.get_ox(), solver.get_oy(), solver.get_oz()]) > 0).any(axis=0)
    found = fluid.any(axis=0)
    first, last = fluid.argmax(axis=0), fluid[::-1].argmax(axis=0)
    return int((fluid.shape[0] - first - last)[found].sum())


def measure(resolution: int, steps: int) -> dict:
    """Medians over the steps."""
    newer_reference.use_older_names()
    sys.argv = [str(SCRIPT), str(steps + WARM_UP), str(resolution)]
    script: dict = {"__name__": "__main__"}
    source = SCRIPT.read_text(encoding="utf-8").partition('if __name__ == "__main__":')[0]
    exec(compile(source, str(SCRIPT), "exec"), script)  # the definitions, with the resolution of sys.argv
    ends, parts, iterations = [time.perf_counter()], [], []

    def report(step, particles, solver, force) -> None:
        ends.append(time.perf_counter())
        parts.append(dict(solver.last_step_timers()))
        iterations.append(solver.last_pressure_iterations())

    solver = script["run"](steps + WARM_UP, report)["flow"]
    peak = harness.peak_memory()
    seconds = [b - a for a, b in itertools.pairwise(ends)][WARM_UP:]
    names = [name for name, value in parts[-1].items() if isinstance(value, (int, float))]
    return {
        "cells": script["NX"] * script["NY"] * script["NZ"],
        "swept": swept_cells(solver),
        "seconds": statistics.median(seconds),
        "parts": {name: statistics.median(part[name] for part in parts[WARM_UP:]) for name in names},
        "iterations": statistics.mean(iterations[WARM_UP:]),
        "peak": peak,
    }


def fastest(rounds: list[dict]) -> dict:
    """The round whose step took the least time."""
    return min(rounds, key=lambda found: found["seconds"])


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Ratio, whole step, parts."""
    table = harness.Table("coupled_step", (*harness.QUANTITIES, "share", "GB/s", "of copy"))
    task = {"resolution": options.resolution, "steps": options.steps}
    reference_task = task | {"steps": max(2, options.steps // 10)}
    rounds, reference_rounds = [], []
    for _ in range(options.rounds):
        rounds.append(harness.run_child(__file__, task))
        if options.reference:
            reference_rounds.append(harness.run_child(__file__, reference_task, python=options.reference))
    ours = fastest(rounds)
    cells, seconds = ours["cells"], ours["seconds"]
    if options.reference:
        theirs = fastest(reference_rounds)
        table.add("reference / ours", theirs["seconds"] / seconds, "", ">= 75")
        table.add("release of the reference", harness.release_of_reference(options.reference))
        table.add("step of the reference", theirs["seconds"], "s")
        table.add("process peak of the reference", theirs["peak"] / cells, "B/cell")
    table.add("coupled step", seconds, "s", "<= 0.2" if options.resolution == 12 else "", 1.0)
    table.add("time per cell", 1e9 * seconds / cells, "ns")
    table.add("process peak", ours["peak"] / cells, "B/cell", "<= 250")
    table.add("cells", cells, "")
    table.add("pressure iterations", ours["iterations"], "", "<= 8")
    copy = harness.copy_bandwidth()
    table.add("copy in memory", None, "", "", None, copy / 1e9, 1.0)
    parts = {name: value for name, value in ours["parts"].items() if value > 0}
    parts["rest"] = seconds - sum(value for name, value in parts.items() if name != "rest")
    pressure = PRESSURE_START + PRESSURE_ITERATION * ours["iterations"]
    traffic = {"momentum": MOMENTUM, "viscous": VISCOUS, "pressure": pressure, "rest": REST}
    for name, value in parts.items():
        table.add(name, 1e3 * value, "ms", "", value / seconds)
        if name in traffic:
            rate = traffic[name] * ours["swept"] / value
            table.rows[-1][-2:] = [rate / 1e9, rate / copy]
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """Cells per diameter and number of steps."""
    parser.add_argument("--resolution", type=int, choices=(6, 8, 12), default=12)
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=3)
    harness.add_reference(parser)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
