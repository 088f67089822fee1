"""A single sphere that settles in a wide tank, at moderate Reynolds numbers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from examples.validation.walls import SphereInBox


def schiller_naumann(reynolds: float) -> float:
    """Drag coefficient of a sphere in unbounded fluid [SchillerNaumann1933]."""
    return 24 / reynolds * (1 + 0.15 * reynolds**0.687)


def clift_grace_weber(reynolds: float) -> float:
    """The same for Reynolds numbers from 20 to 260 [CliftGraceWeber1978]."""
    return 24 / reynolds * (1 + 0.1935 * reynolds**0.6305)


def speed_of_balance(drag: Callable[[float], float], reynolds: float) -> float:
    """Speed at which this drag carries the weight over that at which schiller_naumann() does."""
    weight = schiller_naumann(reynolds) * reynolds**2
    speeds = np.linspace(0.8, 1.2, 4001)
    return float(np.interp(weight, [drag(u * reynolds) * (u * reynolds) ** 2 for u in speeds], speeds))


def settle(
    reynolds: float, resolution: int, *, density_ratio: float = 1.5, width: float = 8, height: float = 24
) -> tuple[np.ndarray, np.ndarray]:
    """Distance fallen in diameters, and speed over that at which weight and drag balance.

    The drag is that of schiller_naumann(). It falls until its centre is eight diameters above the floor,
    which below that slows it down.
    """
    d, speed = resolution, 1.0
    cells = (round(width * d), round(width * d), round(height * d))
    mu, dt = speed * d / reynolds, 0.3 / speed
    position = (height - 3) * d + 0.2
    box = SphereInBox(cells, d / 2, position, "slip", mu=mu, dt=dt)
    box.solver.set_advection_scheme("koren")
    box.solver.set_advection(True)
    volume = np.pi / 6 * d**3
    weight = schiller_naumann(reynolds) * 0.5 * speed**2 * np.pi / 4 * d**2
    mass = density_ratio * volume
    added = 0.5 * volume + 3 * d**2 * np.sqrt(np.pi * mu * dt)
    start, velocity, acceleration = position, 0.0, 0.0
    fallen, speeds = [], []
    while position > 8 * d:
        box.place(position, velocity)
        acceleration = (box.step() - weight + added * acceleration) / (mass + added)
        velocity += acceleration * dt
        position += velocity * dt
        fallen.append((start - position) / d)
        speeds.append(-velocity / speed)
    return np.array(fallen), np.array(speeds)


def terminal_speed(fallen: np.ndarray, speeds: np.ndarray, over: float = 2) -> float:
    """Mean over the last diameters of the fall."""
    return float(speeds[fallen >= fallen[-1] - over].mean())
