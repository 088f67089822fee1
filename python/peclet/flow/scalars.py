"""Passive and buoyant scalars: temperatures, concentrations.

    dc/dt + div(u c) = diffusivity lap c + source      in the fluid

A scalar is a field at the cell centres, float64 of shape (nx, ny, nz), read and written by get_field() and
set_field(). step() advances all scalars with the flow, at second order in time from the second step on.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from peclet import _checks
from peclet.flow import _flow
from peclet.flow._base import Part, SolverReport, face_number

ScalarScheme = _flow.ScalarScheme
ScalarCondition = _flow.ScalarCondition

_SCHEMES: dict[str | int, _flow.ScalarScheme] = {
    "fou": ScalarScheme.FIRST_UPWIND,
    "koren": ScalarScheme.KOREN,
    "sou": ScalarScheme.SECOND_UPWIND,
    0: ScalarScheme.FIRST_UPWIND,
    1: ScalarScheme.KOREN,
    2: ScalarScheme.SECOND_UPWIND,
}
_CONDITIONS = {"dirichlet": ScalarCondition.VALUE, "neumann": ScalarCondition.FLUX}
_SCHEME_NAMES = "'koren', 'sou', 'fou', 0 (fou), 1 (koren) or 2 (sou)"
_RESERVED = ("p", "sdf", "u", "v", "w")
_ITERATIONS = 2**31 - 1


class ScalarCalls(Part):
    """What both Solver and its diagnostics need to find a scalar."""

    def _scalar(self, name: Any) -> str:
        if not isinstance(name, str):
            raise _checks.wrong_type("name", "the name of a scalar", name)
        if name not in self._core.scalar_names:
            known = ", ".join(map(repr, self._core.scalar_names)) or "none so far"
            raise _checks.wrong_value("name", f"a scalar made by add_scalar() ({known})", name)
        return name


class ScalarInstruments(ScalarCalls):
    """Available on Solver.diagnostics and, as in older scripts, on Solver itself."""

    def scalar_report(self, name: str) -> SolverReport:
        """The last diffusion solve of a scalar."""
        return SolverReport(**self._core.scalar_report(self._scalar(name)))

    def set_scalar_max_iterations(self, name: str, max_iter: int) -> None:
        """Cap on the iterations of the diffusion solve of a scalar; its tolerance decides below that."""
        cap = _checks.integer(max_iter, "max_iter", 1, _ITERATIONS)
        self._core.set_scalar_iteration_limit(self._scalar(name), cap)

    def scalar_budget(self, name: str) -> dict[str, Any]:
        """Where a scalar is and came from.

        'amount': its integral over the fluid now. Amounts per time, into the fluid, mean over the last step:
        'bodies', shape (n,), 'sampled', the solid of set_solid(), and 'sides', shape (6,), in the order
        -x, +x, -y, +y, -z, +z, what flows through included. Sources are not among them.
        Raises RuntimeError before the first step().
        """
        given = self._core.scalar_given(self._scalar(name))
        bodies = len(given) - 7
        return {
            "amount": self._core.scalar_amount(name),
            "bodies": given[:bodies],
            "sampled": float(given[bodies]),
            "sides": given[bodies + 1 :],
        }


class Scalars(ScalarCalls):
    """Setters may be called at any time; each takes effect with the next step."""

    def add_scalar(
        self,
        name: str,
        diffusivity: float = 0.0,
        scheme: str | int = "koren",
        iters: int | None = None,
        cutcell: bool = False,
    ) -> None:
        """Add a scalar of this diffusivity (length squared per time), zero everywhere.

        scheme: value carried through a face; 'koren' or 1 (third order, limited, no new extrema), 'sou' or 2
        (second-order upwind), 'fou' or 0 (first-order upwind). iters caps the diffusion solve, whose
        tolerance decides below that. cutcell is accepted from scripts: walls always are where they are.
        No scalar passes through walls and sides until set_scalar_wall() and set_scalar_bc() say otherwise.

        >>> solver = Solver(16, 1, 1)
        >>> solver.add_scalar("temperature", diffusivity=0.1)
        >>> solver.set_field("temperature", np.full((16, 1, 1), 20.0))
        >>> solver.step()
        >>> bool(np.allclose(solver.get_field("temperature"), 20))
        True
        """
        if not isinstance(name, str):
            raise _checks.wrong_type("name", "a name", name)
        if not name or name in _RESERVED or name in self._core.scalar_names:
            taken = ", ".join(map(repr, (*_RESERVED, *self._core.scalar_names)))
            raise _checks.wrong_value("name", f"a name other than {taken}", name)
        value = _checks.non_negative(diffusivity, "diffusivity")
        chosen = _checks.code(scheme, "scheme", _SCHEMES, _SCHEME_NAMES)
        cap = None if iters is None else _checks.integer(iters, "iters", 1, _ITERATIONS)
        _checks.flag(cutcell, "cutcell")
        self._core.add_scalar(name, value, chosen)
        if cap is not None:
            self._core.set_scalar_iteration_limit(name, cap)

    def has_scalar(self, name: str) -> bool:
        """Whether add_scalar() has made this scalar."""
        if not isinstance(name, str):
            raise _checks.wrong_type("name", "a name", name)
        return name in self._core.scalar_names

    def scalar_names(self) -> list[str]:
        """Names of all scalars, in the order in which they were added."""
        return list(self._core.scalar_names)

    def set_scalar_wall(
        self,
        name: str,
        type: str,
        value: float = 0.0,
        coefficient: float = 0.0,
        instance: int | None = None,
    ) -> None:
        """Condition on the surface of a body, or of all bodies and of the solid of set_solid().

        'dirichlet': value is that of the scalar on the surface. 'neumann': value is the flux into the fluid
        per area and time; 0 is a wall that nothing passes. A later call without an instance replaces what
        was said about single ones. coefficient must be 0: exchange with a resistance is not offered.
        """
        name = self._scalar(name)
        condition = _CONDITIONS[_checks.choice(type, "type", tuple(_CONDITIONS))]
        given = _checks.finite(value, "value")
        if _checks.finite(coefficient, "coefficient") != 0:
            raise _checks.wrong_value("coefficient", "0", coefficient)
        body = None if instance is None else self._instance(instance, "instance")
        self._core.set_scalar_wall(name, condition, given, body)

    def set_scalar_bc(self, name: str, face: str | int, type: str, value: float | ArrayLike = 0.0) -> None:
        """Condition on a side of the box ('-x', '+x', ... or 0 to 5) that is not periodic.

        'dirichlet': value of the scalar there, also of what flows in; an inflow needs it. 'neumann':
        diffusive flux into the fluid per area; 0, the default of other sides, is zero gradient. An array has
        one entry per face of the side, of shape (ny, nz), (nx, nz) or (nx, ny).
        """
        name = self._scalar(name)
        number = face_number(face)
        if self._core.side(number // 2, number % 2)[0] == _flow.SideKind.PERIODIC:
            raise _checks.wrong_value(
                "face", "a side that set_domain_bc() has made other than periodic", face
            )
        condition = _CONDITIONS[_checks.choice(type, "type", tuple(_CONDITIONS))]
        shape = [n for axis, n in enumerate(self._cells) if axis != number // 2]
        uniform = np.ndim(value) == 0
        array = np.full(shape, _checks.finite(value, "value")) if uniform else value
        self._core.set_scalar_side(name, number, condition, _checks.field(array, "value", shape))

    def set_scalar_source(self, name: str, source: float | ArrayLike) -> None:
        """Amount per volume and time that appears in the fluid: a number, or one per cell, (nx, ny, nz)."""
        name = self._scalar(name)
        if np.ndim(source) == 0:
            self._core.set_scalar_source(name, _checks.finite(source, "source"))
        else:
            self._core.set_scalar_source_field(name, _checks.field(source, "source", self._cells))

    def set_scalar_mean_gradient(self, name: str, gradient: Sequence[float]) -> None:
        """Transport the periodic part of a scalar whose mean gradient is given.

        The scalar is gradient . x plus the field of get_field(). For walls of given flux only.
        """
        self._core.set_scalar_mean_gradient(self._scalar(name), _checks.vector(gradient, "gradient"))

    def set_scalar_residual_tolerance(self, name: str, rtol: float) -> None:
        """Residual at which the diffusion solve stops, over the largest deviation from the mean."""
        value = _checks.finite(rtol, "rtol")
        if not 0 < value < 1:
            raise _checks.wrong_value("rtol", "a number between 0 and 1", value)
        self._core.set_scalar_tolerance(self._scalar(name), value)

    def set_boussinesq(
        self, name: str, expansion: float, reference: float = 0.0, gravity: Sequence[float] = (0, 0, -1)
    ) -> None:
        """Let a scalar drive the flow: acceleration -expansion (c - reference) gravity.

        gravity is the vector that points down, expansion is per unit of the scalar; 0 switches it off.
        There is one such scalar at a time.
        """
        name = self._scalar(name)
        values = _checks.finite(expansion, "expansion"), _checks.finite(reference, "reference")
        self._core.set_buoyancy(name, *values, _checks.vector(gravity, "gravity"))

    def advance_scalars(self) -> None:
        """Advance the scalars alone by dt, carried by the velocity as it is; step() does it with the flow."""
        self._require_geometry()
        self._core.advance_scalars()

    def solve_scalar_steady(self, name: str) -> None:
        """Solve for the steady state of a scalar, carried by the velocity as it is; the flow stands still.

        The cap on iterations is per pass over the fluxes; scalar_report() has their sum and the residual.
        Where no wall and no side gives a value, the amount stays what it is. Raises RuntimeError while
        bodies move and where sources leave no steady state, and warns when there was no convergence.
        """
        self._require_geometry()
        self._core.solve_scalar_steady(self._scalar(name))
        report = SolverReport(**self._core.scalar_report(name))
        if not report.converged:
            warnings.warn(
                f"solve_scalar_steady(): scalar {name!r} did not converge; scalar_report() has the residual",
                RuntimeWarning,
                stacklevel=2,
            )

    def scalar_wall_flux(self, name: str) -> NDArray[np.float64]:
        """Amount per time that each body gave to the fluid in the last step, shape (n,).

        It is what the discrete balance of the fluid received, so that sums over bodies close.
        Raises RuntimeError before the first step().
        """
        given = self._core.scalar_given(self._scalar(name))
        return given[: len(given) - 7]

    def scalar_mean_flux(self, name: str) -> NDArray[np.float64]:
        """Mean over the whole box of u c - diffusivity grad c, shape (3,); solid counts as zero."""
        self._require_geometry()
        return np.array(self._core.mean_scalar_flux(self._scalar(name)))
