"""Time of one coupled step of the drafting-kissing-tumbling script, its shares, and the reference beside it.

python tests/benchmarks/bench_coupled_step.py [--resolution 12] [--steps 20] [--reference PYTHON]

PYTHON is the interpreter of a virtual environment with the reference (peclet-flow 0.5.1, peclet-dem,
peclet-geom); without it, our own figures are printed alone. Both run the same script, one after the other.
"""

import argparse
import importlib
import itertools
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import time
import types

SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "validation" / "compatible_script.py"
CELLS = {6: 48 * 160 * 48, 8: 64 * 208 * 64, 12: 88 * 304 * 88}
WARM_UP = 3  # steps that allocate and start threads


def provide_geom() -> None:
    """Newer versions of the reference call peclet.core.geom peclet.geom."""
    try:
        importlib.import_module("peclet.core.geom")
    except ModuleNotFoundError:
        core = types.ModuleType("peclet.core")
        core.geom = importlib.import_module("peclet.geom")
        sys.modules["peclet.core"] = core


def measure(resolution: int, steps: int) -> None:
    """Run the script in this process; print times and memory as one line of JSON."""
    provide_geom()
    sys.argv = [str(SCRIPT), str(steps + WARM_UP), str(resolution)]
    script: dict = {"__name__": "__main__", "__file__": str(SCRIPT)}
    source = SCRIPT.read_text(encoding="utf-8").partition('if __name__ == "__main__":')[0]
    exec(compile(source, str(SCRIPT), "exec"), script)  # the definitions, with the resolution of sys.argv
    ends, shares = [time.perf_counter()], []

    def report(step, particles, solver, force) -> None:
        ends.append(time.perf_counter())
        shares.append(dict(solver.last_step_timers()))

    script["run"](steps + WARM_UP, report)
    seconds = [b - a for a, b in itertools.pairwise(ends)][WARM_UP:]
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    names = [name for name, value in shares[-1].items() if isinstance(value, (int, float))]
    medians = {name: statistics.median(share[name] for share in shares[WARM_UP:]) for name in names}
    print(json.dumps({"seconds": statistics.median(seconds), "shares": medians, "peak": peak}))


def run_child(python: str, resolution: int, steps: int) -> dict:
    """The figures of one interpreter."""
    command = [python, __file__, "--measure", "--resolution", str(resolution), "--steps", str(steps)]
    result = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ), check=False)
    if result.returncode:
        raise SystemExit(f"{python} failed:\n{result.stderr}")
    return json.loads(result.stdout.strip().splitlines()[-1])


def main() -> None:
    """Measure and print one table, the ratio first."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--resolution", type=int, choices=tuple(CELLS), default=12)
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--reference", metavar="PYTHON", help="interpreter with the reference installed")
    parser.add_argument("--measure", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        measure(options.resolution, options.steps)
        return
    cells = CELLS[options.resolution]
    ours = run_child(sys.executable, options.resolution, options.steps)
    if options.reference:
        theirs = run_child(options.reference, options.resolution, max(2, options.steps // 10))
        print(f"reference / ours           {theirs['seconds'] / ours['seconds']:8.1f}")
        print(f"reference, s per step      {theirs['seconds']:8.3f}")
    print(f"d/h = {options.resolution}, {cells} cells, median of {options.steps} steps")
    print(f"s per coupled step         {ours['seconds']:8.3f}")
    print(f"ns per cell and step       {1e9 * ours['seconds'] / cells:8.1f}")
    print(f"process peak, B per cell   {ours['peak'] / cells:8.1f}")
    for name, seconds in ours["shares"].items():
        print(f"  {name:<12} {1e3 * seconds:8.1f} ms {100 * seconds / ours['seconds']:6.1f} %")
    print(f"processors: {os.cpu_count()}")


if __name__ == "__main__":
    main()
