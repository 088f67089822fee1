"""A sphere in a box with sides, in cell units and without inertia of the flow's own (no advection).

With symmetric=True only the quarter of the box around the edge at the low sides of x and y is computed: these
sides are planes of symmetry through the centre, and forces along z are multiplied by four.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

SIDES = ("-x", "+x", "-y", "+y", "-z", "+z")


@dataclasses.dataclass
class SphereInBox:
    """A sphere on the axis of a box that is symmetric in x and y; z = 0 is the lower side."""

    cells: tuple[int, int, int]  # of the whole box
    radius: float
    height: float  # of the centre
    sides: str = "wall"  # of x and y
    ends: tuple[str, str] = ("wall", "wall")  # of z
    symmetric: bool = True
    mu: float = 1.0
    dt: float = 1.0

    def __post_init__(self) -> None:
        nx, ny, nz = self.cells
        part = 2 if self.symmetric else 1
        if nx % part or ny % part:
            raise ValueError(f"cells: expected even numbers along x and y, found {self.cells}")
        shape = (nx // part, ny // part, nz)
        self.share = 1 / part**2
        solver = Solver(shape, extent=shape)
        for side in SIDES[:4]:
            plane = self.symmetric and side.startswith("-")
            solver.set_domain_bc(side, "slip" if plane else self.sides)
        for side, kind in zip(SIDES[4:], self.ends, strict=True):
            solver.set_domain_bc(side, kind)
        self.axis = np.zeros(2) if self.symmetric else np.array([nx / 2, ny / 2])
        scene = SceneBuilder()
        scene.add_instance(scene.add_leaf("sphere", [self.radius]), translation=[*self.axis, self.height])
        solver.set_scene(*scene.encode(), periodic=self.sides == "periodic")
        solver.set_solid_from_scene()
        solver.set_rho(1)
        solver.set_mu(self.mu)
        solver.set_dt(self.dt)
        self.solver = solver

    def place(self, height: float, velocity: float) -> None:
        """Position and velocity along z."""
        self.height = height
        self.solver.set_instance_transform(0, [*self.axis, height])
        self.solver.set_instance_motion(0, (0, 0, velocity))

    def step(self) -> float:
        """One time step; returns the force on the whole sphere along z."""
        self.solver.step()
        return float(self.solver.hydro_force_torque_reaction()[0, 0, 2]) / self.share


def drag_in_closed_box(
    width: int,
    length: int,
    diameter: float,
    *,
    reynolds: float = 0.05,
    steps: int = 20,
    symmetric: bool = True,
) -> float:
    """K of a sphere that crosses the middle of a box of no-slip walls, averaged over one cell."""
    radius, mu = diameter / 2, 1.0
    speed = reynolds * mu / diameter
    dt = 1 / (speed * steps)
    box = SphereInBox((width, width, length), radius, 0.0, symmetric=symmetric, mu=mu, dt=dt)
    settle = steps // 2
    forces = []
    for n in range(-settle, steps):
        box.place(length / 2 - 0.5 + (n + 0.5) / steps, speed)
        force = box.step()
        if n >= 0:
            forces.append(force)
    return -float(np.mean(forces)) / (6 * np.pi * mu * radius * speed)


def brenner(gap: float) -> float:
    """K of a sphere of radius 1 that moves towards a plane [Brenner1961]."""
    alpha = np.arccosh(1 + gap)
    n = np.arange(1, 2 + int(40 / alpha))
    top = 2 * np.sinh((2 * n + 1) * alpha) + (2 * n + 1) * np.sinh(2 * alpha)
    bottom = 4 * np.sinh((n + 0.5) * alpha) ** 2 - (2 * n + 1) ** 2 * np.sinh(alpha) ** 2
    terms = n * (n + 1) / ((2 * n - 1) * (2 * n + 3)) * (top / bottom - 1)
    return float(4 / 3 * np.sinh(alpha) * terms.sum())


def drag_towards_plane(
    radius: float, width: int, first: float, last: float, *, reynolds: float = 0.02, steps: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    """Ascending gaps in radii that cover first >= gap >= last, and K of a sphere that nears the floor."""
    mu = 1.0
    speed = reynolds * mu / (2 * radius)
    dt = 1 / (speed * steps)  # a cell in so many steps
    start = radius * (1 + first) + 2
    box = SphereInBox((width, width, width), radius, start, sides="slip", ends=("wall", "slip"), mu=mu, dt=dt)
    heights, forces = [], []
    while not heights or heights[-1] > radius * (1 + last) - 0.5:
        heights.append((heights[-1] if heights else start) - speed * dt)
        box.place(heights[-1], -speed)
        forces.append(box.step())
    drags = np.array(forces) / (6 * np.pi * mu * radius * speed)
    return np.array(heights[::-1]) / radius - 1, drags[::-1]


def oscillation(
    radius: float, width: int, *, ratio: float = 2.0, per_period: int = 32, periods: int = 3
) -> tuple[float, float]:
    """In-phase and quadrature parts of -F / (6 pi mu a U0) against the velocity U0 cos(omega t).

    ratio: radius over the depth delta = sqrt(2 nu / omega) of the viscous layer. The box is periodic along z
    and has planes of symmetry on its other sides, as in a cubic array.
    """
    mu, dt = 1.0, None
    omega = 2 * mu * (ratio / radius) ** 2
    dt = 2 * np.pi / omega / per_period
    amplitude = 0.02 * radius
    middle = width / 2 + 0.3
    box = SphereInBox(
        (width, width, width), radius, middle, sides="slip", ends=("periodic", "periodic"), mu=mu, dt=dt
    )
    box.solver.set_prescribed_motion(True)
    forces = []
    for n in range(1, periods * per_period + 1):
        phase = omega * n * dt
        box.place(middle + amplitude * np.sin(phase), amplitude * omega * np.cos(phase))
        forces.append(box.step())
    last = np.array(forces[-per_period:]) / (6 * np.pi * mu * radius * amplitude * omega)
    # the force of a step is that of its middle
    phase = omega * dt * (np.arange(per_period) + 0.5)
    return -2 * float(np.mean(last * np.cos(phase))), 2 * float(np.mean(last * np.sin(phase)))


@dataclasses.dataclass(frozen=True)
class Fall:
    """Time over a^2 / nu and velocity over that of Stokes' law."""

    time: np.ndarray
    velocity: np.ndarray


def free_fall(
    radius: float,
    width: int,
    density_ratio: float,
    duration: float,
    *,
    reynolds: float = 0.02,
    dt: float = 0.05,
) -> Fall:
    """From rest; reynolds: that of the final velocity; times over a^2 / nu.

    The reaction to an acceleration within one step is treated implicitly as added mass m_a; the fluid is
    given the velocity v + dt/2 a_p that the sphere is predicted to have in the middle of the step, which
    changes by dt a_f:  (m + m_a) a = F + W + m_a a_f.
    """
    mu = 1.0
    unit = radius**2 / mu
    volume = 4 / 3 * np.pi * radius**3
    final = reynolds * mu / (2 * radius)
    weight = 6 * np.pi * mu * radius * final
    mass, step = density_ratio * volume, dt * unit
    added = 0.5 * volume + 12 * radius**2 * np.sqrt(np.pi * mu * step)
    middle = width / 2 + 0.3
    box = SphereInBox(
        (width, width, width), radius, middle, sides="slip", ends=("periodic", "periodic"), mu=mu, dt=step
    )
    position, velocity = middle, 0.0
    predicted = weight / (mass + added)
    felt = predicted / 2
    times, velocities = [0.0], [0.0]
    while times[-1] < duration - dt / 2:
        box.place(position, velocity + predicted * step / 2)
        acceleration = (box.step() + weight + added * felt) / (mass + added)
        felt, predicted = acceleration + (acceleration - predicted) / 2, acceleration
        velocity += acceleration * step
        position += velocity * step
        times.append(times[-1] + dt)
        velocities.append(velocity / final)
    return Fall(np.array(times), np.array(velocities))
