"""Sides of the box."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from peclet import _checks
from peclet.flow import _flow
from peclet.flow._base import FACES, Part, face_number

SideKind = _flow.SideKind

_KINDS = {
    "periodic": SideKind.PERIODIC,
    "wall": SideKind.WALL,
    "inflow": SideKind.INFLOW,
    "outflow": SideKind.OUTFLOW,
    "slip": SideKind.SLIP,
}
_ALIASES = {
    "movingwall": "wall",
    "noslip": "wall",
    "dirichlet": "inflow",
    "freeslip": "slip",
    "symmetry": "slip",
}


class Side(NamedTuple):
    """Condition on one side of the box."""

    type: str
    velocity: tuple[float, float, float]


class Boundaries(Part):
    """Conditions on the six sides; they may be set at any time and take effect with the next step."""

    def set_domain_bc(self, face: str | int, type: str | int, *velocity: Any, **components: Any) -> None:
        """Condition on one side of the box.

        face: '-x', '+x', '-y', '+y', '-z' or '+z', or 0 to 5 in this order.

        type, or its number: 'periodic' (0, both sides of an axis or none), 'wall' (1, no slip; velocity: how
        it slides along itself), 'inflow' (2, prescribed velocity), 'outflow' (3, zero pressure, zero normal
        derivative of the velocity; fluid that flows back in brings no momentum), 'slip' (4, symmetry plane).

        velocity: one sequence of three, or three numbers; zero if left out. It may change between
        steps, which costs nothing; a change of the type samples the geometry anew and keeps the flow.

        A box with inflow needs an outflow, or inflows that balance each other: step() says so.

        >>> lid = Solver((16, 16, 1), extent=(1, 1, 1 / 16))
        >>> for side in ('-x', '+x', '-y'):
        ...     lid.set_domain_bc(side, 'wall')
        >>> lid.set_domain_bc('+y', 'wall', [1, 0, 0])
        >>> lid.domain_bc['+y']
        Side(type='wall', velocity=(1.0, 0.0, 0.0))
        """
        axis, high = divmod(face_number(face), 2)
        kind = _kind(type)
        self._core.set_side(axis, high, _KINDS[kind], _velocity(kind, axis, velocity, components))

    def set_domain_bc_profile(self, face: str | int, profile: Any) -> None:
        """Make a side an inflow with a velocity of its own in every face.

        profile: shape (n_b, n_c, 3), the velocity vector in the faces of the side, b and c being the two
        other axes in ascending order.
        """
        axis, high = divmod(face_number(face), 2)
        b, c = (a for a in range(3) if a != axis)
        values = _checks.field(profile, "profile", (self._cells[b], self._cells[c], 3))
        self._core.set_side_profile(axis, high, np.asfortranarray(values))

    @property
    def domain_bc(self) -> dict[str, Side]:
        """Condition on each side; where a profile is set, velocity is its mean."""
        sides = {}
        for number, face in enumerate(FACES):
            kind, velocity = self._core.side(number // 2, number % 2)
            name = next(name for name, value in _KINDS.items() if value == kind)
            sides[face] = Side(name, tuple(velocity))
        return sides


def _kind(kind: Any) -> str:
    names = list(_KINDS)
    expected = "one of " + ", ".join(map(repr, names)) + ", or 0 to 4"
    if isinstance(kind, str):
        plain = kind.lower().replace("-", "").replace("_", "").replace(" ", "")
        plain = _ALIASES.get(plain, plain)
        kind = plain if plain in _KINDS else kind
    codes: dict[str | int, str] = {code: name for n, name in enumerate(names) for code in (name, n)}
    return _checks.code(kind, "type", codes, expected)


def _velocity(kind: str, axis: int, given: tuple[Any, ...], named: dict[str, Any]) -> tuple[float, ...]:
    if "velocity" in named and not given:
        given = (named.pop("velocity"),)
    if given and np.ndim(given[0]) == 1:
        velocity = _checks.vector(given[0], "velocity")
        given = given[1:]
    else:
        values = dict(zip(("vx", "vy", "vz"), given, strict=False))
        given = given[3:]
        for name in ("vx", "vy", "vz"):
            if name in named and name not in values:
                values[name] = named.pop(name)
        velocity = tuple(_checks.finite(values.get(name, 0.0), name) for name in ("vx", "vy", "vz"))
    if given or named:
        raise TypeError(
            "set_domain_bc(): expected face, type and velocity, or face, type, vx, vy, vz, "
            f"found also {', '.join(map(repr, (*given, *named)))}"
        )
    if kind == "wall" and velocity[axis] != 0:
        raise _checks.wrong_value("velocity", "none across a wall; 'inflow' lets fluid through", velocity)
    if kind not in ("wall", "inflow"):
        return (0.0, 0.0, 0.0)
    return velocity
