"""A single sphere that settles in a wide tank, at moderate Reynolds numbers."""

from __future__ import annotations

import numpy as np

from examples.validation.walls import SphereInBox


def schiller_naumann(reynolds: float) -> float:
    """Drag coefficient of a sphere in unbounded fluid [SchillerNaumann1933]."""
    return 24 / reynolds * (1 + 0.15 * reynolds**0.687)


def terminal_speed(
    reynolds: float, resolution: int, *, density_ratio: float = 1.5, width: float = 8, height: float = 24
) -> tuple[np.ndarray, np.ndarray]:
    """Distance fallen in diameters, and speed over that at which weight and drag balance.

    The drag is that of schiller_naumann().
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
    while position > 4 * d:
        box.place(position, velocity)
        acceleration = (box.step() - weight + added * acceleration) / (mass + added)
        velocity += acceleration * dt
        position += velocity * dt
        fallen.append((start - position) / d)
        speeds.append(-velocity / speed)
    return np.array(fallen), np.array(speeds)
