"""Run benchmarks and record their tables: python -m examples.performance.record [name ...]"""

from __future__ import annotations

import argparse
import json
import pathlib
import subprocess

from examples.performance.tables import DATA, NAMES, WITH_REFERENCE
from tests.benchmarks.harness import write_json

ROOT = pathlib.Path(__file__).resolve().parents[2]


def record(name: str, reference: str | None) -> None:
    """Run one benchmark and keep its rows, with machine and date."""
    path = DATA / f"{name}.json"
    path.parent.mkdir(exist_ok=True)
    command = [str(ROOT / "dev"), "bench", name, "--output", str(path)]
    if reference and name in WITH_REFERENCE:
        command += ["--reference", reference]
    subprocess.run(command, check=True, cwd=ROOT)
    write_json(path, json.loads(path.read_text(encoding="utf-8")))


def main() -> None:
    """Record the benchmarks that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("names", nargs="*", metavar="name", help=f"of {', '.join(NAMES)}")
    parser.add_argument("--reference", metavar="PYTHON", help="interpreter with the reference installed")
    options = parser.parse_args()
    for name in options.names:
        if name not in NAMES:
            parser.error(f"name: expected one of {', '.join(NAMES)}, found {name}")
    for name in options.names or NAMES:
        record(name, options.reference)


if __name__ == "__main__":
    main()
