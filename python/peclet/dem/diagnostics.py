"""What one looks at to judge a run; nothing here changes it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from peclet import _checks
from peclet.dem import _dem


def _rotate(quaternions: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    axis, w = quaternions[:, :3], quaternions[:, 3:]
    t = 2.0 * np.cross(axis, vectors)
    return vectors + w * t + np.cross(axis, t)


def _inverse(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """1 / values; what cannot move (zero) counts as nothing."""
    return np.divide(1.0, values, out=np.zeros_like(values), where=values > 0)


class Diagnostics:
    """Instruments of one simulation, as ``sim.diagnostics``."""

    def __init__(self, core: _dem.Simulation) -> None:
        self._core = core
        self._velocity_solver = "gs"

    def contacts(self) -> dict[str, NDArray[Any]]:
        """Contacts of the last substep, one row each: ``bodies`` (n, 2) int32 (second < 0: wall -1 - value,
        counted over planes and scene walls in the order of their addition), ``normal`` (n, 3) from the
        second body to the first, ``impulse`` (n, 3) on the first body over the substep (divide by dt for
        the mean force), ``gap`` (n,) at the start of the substep, ``color`` (n,).
        """
        return self._core.contacts()

    def solver_report(self) -> dict[str, Any]:
        """Sweeps, last residuals and seconds of the last substep."""
        return self._core.report()

    def profiling_info(self) -> dict[str, float]:
        """Seconds of the last substep by part."""
        return {name: value for name, value in self._core.report().items() if name.endswith("_seconds")}

    def coloring_conflicts(self) -> tuple[int, int]:
        """Pairs of contacts treated at the same time although they share a particle (always 0), and
        contacts that were visited one by one.
        """
        return self._core.coloring_conflicts()

    def set_velocity_solver(self, name: str) -> None:
        """'gs' or 'jacobi', accepted from scripts, without effect: velocities are always settled by
        Gauss-Seidel sweeps that give the same result for any number of threads.
        """
        self._velocity_solver = _checks.choice(name, "name", ("gs", "jacobi"))

    @property
    def velocity_solver(self) -> str:
        """Set by set_velocity_solver."""
        return self._velocity_solver

    def wall_sdf_at(self, wall_index: int, points: ArrayLike) -> NDArray[np.float64]:
        """Signed distance of points (n, 3) from a scene wall, positive on the free side."""
        return self._core.wall_distances(_checks.integer(wall_index, "wall_index"), points)

    def kinetic_energy(self) -> float:
        """Translation and rotation of all bodies that are not fixed."""
        mass = _inverse(self._core.get_inv_mass())
        velocity = self._core.get_velocities()
        spin, momentum = self._core.get_angular_velocities(), self._spin_momentum()
        return float(0.5 * np.sum(mass * np.sum(velocity**2, axis=1)) + 0.5 * np.sum(spin * momentum))

    def linear_momentum(self) -> NDArray[np.float64]:
        """(3,), of all bodies that are not fixed."""
        return _inverse(self._core.get_inv_mass()) @ self._core.get_velocities()

    def angular_momentum(self, about: ArrayLike = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
        """(3,), of all bodies that are not fixed, about a point."""
        arm = self._core.get_positions() - np.array(_checks.vector(about, "about"))
        mass = _inverse(self._core.get_inv_mass())[:, None]
        return np.sum(np.cross(arm, mass * self._core.get_velocities()) + self._spin_momentum(), axis=0)

    def _spin_momentum(self) -> NDArray[np.float64]:
        """R I R^T w"""
        quaternions = self._core.get_quaternions()
        back = quaternions * np.array([-1.0, -1.0, -1.0, 1.0])
        inertia = _inverse(self._core.get_inv_inertia())
        return _rotate(quaternions, inertia * _rotate(back, self._core.get_angular_velocities()))
