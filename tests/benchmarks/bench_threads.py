"""Time of a step with one and more threads: spheres move through a periodic box."""

import argparse

import harness
import towed_spheres


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Speed-ups, then the times."""
    table = harness.Table("threads", (*harness.QUANTITIES, *towed_spheres.PARTS))
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64, 128) if n <= harness.threads()]
    found = {}
    for count in counts:
        task = {"blocks": options.blocks, "steps": options.steps}
        found[count] = harness.run_child(__file__, task, threads=count)
    for count in counts[1:]:
        parts = [one / many for one, many in zip(found[1]["parts"], found[count]["parts"], strict=True)]
        speed_up = found[1]["seconds"] / found[count]["seconds"]
        table.add(f"{count} threads, times faster", speed_up, "", ">= 1.7" if count == 2 else "", *parts)
    for count in counts:
        parts = [1e3 * value for value in found[count]["parts"]]
        table.add(f"{count} threads", 1e3 * found[count]["seconds"], "ms", "", *parts)
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The case."""
    parser.add_argument("--blocks", type=int, default=3, help="of 48 cells along each axis")
    parser.add_argument("--steps", type=int, default=10)


if __name__ == "__main__":
    harness.run(__doc__, towed_spheres.measure, tabulate, add_options)
