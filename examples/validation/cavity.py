"""Lid-driven cavity: the unit square, whose upper side slides along x with speed 1."""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.flow import Solver


@dataclasses.dataclass(frozen=True)
class Cavity:
    """Steady velocity on the two centrelines, walls included."""

    reynolds: float
    cells: int
    y: np.ndarray
    u: np.ndarray  # on x = 1/2
    x: np.ndarray
    v: np.ndarray  # on y = 1/2
    steps: int

    @property
    def extrema(self) -> dict[str, float]:
        """Largest and smallest values of the parabolas through the three points around each extremum."""
        return {
            "u_min": peak(self.y, self.u, -1),
            "v_max": peak(self.x, self.v, 1),
            "v_min": peak(self.x, self.v, -1),
        }


def peak(s: np.ndarray, values: np.ndarray, sign: int) -> float:
    """Extremum of the parabola through the three points around the largest of sign * values."""
    middle = int(np.argmax(sign * values[1:-1])) + 1
    around = slice(middle - 1, middle + 2)
    a, b, c = np.polyfit(s[around] - s[middle], values[around], 2)
    return float(c - b**2 / (4 * a))


def solve(reynolds: float, cells: int, *, scheme: str = "central", change: float = 1e-6) -> Cavity:
    """March until the velocity changes by less than `change` per unit of time."""
    h = 1 / cells
    solver = Solver((cells, cells, 1), extent=(1, 1, h))
    for side in ("-x", "+x", "-y"):
        solver.set_domain_bc(side, "wall")
    solver.set_domain_bc("+y", "wall", [1, 0, 0])
    solver.set_rho(1)
    solver.set_mu(1 / reynolds)
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    solver.set_dt(0.8 * h)
    old = solver.get_u()
    while True:
        for _ in range(20):
            solver.step()
        new = solver.get_u()
        if np.abs(new - old).max() <= change * 20 * solver.dt:
            break
        old = new
    centers = (np.arange(cells) + 0.5) * h
    u, v = solver.get_u()[cells // 2, :, 0], solver.get_v()[:, cells // 2, 0]
    inside = np.concatenate([[0], centers, [1]])
    return Cavity(
        reynolds,
        cells,
        y=inside,
        u=np.concatenate([[0], u, [1]]),
        x=inside,
        v=np.concatenate([[0], v, [0]]),
        steps=solver.number_of_steps,
    )
