"""Drafting, kissing and tumbling of two spheres: run, print what is found, write figures and history.

./dev dkt --resolution 12 --contact both
"""

from __future__ import annotations

import argparse
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent)]

import local_build  # noqa: E402

local_build.use_local_build()

import dkt  # noqa: E402
import figures  # noqa: E402
import report  # noqa: E402


def parse(arguments: list[str] | None) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument(
        "--resolution",
        type=int,
        choices=dkt.RESOLUTIONS,
        default=8,
        help="cells per diameter (published: 12)",
    )
    parser.add_argument("--steps", type=positive, help="steps of time (default: the whole run of 0.643 s)")
    parser.add_argument(
        "--output", type=pathlib.Path, default=pathlib.Path("results/drafting-kissing-tumbling")
    )
    parser.add_argument(
        "--contact",
        choices=(*dkt.CONTACTS, "both"),
        default="proper",
        help="proper: velocities are resolved; position-only: as in the published run",
    )
    parser.add_argument("--scheme", choices=tuple(dkt.SCHEMES), default="koren", help="advection")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    return parser.parse_args(arguments)


def positive(text: str) -> int:
    """A number of steps."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"expected a positive integer, found {text}")
    return number


def main(arguments: list[str] | None = None) -> int:
    """Run, print and write; a run stopped by Ctrl-C is reported as far as it got."""
    options = parse(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    kinds = dkt.CONTACTS if options.contact == "both" else (options.contact,)
    results = []
    for kind in kinds:
        case = dkt.Case(options.resolution, kind, options.scheme)
        steps = options.steps or case.number_of_steps
        size = " x ".join(map(str, case.cells))
        print(f"d/h = {case.resolution}, {size} cells, {steps} steps, {kind} contact")
        result = dkt.run(case, steps, progress=not options.quiet)
        results.append(result)
        print(report.describe(result))
        name = options.output / f"d{case.resolution}-{kind}"
        result.write_csv(name.with_suffix(".csv"))
        figures.draw_slices(result).savefig(f"{name}-vorticity.png", dpi=200)
        if result.is_interrupted:
            break
    figures.draw_history(results).savefig(options.output / f"d{options.resolution}-history.png", dpi=200)
    print(f"Figures and history are in {options.output}/")
    return 130 if results[-1].is_interrupted else 0


if __name__ == "__main__":
    sys.exit(main())
