"""A cylinder that oscillates in line with its motion in fluid at rest, in diameters and its largest speed."""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

from examples.validation.channel import ALONG_Z

REYNOLDS, KEULEGAN_CARPENTER = 100, 5.0
PERIOD = KEULEGAN_CARPENTER
OMEGA = 2 * np.pi / PERIOD
AMPLITUDE = 1 / OMEGA


@dataclasses.dataclass(frozen=True)
class Oscillation:
    """Force along x over rho U^2 d / 2, at times over d / U; the velocity over U is -cos(omega t)."""

    time: np.ndarray
    force: np.ndarray
    per_period: int

    def morison(self) -> tuple[float, float]:
        """c_d and c_m of F = -rho d c_d |u| u / 2 - pi/4 rho d^2 c_m du/dt, fitted to the last period."""
        time, force = self.time[-self.per_period :], self.force[-self.per_period :]
        u, a = -np.cos(OMEGA * time), OMEGA * np.sin(OMEGA * time)
        terms = np.stack([-np.abs(u) * u, -np.pi / 2 * a], axis=1)
        drag, added = np.linalg.lstsq(terms, force, rcond=None)[0]
        return float(drag), float(added)

    def roughness(self) -> float:
        """Root mean square of what is above the 20th harmonic in the last period, over the amplitude."""
        force = self.force[-self.per_period :]
        spectrum = np.fft.rfft(force)
        spectrum[:21] = 0
        return float(np.sqrt(np.mean(np.fft.irfft(spectrum, len(force)) ** 2)) / np.abs(force).max())


def run(
    resolution: int,
    *,
    length: float = 16,
    width: float = 16,
    periods: int = 6,
    per_period: int | None = None,
    scheme: str = "koren",
) -> Oscillation:
    """Half of the box, y >= 0, is computed; all sides are planes of symmetry."""
    per_period = per_period or 16 * resolution
    h, dt = 1 / resolution, PERIOD / per_period
    nx, ny = round(length * resolution), round(width / 2 * resolution)
    solver = Solver((nx, ny, 1), extent=(length, width / 2, h), origin=(-length / 2, 0, 0))
    for side in ("-x", "+x", "-y", "+y"):
        solver.set_domain_bc(side, "slip")
    scene = SceneBuilder()
    cylinder = scene.add_leaf("capsule", [0.5, 1.0], rotation=ALONG_Z)
    scene.add_instance(cylinder, translation=[0, 0, h / 2])
    solver.set_scene(*scene.encode())
    solver.set_solid_from_scene()
    solver.set_rho(1)
    solver.set_mu(1 / REYNOLDS)
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    solver.set_dt(dt)
    times, forces = [], []
    for n in range(1, periods * per_period + 1):
        time = n * dt
        solver.set_instance_transform(0, [-AMPLITUDE * np.sin(OMEGA * time), 0, h / 2])
        solver.set_instance_motion(0, (-np.cos(OMEGA * time), 0, 0))
        solver.step()
        # twice the force on the half; that of a step belongs to its middle
        times.append(time - dt / 2)
        forces.append(2 * 2 * solver.hydro_force_torque_reaction()[0, 0, 0] / h)
    return Oscillation(np.array(times), np.array(forces), per_period)
