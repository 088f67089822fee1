"""Share of the geometry update in a step when a hundred spheres move through a periodic box."""

import argparse

import harness
import numpy as np
import towed_spheres


def lattice(count: int, size: int) -> np.ndarray:
    """Off-lattice positions on a cubic arrangement with at least count places."""
    per_side = int(np.ceil(count ** (1 / 3)))
    sites = np.stack(np.meshgrid(*[np.arange(per_side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    jitter = np.random.default_rng(1).uniform(-1, 1, sites.shape)
    return ((sites + 0.5) * size / per_side + jitter)[:count]


def measure(count: int, size: int, radius: float, steps: int) -> dict:
    """Medians over the steps."""
    positions = lattice(count, size)
    velocities = np.random.default_rng(2).uniform(-0.1, 0.1, positions.shape)
    return towed_spheres.march(size, radius, positions, velocities, steps)


def tabulate(options: argparse.Namespace) -> harness.Table:
    """Share of the geometry, then the parts."""
    table = harness.Table("geometry", (*harness.QUANTITIES, "share"))
    task = {"count": options.count, "size": options.size, "radius": options.radius, "steps": options.steps}
    found = harness.run_child(__file__, task)
    seconds, parts = found["seconds"], {name: value for name, value in found["parts"].items() if value > 0}
    surface = options.count * 4 * np.pi * options.radius**2
    table.add("geometry / step", parts["geometry"] / seconds, "", "<= 0.1")
    table.add("geometry per surface cell", 1e9 * parts["geometry"] / surface, "ns")
    table.add("step", 1e3 * seconds, "ms", "", 1.0)
    table.add("pressure iterations", found["iterations"], "", "<= 8")
    for name, value in parts.items():
        table.add(name, 1e3 * value, "ms", "", value / seconds)
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The case."""
    parser.add_argument("--count", type=int, default=100, help="moving spheres")
    parser.add_argument("--size", type=int, default=160, help="cells along each axis")
    parser.add_argument("--radius", type=float, default=4.0, help="in cells")
    parser.add_argument("--steps", type=int, default=15)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
