"""Instruments: how the solves went, what the discrete equations add up to, and switches of other versions."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from peclet import _checks
from peclet.flow import _flow
from peclet.flow._base import SolverReport, Status
from peclet.flow.scalars import ScalarInstruments


class Instruments(ScalarInstruments):
    """Available on Solver.diagnostics and, as in older scripts, on Solver itself."""

    @property
    def velocity_report(self) -> SolverReport:
        """The last viscous solve: the worst of its three components."""
        return SolverReport(**self._core.velocity_report())

    @property
    def pressure_report(self) -> SolverReport:
        """The last pressure solve."""
        return SolverReport(**self._core.pressure_report())

    def last_pressure_iterations(self) -> int:
        """Iterations of the last pressure solve."""
        return self.pressure_report.iterations

    def last_momentum_residual(self) -> float:
        """Residual of the last viscous solve, relative to the largest velocity."""
        return self.velocity_report.residual

    def last_outer_iterations(self) -> int:
        """Passes over the equations in the last step: one, none before the first step."""
        return min(1, self._core.number_of_steps)

    def pressure_solve_failed(self) -> bool:
        """Whether the last pressure solve met its cap before its tolerance."""
        return not self.pressure_report.converged

    def field_view(self, name: str) -> Any:
        """The memory of 'u', 'v', 'w', 'p' or a scalar, without a copy: a NumPy array of shape (nx, ny, nz).

        numpy.from_dlpack(), torch.from_dlpack() and the like take it without a copy too; on a GPU it is an
        object for their from_dlpack() alone. The memory lives as long as the view, but the next step() may
        exchange it for another: take a view anew after each. Inside solid it holds the velocity of the body,
        or that of get_uf(). It can be written to; set_field(name, view) then tells the solver, as after any
        other change from outside.

        >>> from peclet.flow import Solver
        >>> solver = Solver(8, 6, 4)
        >>> u = solver.diagnostics.field_view("u")
        >>> u[:] = 0.5; solver.set_field("u", u)
        >>> bool((solver.get_u() == 0.5).all()), bool(np.shares_memory(np.from_dlpack(u), u))
        (True, True)
        """
        names = ("u", "v", "w", "p", *self._core.scalar_names)
        name = _checks.choice(name, "name", names)
        return self._core.field_view(f"scalar_{name}" if name in self._core.scalar_names else name)

    def last_step_timers(self) -> dict[str, float]:
        """Seconds spent in the parts of the last step: geometry, momentum, viscous, pressure, loads, rest.

        They add up to the time of the step; a geometry update that was asked for before the step counts too.
        """
        return dict(self._core.times())

    def set_velocity_solver_params(self, iters: int, rtol: float = 0.0, min_iters: int = 2) -> None:
        """Cap on the iterations of the viscous solve.

        The tolerance decides below the cap: rtol if positive, else the one that is set already.
        min_iters is accepted from scripts and has no effect.
        """
        cap = _checks.integer(iters, "iters", 1, 2**31 - 1)
        tolerance = _checks.non_negative(rtol, "rtol")
        if tolerance >= 1:
            raise _checks.wrong_value("rtol", "a number below 1", tolerance)
        _checks.integer(min_iters, "min_iters", 0)
        self._core.velocity_iteration_limit = cap
        if tolerance > 0:
            self._status.velocity_tolerance_follows_pressure = False
            self._core.velocity_tolerance = tolerance

    def periodic_image_overlap_cells(self) -> int:
        """Cells that only a periodic image of a body, shifted by the length of the box, makes solid."""
        return self._core.image_overlap_cells()

    def get_cut_owner(self) -> NDArray[np.int32]:
        """Instance nearest to every cell, int32 of shape (nx, ny, nz).

        -1 where there is no body, -2 where the distance given to set_solid() is the smallest.
        """
        return self._core.distance_and_owner()[1]

    def instance_center_pinned(self, i: int) -> bool:
        """Whether the centre of rotation stays where it is, instead of following the translation."""
        return self._core.body_center_pinned(self._instance(i, "i"))

    def fluid_momentum_cells(self) -> list[int]:
        """Number of fluid faces of each velocity component: those whose centre is fluid."""
        self._require_geometry()
        return [int(count) for count in self._core.fluid_points()]

    def reaction_budget_terms(self) -> NDArray[np.float64]:
        """Terms of the force budget of the last step, shape (2, 3).

        Row 0: density / dt times the sum of the velocity change over the fluid faces, times the cell volume.
        Row 1: body force times the volume of the fluid less that of the fluid faces, each of which counts as
        a cell; advection exchanges no momentum with the walls. So the forces on all bodies (and on the solid
        of set_solid) add up to body force times volume of fluid faces + row 1 - row 0.
        """
        if not self._status.has_budget:
            raise RuntimeError("reaction_budget_terms(): call step() first")
        return np.array([self._core.momentum_change(), self._core.force_on_defects()])

    def hydro_force_torque_traction(self) -> NDArray[np.float64]:
        """The reaction force and torque, with a warning: stresses are not taken to the surface here."""
        _warn_reaction("hydro_force_torque_traction")
        return self._loads("hydro_force_torque_traction")

    def block_origin(self) -> list[int]:
        """First cell of this process."""
        return [0, 0, 0]

    def bcast_from_root(self, value: Any) -> Any:
        """The value itself: there is one process."""
        return value

    def set_fresh_cell_seed(self, on: bool) -> None:
        """Accepted from scripts: uncovered points always take the velocity of the surface."""
        _always_on("set_fresh_cell_seed", on)

    def set_incremental_pressure(self, on: bool) -> None:
        """Accepted from scripts: each step always starts from the pressure of the last one."""
        _always_on("set_incremental_pressure", on)

    def set_rotational_pressure(self, on: bool) -> None:
        """Accepted from scripts: the pressure always is corrected by the viscous part."""
        _always_on("set_rotational_pressure", on)

    def set_pressure_warmstart(self, on: bool) -> None:
        """Accepted from scripts: the pressure solve always starts from the last solution."""
        _always_on("set_pressure_warmstart", on)

    def set_pressure_exact_residual(self, on: bool = True) -> None:
        """Accepted from scripts: the residual that stops the pressure solve always is computed anew."""
        _always_on("set_pressure_exact_residual", on)

    def set_wall_flux_divergence(self, on: bool) -> None:
        """Accepted from scripts: the flux of moving walls always enters the projection."""
        _always_on("set_wall_flux_divergence", on)

    def set_exact_crossings_from_scene(self) -> None:
        """Accepted from scripts: wall distances along the axes always are those of the scene."""

    def set_outer_iterations(self, n: int) -> None:
        """Accepted from scripts: each step makes one pass over the equations."""
        if _checks.integer(n, "n", 1) > 1:
            warnings.warn(
                f"set_outer_iterations({n}): each step makes one pass over the equations",
                RuntimeWarning,
                stacklevel=2,
            )

    def _loads(self, call: str) -> NDArray[np.float64]:
        if self._core.number_of_bodies == 0:
            return np.zeros((2, 0, 3))
        self._require_loads(call)
        return self._core.loads()

    def _require_loads(self, call: str) -> None:
        if not self._status.has_loads:
            raise RuntimeError(f"{call}(): call step() first")


class SolverDiagnostics(Instruments):
    """The instruments of one solver: Solver.diagnostics."""

    def __init__(self, core: _flow.Solver, status: Status, cells: tuple[int, int, int]) -> None:
        self._core = core
        self._status = status
        self._cells = cells


def _warn_reaction(call: str) -> None:
    warnings.warn(
        f"{call}() returns the reaction of the discrete equations: call hydro_force_torque_reaction()",
        DeprecationWarning,
        stacklevel=3,
    )


def _always_on(call: str, on: Any) -> None:
    if not _checks.flag(on, "on"):
        warnings.warn(f"{call}(False): this is always on", RuntimeWarning, stacklevel=3)
