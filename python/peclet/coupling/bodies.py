"""What the coupling must know of a rigid body beside its shape, and the inertia of the fluid around it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from peclet import _checks


@dataclasses.dataclass(frozen=True)
class Body:
    """A rigid body that the fluid moves.

    instance: its row in the scene of the flow solver; volume: of the fluid that it displaces;
    inertia: principal moments about the centre of mass, along the axes of its shape.
    """

    instance: int
    mass: float
    volume: float
    inertia: tuple[float, float, float]

    def __post_init__(self) -> None:
        _checks.integer(self.instance, "instance", low=0)
        _checks.positive(self.mass, "mass")
        _checks.positive(self.volume, "volume")
        moments = _checks.vector(self.inertia, "inertia")
        for axis, moment in enumerate(moments):
            _checks.positive(moment, f"inertia[{axis}]")
        if 2 * max(moments) > (1 + 1e-9) * sum(moments):
            raise ValueError(
                "inertia: expected moments of which none exceeds the sum of the others, as for every body, "
                f"found {tuple(self.inertia)}"
            )

    @classmethod
    def sphere(cls, instance: int, *, radius: float, density: float) -> Body:
        """A homogeneous sphere.

        >>> Body.sphere(1, radius=1.0, density=3.0).mass / math.pi
        4.0
        """
        radius = _checks.positive(radius, "radius")
        volume = 4 / 3 * math.pi * radius**3
        mass = _checks.positive(density, "density") * volume
        return cls(instance, mass, volume, (0.4 * mass * radius**2,) * 3)


@dataclasses.dataclass(frozen=True)
class FluidInertia:
    """How much the fluid resists an acceleration of each body within one time step, one entry per body.

    The reaction force to a change dv of the velocity over dt is about -(added_mass + damping) dv / dt, of
    which the first part stands only while the body accelerates and the second as long as it moves; likewise
    for rotations, where added_inertia has one value for each principal axis, shape (n, 3).
    """

    added_mass: NDArray[np.float64]
    damping: NDArray[np.float64]
    added_inertia: NDArray[np.float64]
    rotational_damping: NDArray[np.float64]


def _ellipsoid(body: Body) -> NDArray[np.float64]:
    """Semi-axes of the homogeneous ellipsoid with the mass and the moments of inertia of a body."""
    moments = np.array(body.inertia) / body.mass
    squares = 2.5 * moments.sum() - 5 * moments
    return np.sqrt(np.maximum(squares, (0.05**2) * squares.max()))  # not thinner than a disk of 1 : 20


def _added_by_pressure(semi_axes: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """Largest added mass and the added moments of inertia of an ellipsoid in ideal fluid, over the displaced
    mass [Lamb1932, sections 114 and 115].
    """
    x, weight = np.polynomial.legendre.leggauss(128)
    x, weight = 0.5 * (1 + x), 0.5 * weight
    largest = semi_axes.max() ** 2
    squares = semi_axes[:, None] ** 2 + largest * (x / (1 - x)) ** 2
    element = weight * 2 * largest * x / (1 - x) ** 3
    integrals = semi_axes.prod() * (element / (squares * np.sqrt(squares.prod(axis=0)))).sum(axis=1)
    moments = np.zeros(3)
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        difference = semi_axes[j] ** 2 - semi_axes[k] ** 2
        both = semi_axes[j] ** 2 + semi_axes[k] ** 2
        if abs(difference) > 1e-6 * both:
            slope = integrals[k] - integrals[j]
            moments[axis] = 0.2 * difference**2 * slope / (2 * difference - both * slope)
    return float((integrals / (2 - integrals)).max()), moments


def fluid_inertia(
    bodies: Sequence[Body],
    density: float,
    viscosity: float,
    time_step: float,
    coefficient: float | None = None,
) -> FluidInertia:
    """Estimated in unbounded fluid: viscosity adds what it does for the sphere of equal volume, radius a, and
    the pressure what it does for the ellipsoid of equal moments of inertia.

    A sphere that gains the velocity dv at once gives the fluid, within dt, the impulse
    dv (rho V / 2 + 12 a^2 sqrt(pi rho mu dt) + 6 pi mu a dt): added mass, history force and Stokes drag; one
    that gains the rate of rotation dw gives it dw (16/3 a^4 sqrt(pi rho mu dt) + 8 pi mu a^3 dt)
    [LandauLifshitz1987, section 24]. Of the drag half counts, that of the mean velocity in the step. Larger
    estimates are stable, too small ones are not, so the largest added mass and the largest semi-axis of the
    ellipsoid count.

    With a coefficient, the added mass is so many times the displaced mass and the damping zero.
    """
    volume = np.array([body.volume for body in bodies])
    a = np.cbrt(0.75 / math.pi * volume)
    ellipsoids = [_ellipsoid(body) for body in bodies]
    by_pressure = [_added_by_pressure(semi_axes) for semi_axes in ellipsoids]
    largest = np.array([semi_axes.max() for semi_axes in ellipsoids])
    layer = math.sqrt(math.pi * density * viscosity * time_step)
    if coefficient is None:
        added_mass, damping = (
            density * volume * [mass for mass, _ in by_pressure] + 12 * a**2 * layer,
            3 * math.pi * viscosity * a * time_step,
        )
    else:
        added_mass, damping = coefficient * density * volume, np.zeros_like(volume)
    return FluidInertia(
        added_mass=added_mass,
        damping=damping,
        added_inertia=density * volume[:, None] * [moments for _, moments in by_pressure]
        + (16 / 3 * largest**4 * layer)[:, None],
        rotational_damping=8 * math.pi * viscosity * a**3 * time_step,
    )
