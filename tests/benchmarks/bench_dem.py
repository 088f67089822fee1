"""Time of one contact step per particle: a falling gas of spheres and the bed it becomes."""

import argparse
import time

import numpy as np
from peclet import dem


def lattice(count, spacing, generator):
    """Jittered simple cubic lattice of about count spheres, and its side."""
    per_side = max(2, round(count ** (1 / 3)))
    sites = np.stack(np.meshgrid(*[np.arange(per_side)] * 3, indexing="ij"), -1).reshape(-1, 3)
    jitter = generator.uniform(-0.4, 0.4, sites.shape) * (spacing - 1)
    return (sites + 0.5) * spacing + jitter, per_side * spacing


def make(count, friction):
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
    return sim


def measure(sim, steps):
    sim.step(0.01)
    parts = dict.fromkeys(sim.diagnostics.profiling_info(), 0.0)
    start = time.perf_counter()
    for _ in range(steps):
        sim.step(0.01)
        for name, seconds in sim.diagnostics.profiling_info().items():
            parts[name] += seconds / steps
    return (time.perf_counter() - start) / steps, parts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--counts", type=int, nargs="+", default=[2, 1000, 10000, 100000])
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--friction", type=float, default=0.3)
    options = parser.parse_args()
    print(f"contact step, {dem.execution_space}, {options.steps} steps each")
    print("particles  contacts   s/step   us/particle   search  velocity  position   force sweeps")
    for count in options.counts:
        sim = make(count, options.friction)
        seconds, parts = measure(sim, options.steps)
        shares = "".join(f"{100 * part / seconds:8.0f} %" for part in parts.values())
        sweeps = sim.diagnostics.solver_report()["force_sweeps"]
        number = int(sim.num_particles)
        print(
            f"{number:9d} {int(sim.num_contacts):9d} {seconds:8.4f} {1e6 * seconds / number:13.2f} "
            f"{shares} {sweeps:14d}"
        )


if __name__ == "__main__":
    main()
