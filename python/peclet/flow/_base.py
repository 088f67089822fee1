"""What the parts of the solver's face share: the compiled solver, a few facts, and names that are absent."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray
from peclet import _checks
from peclet.flow import _flow

_ABSENT = {
    "two-phase flow": r"vof|capillary|contact_angle|csf|surface_tension",
    "phase change": r"phase_change",
    "porous media": r"porous|drag|divergence_source|divergence_sink|mass_flux|superficial_velocity",
    "a collocated grid": r"[Cc]ollocated|[Cc]olocated|ghost_projection|face_interp",
    "variable fluid properties": r"propert|density_mode|rho_face|cell_force",
    "conjugate transfer into solids": r"scalar_solid|scalar_facets|scalar_census|scalar_geometry",
    "slip on bodies": r"slip_",
    "implicit advection without deferred correction": r"deferred_correction",
    "distributed grids": r"decomposition|exchange_field|comm_avoiding",
    "fields of users": r"add_field",
}


FACES = ("-x", "+x", "-y", "+y", "-z", "+z")
_FACE_NUMBERS: dict[str | int, int] = {name: n for n, face in enumerate(FACES) for name in (face, n)}


def face_number(face: Any) -> int:
    """Place of a side of the box in FACES, from its name or that number itself."""
    return _checks.code(face, "face", _FACE_NUMBERS, f"one of {', '.join(map(repr, FACES))}, or 0 to 5")


def absent(owner: object, name: str) -> NoReturn:
    """Raise AttributeError, saying what peclet-resolved leaves out if the name belongs to it."""
    for subject, pattern in _ABSENT.items():
        if re.search(pattern, name):
            raise AttributeError(f"{name}: {subject}: not part of peclet-resolved", name=name, obj=owner)
    raise AttributeError(f"{type(owner).__name__!r} object has no attribute {name!r}", name=name, obj=owner)


@dataclass(frozen=True)
class SolverReport:
    """How one implicit solve went; residual is relative, as the tolerance that it is compared with."""

    iterations: int
    residual: float
    converged: bool


@dataclass
class Status:
    """What the compiled solver does not keep."""

    scheme: _flow.AdvectionScheme = _flow.AdvectionScheme.SECOND_UPWIND
    velocity_tolerance_follows_pressure: bool = False
    has_scene: bool = False
    has_solid: bool = False
    # A step was made since the last change of the scene; since the last change of geometry or velocity.
    has_loads: bool = False
    has_budget: bool = False


class Part:
    """Base of the parts: works on the compiled solver."""

    _core: _flow.Solver
    _status: Status
    _cells: tuple[int, int, int]

    if not TYPE_CHECKING:  # type checkers shall report unknown names

        def __getattr__(self, name: str) -> NoReturn:
            absent(self, name)

    def _require_geometry(self) -> None:
        """Sample the bodies, if none of the calls so far has done so; without a scene, all is fluid."""
        if not self._status.has_solid:
            self._core.update_geometry()
            self._status.has_solid = True

    def _open_fraction(self, axis: int) -> NDArray[np.float64]:
        self._require_geometry()
        return self._core.open_fraction(axis)

    def _instance(self, value: Any, name: str) -> int:
        number = _checks.integer(value, name)
        count = self._core.number_of_bodies
        if not self._status.has_scene:
            raise RuntimeError(f"{name}: call set_scene() first, found {number} without a scene")
        if not 0 <= number < count:
            raise RuntimeError(f"{name}: expected an index from 0 to {count - 1}, found {number}")
        return number
