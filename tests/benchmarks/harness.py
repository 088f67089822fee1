"""What the benchmarks share: child processes, the machine, and one table that is printed and written.

A benchmark measures in child processes, so that peak memory, thread numbers and interpreters are its own.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import dataclasses
import datetime
import importlib
import json
import os
import pathlib
import platform
import resource
import subprocess
import sys
import time
import types
from collections.abc import Callable
from typing import Any

import numpy as np

Value = str | float | None
QUANTITIES = ("quantity", "value", "unit", "target")
ROOT = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass
class Table:
    """Rows of equal length, ratios first; None is a blank."""

    name: str
    columns: tuple[str, ...]
    rows: list[list[Value]] = dataclasses.field(default_factory=list)

    def add(self, *values: Value) -> None:
        """One more row; missing values are blanks."""
        self.rows.append([*values, *[None] * (len(self.columns) - len(values))])

    def __str__(self) -> str:
        lines = [list(self.columns), *[[_text(value) for value in row] for row in self.rows]]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        return "\n".join(
            "  ".join([line[0].ljust(widths[0]), *map(str.rjust, line[1:], widths[1:])]).rstrip()
            for line in lines
        )

    def write(self, path: pathlib.Path) -> None:
        """As CSV, or as JSON with machine and date."""
        if path.suffix == ".csv":
            with path.open("w", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerows([self.columns, *self.rows])
        else:
            write_json(path, dataclasses.asdict(self))


def write_json(path: pathlib.Path, table: dict[str, Any]) -> None:
    """One line per row, with the machine and the date."""
    fields = {"name": table["name"], "date": datetime.date.today().isoformat(), "machine": describe_machine()}
    lines = [f" {json.dumps(key)}: {json.dumps(value)}" for key, value in fields.items()]
    lines.append(f' "columns": {json.dumps(table["columns"])}')
    rows = ",\n".join(f"  {json.dumps([_rounded(value) for value in row])}" for row in table["rows"])
    path.write_text("{\n" + ",\n".join(lines) + ',\n "rows": [\n' + rows + "\n ]\n}\n", encoding="utf-8")


def describe_machine() -> dict[str, Any]:
    """Processor, number of cores, threads and memory."""
    model = platform.processor() or platform.machine()
    information = pathlib.Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {"processor": model, "cores": os.cpu_count(), "threads": threads(), "memory_GB": memory // 10**9}


def threads() -> int:
    """Number of threads that kernels use."""
    return int(os.environ.get("OMP_NUM_THREADS", "0").split(",")[0]) or len(os.sched_getaffinity(0))


def copy_bandwidth(megabytes: int = 256) -> float:
    """Bytes read and written per second when as many threads as kernels use copy arrays from memory."""
    count = threads()
    source = np.ones((count, megabytes * 2**20 // 8))
    target = np.zeros_like(source)
    best = float("inf")
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        for _ in range(10):
            start = time.perf_counter()
            list(pool.map(np.copyto, target, source))
            best = min(best, time.perf_counter() - start)
    return 2 * source.nbytes / best


def peak_memory() -> int:
    """Bytes that this process has used at most."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def provide_geom() -> None:
    """Newer versions of the reference call peclet.core.geom peclet.geom."""
    try:
        importlib.import_module("peclet.core.geom")
    except ModuleNotFoundError:
        core = types.ModuleType("peclet.core")
        core.geom = importlib.import_module("peclet.geom")
        sys.modules["peclet.core"] = core


def run_child(script: str, task: dict[str, Any], python: str = sys.executable, threads: int = 0) -> Any:
    """What the measure() of this script returns in a process of its own."""
    environment = dict(os.environ)
    if python != sys.executable:
        environment.pop("PYTHONPATH", None)  # another environment has its own packages
    if threads:
        environment["OMP_NUM_THREADS"] = str(threads)
    command = [python, script, "--measure", json.dumps(task)]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment, check=False)
    if result.returncode:
        raise SystemExit(f"{python} {script}: expected exit status 0, found {result.returncode}")
    return json.loads(result.stdout.strip().splitlines()[-1])


def run(
    description: str,
    measure: Callable[..., Any],
    tabulate: Callable[[argparse.Namespace], Table],
    add_options: Callable[[argparse.ArgumentParser], None] = lambda parser: None,
) -> None:
    """Command line of a benchmark: print its table, and write it where --output says."""
    parser = argparse.ArgumentParser(description=description.partition("\n")[0])
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="rows as .json or .csv")
    parser.add_argument("--measure", type=json.loads, help=argparse.SUPPRESS)
    add_options(parser)
    options = parser.parse_args()
    if options.measure is not None:
        provide_geom()
        print(json.dumps(measure(**options.measure)))
        return
    table = tabulate(options)
    print(table)
    if options.output:
        table.write(options.output)


def release_of_reference(python: str) -> str:
    """Version of the package that this interpreter has installed."""
    ask = "import importlib.metadata; print(importlib.metadata.version('peclet-flow'))"
    return subprocess.run([python, "-c", ask], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


def add_reference(parser: argparse.ArgumentParser) -> None:
    """--reference: the interpreter of another environment."""
    parser.add_argument(
        "--reference",
        metavar="PYTHON",
        help="interpreter with the reference (peclet-flow, -dem, -geom) installed",
    )


def _rounded(value: Value) -> Value:
    return value if value is None or isinstance(value, str) else float(f"{value:.4g}")


def _text(value: Value) -> str:
    return "" if value is None else value if isinstance(value, str) else f"{value:.4g}"
