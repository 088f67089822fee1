"""Reading and writing the flow. Arrays are float64 in Fortran order of shape (nx, ny, nz), indexed [x, y, z].

u[i, j, k] lives on the low x face of its cell, v and w on the low y and z faces, p and sdf at its centre.
What a call returns is a copy; diagnostics.field_view() gives the memory itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from peclet import _checks
from peclet.flow._base import Part

Array = NDArray[np.float64]
_COMPONENTS = ("u", "v", "w")
_NAMES = ("p", "sdf", "u", "v", "w")


class Fields(Part):
    """Velocities inside solid read as exactly zero."""

    def get_u(self) -> Array:
        """Velocity along x on the low x faces."""
        return self._velocity(0)

    def get_v(self) -> Array:
        """Velocity along y on the low y faces."""
        return self._velocity(1)

    def get_w(self) -> Array:
        """Velocity along z on the low z faces."""
        return self._velocity(2)

    def get_uf(self) -> Array:
        """Velocity through the open part of the low x faces: times get_ox(), the flux per area.

        Differs from get_u() where a face is open in part although its centre is solid: get_u() is zero there.
        """
        return self._carrying_velocity(0)

    def get_vf(self) -> Array:
        """Velocity through the open part of the low y faces, see get_uf()."""
        return self._carrying_velocity(1)

    def get_wf(self) -> Array:
        """Velocity through the open part of the low z faces, see get_uf()."""
        return self._carrying_velocity(2)

    def get_p(self) -> Array:
        """Pressure at the cell centres, defined up to a constant."""
        return self._core.pressure()

    def get_ox(self) -> Array:
        """Open (fluid) part of the low x faces, from 0 to 1."""
        return self._open_fraction(0)

    def get_oy(self) -> Array:
        """Open (fluid) part of the low y faces, from 0 to 1."""
        return self._open_fraction(1)

    def get_oz(self) -> Array:
        """Open (fluid) part of the low z faces, from 0 to 1."""
        return self._open_fraction(2)

    get_ox_proj, get_oy_proj, get_oz_proj = get_ox, get_oy, get_oz

    def field_names(self) -> list[str]:
        """Names that get_field() knows."""
        return [*_NAMES, *self._core.scalar_names]

    def has_field(self, name: str) -> bool:
        """Whether get_field() knows this name."""
        if not isinstance(name, str):
            raise _checks.wrong_type("name", "a name", name)
        return name in self.field_names()

    def get_field(self, name: str) -> Array:
        """Copy of the field 'u', 'v', 'w', 'p', 'sdf' (signed distance, negative in solid), or of a scalar.

        In solid cells a scalar is that of the wall, where it is given, else an extension of the fluid's.
        """
        name = _checks.choice(name, "name", self.field_names())
        if name in self._core.scalar_names:
            return self._core.scalar(name)
        if name == "p":
            return self.get_p()
        if name == "sdf":
            return self._core.distance_and_owner()[0]
        return self._velocity(_COMPONENTS.index(name))

    def set_field(self, name: str, array: ArrayLike) -> None:
        """Overwrite 'u', 'v', 'w', 'p' or a scalar.

        Any real dtype and memory order; the shape must be (nx, ny, nz).
        """
        if name == "sdf":
            raise _checks.wrong_value(
                "name", "'u', 'v', 'w' or 'p' (the distance is given by set_solid)", name
            )
        name = _checks.choice(name, "name", ("u", "v", "w", "p", *self._core.scalar_names))
        values = _checks.field(array, "array", self._cells)
        if name in self._core.scalar_names:
            self._core.assign_scalar(name, values)
        elif name == "p":
            self._core.assign_pressure(values)
        else:
            self._assign_velocity(**{name: values})

    def set_velocity(self, c: int, array: ArrayLike) -> None:
        """Overwrite component c (0, 1 or 2) of the velocity."""
        component = _COMPONENTS[_checks.integer(c, "c", 0, 2)]
        self._assign_velocity(**{component: _checks.field(array, "array", self._cells)})

    def set_state(self, u: ArrayLike, v: ArrayLike, w: ArrayLike) -> None:
        """Overwrite the velocity. Values in solid are ignored; the next step restarts the time scheme.

        >>> solver = Solver(8, 6, 4)
        >>> solver.set_state(np.ones((8, 6, 4)), np.zeros((8, 6, 4)), np.zeros((8, 6, 4)))
        >>> solver.step()
        >>> bool(np.allclose(solver.get_u(), 1))
        True
        """
        components = zip(_COMPONENTS, (u, v, w), strict=True)
        self._assign_velocity(**{c: _checks.field(array, c, self._cells) for c, array in components})

    def checkpoint(self) -> dict[str, Array]:
        """Everything that the flow needs to go on as if it had not stopped, as named arrays.

        u, v, w, p; u_previous, v_previous, w_previous and potential, the past of the time scheme; the same
        of every scalar; clock; bodies. Parameters, sides and the scene are not part of it.
        """
        return self._core.checkpoint()

    def restore(self, state: Mapping[str, ArrayLike]) -> None:
        """Go on from what checkpoint() returned, bit by bit, in a solver set up by the same calls.

        ValueError where names, shapes or numbers do not fit; nothing has changed then.
        """
        expected = self._core.checkpoint()
        if set(state) != set(expected):
            raise ValueError(f"state: expected {sorted(expected)}, found {sorted(state)}")
        arrays = {}
        for name, own in expected.items():
            arrays[name] = _checks.field(state[name], f"state[{name!r}]", own.shape)
        self._core.restore(arrays)
        self._status.has_solid = True
        self._status.has_loads = self._status.has_budget = False

    def max_open_divergence(self) -> float:
        """Largest net flux out of an open cell over its volume, moving walls included."""
        self._require_geometry()
        return self._core.largest_open_divergence()

    def max_open_divergence_projected(self) -> float:
        """The same as max_open_divergence() on this grid."""
        return self.max_open_divergence()

    def max_velocity(self) -> float:
        """Largest velocity component."""
        self._require_geometry()
        return self._core.largest_velocity()

    def _velocity(self, c: int) -> Array:
        self._require_geometry()
        return self._core.velocity(c, with_slits=False)

    def _carrying_velocity(self, c: int) -> Array:
        self._require_geometry()
        return self._core.velocity(c, with_slits=True)

    def _assign_velocity(self, u: Any = None, v: Any = None, w: Any = None) -> None:
        self._core.assign_velocity(u, v, w)
        self._status.has_budget = False
