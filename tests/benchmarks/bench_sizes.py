"""Time and memory per cell of a step, from small boxes with one moving sphere to large ones with many."""

import argparse

import harness
import towed_spheres

CELLS_TIMES_STEPS = 30_000_000  # per size


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Spread of the time per cell, then one row per size."""
    columns = (
        "case",
        "ns/cell",
        "target",
        "s",
        "iterations",
        "peak B/cell",
        *(f"{p} ns/cell" for p in towed_spheres.PARTS),
    )
    table = harness.Table("sizes", columns)
    fastest: dict[int, dict] = {}
    for _ in range(options.rounds):
        for blocks in options.blocks:
            size = blocks * towed_spheres.BLOCK
            steps = min(100, max(4, CELLS_TIMES_STEPS // size**3))
            found = harness.run_child(__file__, {"blocks": blocks, "steps": steps})
            if blocks not in fastest or found["seconds"] < fastest[blocks]["seconds"]:
                fastest[blocks] = found
    for blocks, found in fastest.items():
        size = blocks * towed_spheres.BLOCK
        per_cell = [1e9 * value / size**3 for value in (found["seconds"], *found["parts"])]
        peak = found["peak"] / size**3
        row = (f"{size}^3", per_cell[0], "", found["seconds"], found["iterations"], peak, *per_cell[1:])
        table.add(*row)
    times = [row[1] for row in table.rows]
    table.rows.insert(0, ["largest / smallest", max(times) / min(times), "<= 1.3", *[None] * 8])
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The sizes, and how often to go through them: the fastest of each counts, as machines are disturbed."""
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument(
        "--blocks", type=int, nargs="+", default=[1, 2, 3, 4, 5, 7], help="of 48 cells along each axis"
    )


if __name__ == "__main__":
    harness.run(__doc__, towed_spheres.measure, tabulate, add_options)
