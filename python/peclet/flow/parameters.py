"""Fluid properties, schemes and tolerances."""

from __future__ import annotations

import inspect
import warnings
from typing import Any

from peclet import _checks
from peclet.flow import _flow
from peclet.flow._base import Part

AdvectionScheme = _flow.AdvectionScheme

_SCHEMES: dict[str | int, _flow.AdvectionScheme] = {
    "sou": AdvectionScheme.SECOND_UPWIND,
    "koren": AdvectionScheme.KOREN,
    "central": AdvectionScheme.CENTRAL,
    0: AdvectionScheme.SECOND_UPWIND,
    1: AdvectionScheme.KOREN,
}
_SCHEME_NAMES = {scheme: name for name, scheme in _SCHEMES.items() if isinstance(name, str)}


def _scheme(value: Any) -> _flow.AdvectionScheme:
    expected = "'sou', 'koren', 'central', 0 (sou), 1 (koren) or a member of AdvectionScheme"
    if isinstance(value, _flow.AdvectionScheme):
        if value not in _SCHEME_NAMES:
            raise _checks.wrong_value(
                "scheme", expected + " other than NONE: use set_advection(False)", value
            )
        return value
    return _checks.code(value, "scheme", _SCHEMES, expected)


class Parameters(Part):
    """Setters may be called at any time; each takes effect with the next step."""

    def set_rho(self, rho: float) -> None:
        """Density, positive."""
        self._core.density = _checks.positive(rho, "rho")

    def set_mu(self, mu: float) -> None:
        """Dynamic viscosity, positive or zero."""
        self._core.viscosity = _checks.non_negative(mu, "mu")

    def set_dt(self, dt: float) -> None:
        """Time step, positive; it may change from step to step.

        Second order in time up to a growth by a factor of 2 at once. Time steps that alternate by a factor
        above 8 are unstable around bodies.
        """
        self._core.time_step = _checks.positive(dt, "dt")

    @property
    def density(self) -> float:
        """Density of the fluid."""
        return self._core.density

    @density.setter
    def density(self, value: float) -> None:
        self.set_rho(value)

    @property
    def viscosity(self) -> float:
        """Dynamic viscosity of the fluid."""
        return self._core.viscosity

    @viscosity.setter
    def viscosity(self, value: float) -> None:
        self.set_mu(value)

    @property
    def dt(self) -> float:
        """Time step."""
        return self._core.time_step

    @dt.setter
    def dt(self, value: float) -> None:
        self.set_dt(value)

    def set_body_force(self, *force: Any, **components: float) -> None:
        """Force per unit volume: three numbers, or one sequence of three.

        >>> solver = Solver(8, 8, 8)
        >>> solver.set_body_force(1e-3, 0, 0)
        >>> solver.set_body_force([1e-3, 0, 0])
        """
        names = ("force",) if "force" in components or len(force) == 1 else ("fx", "fy", "fz")
        try:
            given = inspect.Signature([_either(name) for name in names]).bind(*force, **components).args
        except TypeError as error:
            raise TypeError(f"set_body_force(): {error}; expected fx, fy, fz or one sequence") from None
        if len(names) == 1:
            values = _checks.vector(given[0], "force")
        else:
            values = tuple(_checks.finite(f, name) for f, name in zip(given, names, strict=True))
        self._core.body_force = values

    @property
    def body_force(self) -> list[float]:
        """Force per unit volume."""
        return list(self._core.body_force)

    def set_advection(self, on: bool) -> None:
        """False (the default): Stokes flow. True: the chosen scheme transports momentum."""
        on = _checks.flag(on, "on")
        self._core.advection_scheme = self._status.scheme if on else AdvectionScheme.NONE

    def set_advection_scheme(self, scheme: str | int | _flow.AdvectionScheme) -> None:
        """'sou' or 0: second-order upwind (the default); 'koren' or 1: Koren's limiter; 'central'."""
        self._status.scheme = _scheme(scheme)
        if self._core.advection_scheme != AdvectionScheme.NONE:
            self._core.advection_scheme = self._status.scheme

    def set_implicit_advection(self, on: bool) -> None:
        """True: advection is implicit in time, for large Courant numbers; False (the default): explicit.

        With v the extrapolated velocity and e its correction, div(v e), first-order upwind, joins the matrix
        of the momentum equation; the explicit flux of v keeps the chosen scheme [KhoslaRubin1974, deferred
        correction]. So a steady flow is that of the scheme, whatever the time step. Up to a Courant number C
        of 1/2 the time scheme stays of second order; beyond, the extrapolation is weakened by 1 / (2 C),
        towards Euler's method, which blurs what changes within a step. Scalars and moving bodies still need
        time steps that resolve them. A step costs several explicit ones: worth it for steady flows, and where
        few cells limit the step.
        """
        self._core.implicit_advection = _checks.flag(on, "on")

    @property
    def implicit_advection(self) -> bool:
        """Whether advection, when on, is implicit."""
        return self._core.implicit_advection

    @property
    def advection_scheme(self) -> str | None:
        """Name of the scheme in use, None for Stokes flow."""
        return _SCHEME_NAMES.get(self._core.advection_scheme)

    def set_velocity_residual_tolerance(self, rtol: float) -> None:
        """Residual of the viscous solve over the largest velocity; -1: the tolerance of the pressure."""
        value = _checks.finite(rtol, "rtol")
        if value != -1 and not 0 < value < 1:
            raise _checks.wrong_value("rtol", "a number between 0 and 1, or -1", value)
        self._status.velocity_tolerance_follows_pressure = value == -1
        self._core.velocity_tolerance = self._core.pressure_tolerance if value == -1 else value

    def velocity_residual_tolerance(self) -> float:
        """Tolerance of the viscous solve."""
        return self._core.velocity_tolerance

    def set_pressure_solver_params(self, iters: int) -> None:
        """Cap on the iterations of the pressure solve; its tolerance decides below that."""
        self._core.pressure_iteration_limit = _cap(iters, "iters")

    def set_pressure_tolerance(self, rtol: float) -> None:
        """Residual of the pressure solve over the divergence before it, both as 2-norms."""
        self._change_pressure_tolerance(_tolerance(rtol))

    def pressure_tolerance(self) -> float:
        """Tolerance of the pressure solve."""
        return self._core.pressure_tolerance

    def set_pressure_pcg(self, on: bool, max_iter: int = 200, rtol: float = 1e-8) -> None:
        """Cap and tolerance of the pressure solve, which always is conjugate gradients with multigrid."""
        if not self._set_pressure_solver(on, max_iter, rtol):
            warnings.warn(
                "set_pressure_pcg(False): the pressure solver always is conjugate gradients with multigrid",
                RuntimeWarning,
                stacklevel=2,
            )

    def set_pressure_fcg(self, on: bool, max_iter: int = 200, rtol: float = 1e-8) -> None:
        """With on: set the cap and the tolerance of the pressure solver, see set_pressure_pcg."""
        self._set_pressure_solver(on, max_iter, rtol)

    def set_pressure_chebyshev(self, on: bool, max_iter: int = 120, rtol: float = 1e-9) -> None:
        """With on: set the cap and the tolerance of the pressure solver, see set_pressure_pcg."""
        self._set_pressure_solver(on, max_iter, rtol)

    def set_pressure_multigrid(self, on: bool, levels: int = 4) -> None:
        """Accepted from scripts: multigrid always is on, and its depth follows from the grid."""
        on = _checks.flag(on, "on")
        _checks.integer(levels, "levels", 1)
        if not on:
            warnings.warn(
                "set_pressure_multigrid(False): the pressure solver always uses multigrid",
                RuntimeWarning,
                stacklevel=2,
            )

    def set_velocity_multigrid(self, on: bool, levels: int = 4, vcycles: int = 8) -> None:
        """Accepted from scripts: the viscous solver chooses its method by itself."""
        _checks.flag(on, "on")
        _checks.integer(levels, "levels", 1)
        _checks.integer(vcycles, "vcycles", 1)

    def _set_pressure_solver(self, on: bool, max_iter: int, rtol: float) -> bool:
        on, cap, tolerance = _checks.flag(on, "on"), _cap(max_iter, "max_iter"), _tolerance(rtol)
        if on:
            self._core.pressure_iteration_limit = cap
            self._change_pressure_tolerance(tolerance)
        return on

    def _change_pressure_tolerance(self, tolerance: float) -> None:
        self._core.pressure_tolerance = tolerance
        if self._status.velocity_tolerance_follows_pressure:
            self._core.velocity_tolerance = tolerance


def _either(name: str) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD)


def _cap(value: Any, name: str) -> int:
    return _checks.integer(value, name, 1, 2**31 - 1)


def _tolerance(value: Any) -> float:
    number = _checks.finite(value, "rtol")
    if not 0 < number < 1:
        raise _checks.wrong_value("rtol", "a number between 0 and 1", number)
    return number
