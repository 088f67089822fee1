"""Cylinder in a channel: the benchmark of Schaefer and Turek, in m, s and kg."""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

LENGTH, HEIGHT = 2.2, 0.41
DIAMETER = 0.1
CENTER = (0.2, 0.2)
VISCOSITY = 1e-3
# Unit quaternion (x, y, z, w) that turns the axis of a capsule from y to z.
ALONG_Z = (np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))


@dataclasses.dataclass(frozen=True)
class Channel:
    """Coefficients at every step: 2 F / (rho U^2 d), U two thirds of the largest inflow velocity."""

    time: np.ndarray
    drag: np.ndarray
    lift: np.ndarray
    pressure_difference: np.ndarray  # front less back
    largest_inflow: float

    def after(self, time: float) -> Channel:
        """The part of the history after this time."""
        late = self.time >= time
        return Channel(
            *(getattr(self, name)[late] for name in ("time", "drag", "lift", "pressure_difference")),
            self.largest_inflow,
        )

    @property
    def strouhal(self) -> float:
        """Frequency of the lift times d / U, from upward zero crossings of its deviation from the mean."""
        lift = self.lift - (self.lift.max() + self.lift.min()) / 2
        up = np.flatnonzero((lift[:-1] < 0) & (lift[1:] >= 0))
        if len(up) < 2:
            return float("nan")
        part = lift[up] / (lift[up] - lift[up + 1])
        crossing = self.time[up] + part * (self.time[up + 1] - self.time[up])
        frequency = (len(up) - 1) / (crossing[-1] - crossing[0])
        return float(frequency * DIAMETER / (2 / 3 * self.largest_inflow))


def make_solver(largest_inflow: float, resolution: int, scheme: str = "koren") -> Solver:
    """Channel with `resolution` cells per diameter, a multiple of ten; the fluid at rest."""
    h = DIAMETER / resolution
    nx, ny = round(LENGTH / h), round(HEIGHT / h)
    solver = Solver((nx, ny, 1), extent=(LENGTH, HEIGHT, h))
    y = (np.arange(ny) + 0.5) * h
    profile = np.zeros((ny, 1, 3))
    # cell means of the parabola, so that the flow rate is exact
    profile[:, 0, 0] = 4 * largest_inflow * (y * (HEIGHT - y) - h**2 / 12) / HEIGHT**2
    solver.set_domain_bc_profile("-x", profile)
    solver.set_domain_bc("+x", "outflow")
    solver.set_domain_bc("-y", "wall")
    solver.set_domain_bc("+y", "wall")
    scene = SceneBuilder()
    cylinder = scene.add_leaf("capsule", [DIAMETER / 2, 1.0], rotation=ALONG_Z)
    scene.add_instance(cylinder, translation=[*CENTER, h / 2])
    solver.set_scene(*scene.encode())
    solver.set_solid_from_scene()
    solver.set_rho(1)
    solver.set_mu(VISCOSITY)
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    return solver


def pressure_difference(solver: Solver) -> float:
    """Between front and back of the cylinder, linearly extrapolated from the two cells before each."""
    h = solver.spacing[0]
    p = solver.get_p()[:, :, 0]
    row = round(CENTER[1] / h)
    p = (p[:, row - 1] + p[:, row]) / 2
    front, back = round((CENTER[0] - DIAMETER / 2) / h), round((CENTER[0] + DIAMETER / 2) / h)
    return float(1.5 * (p[front - 1] - p[back]) - 0.5 * (p[front - 2] - p[back + 1]))


def run(
    largest_inflow: float, resolution: int, duration: float, *, scheme: str = "koren", courant: float = 0.5
) -> Channel:
    """From rest, with the largest time steps that the Courant number allows."""
    solver = make_solver(largest_inflow, resolution, scheme)
    h = solver.spacing[0]
    longest = courant * h / largest_inflow
    unit = 0.5 * (2 / 3 * largest_inflow) ** 2 * DIAMETER * h
    history = []
    while solver.time < duration:
        solver.step_adaptive(courant, dt_max=longest)
        force = solver.hydro_force_torque_reaction()[0, 0] / unit
        history.append((solver.time, force[0], force[1], pressure_difference(solver)))
    return Channel(*np.array(history).T, largest_inflow)
