"""Simple cubic arrays of spheres in cell units: drag at rest and towed, torque of spinning spheres."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver


def radius_of(solid_fraction: float, volume: float) -> float:
    """Radius of the sphere that fills this fraction of the volume."""
    return float((3 * solid_fraction * volume / (4 * np.pi)) ** (1 / 3))


def make_array(cells: int, solid_fraction: float, center: Sequence[float], dt: float, mu: float) -> Solver:
    """One sphere in a periodic cell, fluid at rest, without inertia."""
    solver = Solver(cells, cells, cells)
    solver.set_rho(1)
    solver.set_mu(mu)
    solver.set_dt(dt)
    scene = SceneBuilder()
    sphere = scene.add_leaf("sphere", [radius_of(solid_fraction, cells**3)])
    scene.add_instance(sphere, translation=list(center))
    solver.set_scene(*scene.encode(), periodic=True)
    solver.set_solid_from_scene()
    return solver


def drag_at_rest(
    cells: int, solid_fraction: float, shift: Sequence[float] = (0, 0, 0)
) -> tuple[float, float]:
    """K = f L^3 / (6 pi mu a U), U the mean velocity with zero inside the sphere, and the force on it.

    The force is in units of (1 - phi) f L^3, what the fluid receives from the body force f.
    """
    body_force, mu = 1e-3, 1.0
    dt = 2.0 * (cells / 16) ** 2
    solver = make_array(cells, solid_fraction, (cells - 1) / 2 + np.array(shift), dt, mu)
    solver.set_body_force(body_force, 0, 0)
    mean = 0.0
    for _ in range(400):
        solver.step()
        old, mean = mean, solver.get_u().mean()
        if abs(mean - old) <= 1e-7 * abs(mean):
            break
    else:
        raise RuntimeError("the flow is not steady")
    drag = body_force * cells**3
    force = solver.hydro_force_torque_reaction()[0, 0, 0]
    return drag / (6 * np.pi * mu * radius_of(solid_fraction, cells**3) * mean), force / (
        (1 - solid_fraction) * drag
    )


@dataclasses.dataclass(frozen=True)
class Towed:
    """Step by step, with U the mean velocity relative to the spheres with zero inside.

    force: K = F / ((1 - phi) 6 pi mu a U) of the force F on the sphere.
    """

    force: np.ndarray
    reynolds: float


def towed(
    cells: int,
    courant: float,
    distance: float,
    settle: int,
    *,
    start: Sequence[float] = (0.1, 0.3, -0.2),
    solid_fraction: float = 0.064,
    reynolds: float | None = None,
    scheme: str = "koren",
    in_own_frame: bool = False,
) -> Towed:
    """The steps that cover the distance (in cells), after settle steps; start: from the middle of the box.

    A body force f with f (1 - phi) L^3 = F of the step before holds the total momentum of the fluid, so that
    the mean flow settles. Without a Reynolds number (speed of the sphere times diameter / nu) there is no
    advection. In their own frame the spheres stay, and the fluid starts with their speed.
    """
    speed = 0.01
    radius = radius_of(solid_fraction, cells**3)
    mu = 1.0 if reynolds is None else 2 * radius * speed / reynolds
    dt = courant / speed
    center = (cells - 1) / 2 + np.array(start)
    solver = make_array(cells, solid_fraction, center, dt, mu)
    if reynolds is not None:
        solver.set_advection_scheme(scheme)
        solver.set_advection(True)
    if in_own_frame:
        still = np.zeros((cells,) * 3)
        solver.set_state(still + speed, still, still)
    else:
        solver.set_instance_motion(0, (speed, 0, 0))
    force, forces, relative = 0.0, [], 0.0
    fluid_volume = (1 - solid_fraction) * cells**3
    for step in range(settle + round(distance / courant)):
        if not in_own_frame:
            center[0] += speed * dt
            solver.set_instance_transform(0, center)
        solver.set_body_force(force / fluid_volume, 0, 0)
        solver.step()
        force = solver.hydro_force_torque_reaction()[0, 0, 0]
        u = solver.get_u()
        fluid_points = np.count_nonzero(u) / u.size  # solid points show zero
        relative = u.mean() - (0 if in_own_frame else speed * fluid_points)
        if step >= settle:
            forces.append(force / (1 - solid_fraction) / (6 * np.pi * mu * radius * relative))
    return Towed(np.array(forces), abs(relative) * 2 * radius / mu)


def noise(factors: np.ndarray) -> tuple[float, float]:
    """Root mean square and largest deviation from the straight line through the factors, over their mean."""
    steps = np.arange(len(factors))
    deviation = (factors - np.polyval(np.polyfit(steps, factors, 1), steps)) / factors.mean()
    return float(np.sqrt(np.mean(deviation**2))), float(np.abs(deviation).max())


def torque(cells: int, solid_fraction: float, shift: Sequence[float] = (0, 0, 0)) -> tuple[float, float]:
    """-T / (8 pi mu a^3 Omega) of a sphere that spins about y, and the torque across over that one."""
    mu, spin = 0.5, 0.01
    dt = 20 * (cells / 20) ** 2
    solver = make_array(cells, solid_fraction, (cells - 1) / 2 + np.array(shift), dt, mu)
    solver.set_instance_motion(0, (0, 0, 0), (0, spin, 0))
    found = np.zeros(3)
    for _ in range(200):
        solver.step()
        old, found = found, solver.hydro_force_torque_reaction()[1, 0]
        if np.abs(found - old).max() <= 1e-5 * np.abs(found).max():
            break
    else:
        raise RuntimeError("the flow is not steady")
    unit = 8 * np.pi * mu * radius_of(solid_fraction, cells**3) ** 3 * spin
    return -found[1] / unit, np.abs(found[[0, 2]]).max() / abs(found[1])
