"""A cylinder that oscillates in line with its motion in fluid at rest, in diameters and its largest speed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

from examples.validation.channel import ALONG_Z
from examples.validation.results import published

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

    @property
    def last_period(self) -> Oscillation:
        """The end of the history."""
        return Oscillation(self.time[-self.per_period :], self.force[-self.per_period :], self.per_period)

    def morison(self) -> tuple[float, float]:
        """c_d and c_m of F = -rho d c_d |u| u / 2 - pi/4 rho d^2 c_m du/dt, averages over the last period.

        Both sides of the formula are multiplied by u or du/dt and averaged. In this reading the force in
        unbounded fluid, computed independently (polar.py), has the published coefficients to 0.5 %. A fit by
        least squares, which weighs the force by |u| u, makes c_d 3 % smaller from the same force.
        """
        last = self.last_period
        phase = OMEGA * last.time
        # averages of |u|^3 and of (du/dt)^2
        drag = np.mean(last.force * np.cos(phase)) / (4 / (3 * np.pi))
        added = -np.mean(last.force * np.sin(phase)) / (np.pi / 2 * OMEGA / 2)
        return float(drag), float(added)

    def roughness(self) -> float:
        """Root mean square of what is above the 20th harmonic in the last period, over the peak."""
        force = self.last_period.force
        spectrum = np.fft.rfft(force)
        spectrum[:21] = 0
        return float(np.sqrt(np.mean(np.fft.irfft(spectrum, len(force)) ** 2)) / np.abs(force).max())

    def deviation(self, phase: np.ndarray, force: np.ndarray) -> float:
        """Root mean square of the difference from a force at phases (in periods), over the peak of that."""
        last = self.last_period
        expected = np.interp(last.time / PERIOD, phase, force, period=1)
        return float(np.sqrt(np.mean((last.force - expected) ** 2)) / np.abs(force).max())


def unbounded_force() -> tuple[np.ndarray, np.ndarray]:
    """Phases in periods, and the force in unbounded fluid in the sixth period, as polar.py computes it."""
    lines = published("oscillating_cylinder_force")
    return (
        np.array([float(line["phase"]) for line in lines]),
        np.array([float(line["force"]) for line in lines]),
    )


def make_solver(resolution: int, length: float, width: float, sides: tuple[str, ...], scheme: str) -> Solver:
    """Half of the box, y >= 0, with planes of symmetry on these sides; the cylinder in the middle."""
    h = 1 / resolution
    nx, ny = round(length * resolution), round(width / 2 * resolution)
    solver = Solver((nx, ny, 1), extent=(length, width / 2, h), origin=(-length / 2, 0, 0))
    for side in sides:
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
    return solver


def run(
    resolution: int,
    *,
    length: float = 16,
    width: float = 16,
    periods: int = 6,
    per_period: int | None = None,
    scheme: str = "koren",
) -> Oscillation:
    """The cylinder moves; all sides are planes of symmetry."""
    per_period = per_period or 32 * resolution
    solver = make_solver(resolution, length, width, ("-x", "+x", "-y", "+y"), scheme)

    def move(time: float, _: float) -> None:
        solver.set_instance_transform(0, [-AMPLITUDE * np.sin(OMEGA * time), 0, 1 / resolution / 2])
        solver.set_instance_motion(0, (-np.cos(OMEGA * time), 0, 0))

    return march(solver, per_period, periods, move)


def run_at_rest(
    resolution: int,
    *,
    length: float = 12,
    width: float = 12,
    periods: int = 4,
    per_period: int | None = None,
    scheme: str = "koren",
) -> Oscillation:
    """In the frame of the cylinder: a body force -rho dU/dt moves the fluid, the box is periodic along x.

    The pressure is that of the other frame, and so is the force.
    """
    per_period = per_period or 32 * resolution
    solver = make_solver(resolution, length, width, ("-y", "+y"), scheme)
    solver.set_velocity(0, np.ones(solver.cells))

    def push(time: float, dt: float) -> None:
        solver.set_body_force((np.cos(OMEGA * time) - np.cos(OMEGA * (time - dt))) / dt, 0, 0)

    return march(solver, per_period, periods, push)


def march(
    solver: Solver, per_period: int, periods: int, drive: Callable[[float, float], None]
) -> Oscillation:
    """Forces of steps of equal length; drive(time, dt) comes before the step that ends at time."""
    dt = PERIOD / per_period
    solver.set_dt(dt)
    times, forces = dt * np.arange(1, periods * per_period + 1), []
    for time in times:
        drive(time, dt)
        solver.step()
        # over rho U^2 d / 2, twice that on the half
        forces.append(2 * 2 * solver.hydro_force_torque_reaction()[0, 0, 0] / solver.spacing[2])
    # the force of a step belongs to its middle
    return Oscillation(times - dt / 2, np.array(forces), per_period)
