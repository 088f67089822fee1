"""Run the full version of cases and record what is found: python -m examples.validation.record [word ...]

Every case runs whose name contains one of the words, or all of them.
"""

from __future__ import annotations

import sys
import time

from examples.validation.cases import CASES, Case, Curves
from examples.validation.results import table, write, write_curve


def run(case: Case) -> None:
    """Print and record the rows of a case."""
    begin = time.perf_counter()
    curves: Curves = {}
    rows = case.full(curves)
    write(rows)
    for name, columns in curves.items():
        write_curve(name, columns)
    print(f"{case.name}: {time.perf_counter() - begin:.0f} s\n{table(rows)}\n", flush=True)


def main(words: list[str]) -> None:
    """Run the cases whose names contain one of the words, or all."""
    for case in CASES:
        if not words or any(word in case.name for word in words):
            run(case)


if __name__ == "__main__":
    main(sys.argv[1:])
