"""Time of one contact step per particle: a falling gas of spheres and the bed it becomes."""

import argparse
import time

import harness
import numpy as np

PARTS = ("search", "velocity", "position")


def lattice(count: int, spacing: float, generator: np.random.Generator) -> tuple[np.ndarray, float]:
    """Jittered simple cubic lattice of about count spheres, and its side."""
    per_side = max(2, round(count ** (1 / 3)))
    sites = np.stack(np.meshgrid(*[np.arange(per_side)] * 3, indexing="ij"), -1).reshape(-1, 3)
    jitter = generator.uniform(-0.4, 0.4, sites.shape) * (spacing - 1)
    return (sites + 0.5) * spacing + jitter, per_side * spacing


def measure(count: int, steps: int, friction: float) -> dict:
    """Seconds per step, its parts, and how many particles and contacts there are."""
    from peclet import dem

    generator = np.random.default_rng(1)
    positions, side = lattice(count, 1.05, generator)
    sim = dem.Simulation(len(positions))
    sim.set_sphere_shape(0.5)
    sim.set_material_params(0.3, 0.0, friction)
    sim.set_gravity(0, 0, -1)
    sim.set_positions(positions)
    sim.set_velocities(generator.normal(0, 0.1, positions.shape))
    sim.set_domain((side, side, 2 * side))
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.step(0.01)
    parts = np.zeros(len(PARTS))
    start = time.perf_counter()
    for _ in range(steps):
        sim.step(0.01)
        parts += list(sim.diagnostics.profiling_info().values())
    return {
        "seconds": (time.perf_counter() - start) / steps,
        "parts": (parts / steps).tolist(),
        "particles": int(sim.num_particles),
        "contacts": int(sim.num_contacts),
        "sweeps": sim.diagnostics.solver_report()["force_sweeps"],
    }


def tabulate(options: argparse.Namespace) -> harness.Table:
    """One row per number of particles."""
    shares = (f"{name} share" for name in PARTS)
    columns = ("particles", "contacts", "ms", "us/particle", *shares, "force sweeps")
    table = harness.Table("dem", columns)
    for count in options.counts:
        task = {"count": count, "steps": options.steps, "friction": options.friction}
        found = harness.run_child(__file__, task)
        seconds, particles = found["seconds"], found["particles"]
        parts = [part / seconds for part in found["parts"]]
        row = (found["contacts"], 1e3 * seconds, 1e6 * seconds / particles, *parts, found["sweeps"])
        table.add(str(particles), *row)
    return table


def add_options(parser: argparse.ArgumentParser) -> None:
    """The numbers of particles."""
    parser.add_argument("--counts", type=int, nargs="+", default=[2, 1000, 10000, 100000])
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--friction", type=float, default=0.3)


if __name__ == "__main__":
    harness.run(__doc__, measure, tabulate, add_options)
