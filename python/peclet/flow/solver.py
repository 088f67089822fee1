"""The documented solver: a face of the compiled one that accepts both generations of its calls."""

from __future__ import annotations

import inspect
import math
import os
import warnings
from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray
from peclet import _checks
from peclet.flow import _flow
from peclet.flow._base import Status
from peclet.flow.boundaries import Boundaries
from peclet.flow.diagnostics import Instruments, SolverDiagnostics, _warn_reaction
from peclet.flow.fields import Fields
from peclet.flow.geometry import Geometry
from peclet.flow.parameters import Parameters
from peclet.flow.scalars import Scalars

_LARGEST = 2**20  # cells along one axis
_BYTES_PER_CELL = 200  # at least
# Courant number up to which the scheme, extrapolated in time, damps the shortest waves.
_COURANT_LIMIT = {"sou": 0.25, "koren": 0.5, "central": 0.5}
_COURANT_LIMIT_OF_SCALARS = 0.5
# Targets of step_adaptive: where advection is explicit, and where it is implicit.
_COURANT_TARGET, _IMPLICIT_COURANT_TARGET = 0.4, 4.0
_LARGEST_MOVE = 0.5  # of a body in a step of step_adaptive(), in cells


class Solver(Parameters, Boundaries, Geometry, Fields, Scalars, Instruments):
    """Incompressible flow in a box, periodic unless set_domain_bc() says otherwise, around fixed and moving
    bodies.

    ``Solver(nx, ny, nz)`` works in cell units: cells of size 1, the centre of cell (i, j, k) at (i, j, k).

    ``Solver((nx, ny, nz), extent=(Lx, Ly, Lz), origin=(0, 0, 0))`` works in the user's own consistent units:
    cells of size extent / cells, the low corner of the box at origin.

    Without a scene the box is full of fluid. Time marches with step().

    >>> solver = Solver(16, 16, 16)
    >>> solver.set_rho(1); solver.set_mu(0.1); solver.set_dt(1)
    >>> solver.set_body_force(1e-3, 0, 0)
    >>> solver.step()
    >>> float(solver.get_u().mean().round(6))  # nothing holds the fluid: dt force / density
    0.001
    """

    @overload
    def __init__(self, nx: int, ny: int, nz: int) -> None: ...
    @overload
    def __init__(
        self,
        cells: Sequence[int],
        extent: Sequence[float] | None = None,
        origin: Sequence[float] | None = None,
        global_cells: Sequence[int] | None = None,
    ) -> None: ...
    def __init__(self, *args: Any, **kwargs: Any) -> None:
        in_cell_units = "nx" in kwargs or (args and np.ndim(args[0]) == 0)
        form = _cell_units if in_cell_units else _physical_units
        try:
            given = inspect.signature(form).bind(*args, **kwargs)
        except TypeError as error:
            raise TypeError(f"Solver(): {error}; expected nx, ny, nz or cells, extent, origin") from None
        cells, extent, origin = form(*given.args, **given.kwargs)
        _require_memory(cells)
        self._physical_units = extent is not None
        self._cells = (cells[0], cells[1], cells[2])
        self._extent = [float(n) for n in cells] if extent is None else list(extent)
        self._spacing = [length / n for length, n in zip(self._extent, cells, strict=True)]
        self._origin = list(origin)
        self._core = _flow.Solver(cells, self._spacing, self._origin)
        self._status = Status()

    # grid

    @property
    def cells(self) -> list[int]:
        """Number of cells along each axis."""
        return list(self._cells)

    @property
    def global_cells(self) -> list[int]:
        """Number of cells of the whole box along each axis: the same as cells."""
        return list(self._cells)

    @property
    def spacing(self) -> list[float]:
        """Size of a cell along each axis."""
        return list(self._spacing)

    @property
    def extent(self) -> list[float]:
        """Size of the box along each axis."""
        return list(self._extent)

    @property
    def origin(self) -> list[float]:
        """Low corner of the box in scene coordinates: -0.5 along each axis in cell units."""
        return list(self._origin)

    @property
    def physical_units(self) -> bool:
        """Whether an extent was given; False means cell units."""
        return self._physical_units

    def get_resolution(self) -> list[int]:
        """Older name of cells."""
        return self.cells

    def get_spacing(self) -> list[float]:
        """Older name of spacing."""
        return self.spacing

    def global_resolution(self) -> list[int]:
        """Older name of global_cells."""
        return self.global_cells

    def cell_centers(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Scene coordinates of the cell centres along x, y and z, of length nx, ny and nz.

        >>> x, y, z = Solver((4, 2, 1), extent=(1, 1, 1)).cell_centers()
        >>> x.tolist()
        [0.125, 0.375, 0.625, 0.875]
        """
        axes = zip(self._origin, self._cells, self._spacing, strict=True)
        x, y, z = (low + (np.arange(n, dtype=np.float64) + 0.5) * h for low, n, h in axes)
        return x, y, z

    def ghost_width(self) -> int:
        """Layers of cells that the solver keeps around the box; no array shows them."""
        return 2

    def rank(self) -> int:
        """Number of this process: 0."""
        return 0

    def size(self) -> int:
        """Number of processes: 1."""
        return 1

    # time

    def step(self) -> None:
        """Advance by one time step.

        Bodies that were moved are sampled anew first. Without any geometry, the box is full of fluid.
        A RuntimeWarning says when a solve met its cap before its tolerance; see velocity_report and
        pressure_report. Raises RuntimeError when the flow is not finite.
        """
        self._core.step()
        self._status.has_solid = True
        self._status.has_loads = True
        self._status.has_budget = True
        core = self._core
        limit = self._courant_limit()
        if core.courant_number_bound > limit and core.courant_number > limit:
            _warn_courant(limit)
        if not self.velocity_report.converged:
            _warn_cap("velocity", core.velocity_iteration_limit, core.velocity_tolerance)
        if not self.pressure_report.converged:
            _warn_cap("pressure", core.pressure_iteration_limit, core.pressure_tolerance)
        for name in core.scalar_names:
            report = self.scalar_report(name)
            if not report.converged:
                _warn_cap(
                    f"scalar {name!r}", report.iterations, core.scalar_tolerance(name), "scalar_report()"
                )

    def step_adaptive(
        self, cfl_target: float | None = None, capillary_cfl: float = 0.4, dt_max: float = math.inf
    ) -> float:
        """Advance by a time step chosen from the velocity, and return it.

        dt becomes cfl_target (at most 0.8 of the limit, see courant_number) over the largest of
        sum |u_a| / h_a, at most dt_max and at most twice the last one; bodies move by half a cell at most.
        While nothing moves, the present dt is kept if dt_max is infinite. cfl_target is 0.4 unless given, 4
        with implicit advection without scalars. capillary_cfl is accepted from scripts: there is no surface
        tension here.
        """
        if cfl_target is None:
            unlimited = self.implicit_advection and self._courant_limit() == math.inf
            cfl_target = _IMPLICIT_COURANT_TARGET if unlimited else _COURANT_TARGET
        target = _checks.positive(cfl_target, "cfl_target")
        _checks.positive(capillary_cfl, "capillary_cfl")
        if dt_max != math.inf:
            _checks.positive(dt_max, "dt_max")
        target = min(target, 0.8 * self._courant_limit())
        rate = max(
            self._core.courant_number / self.dt / target,
            self._core.body_courant_rate / min(target, _LARGEST_MOVE),
        )
        wanted = 1 / rate if rate > 0 else (self.dt if dt_max == math.inf else dt_max)
        if self.number_of_steps > 0:
            wanted = min(wanted, 2 * self.dt)
        self.set_dt(min(wanted, dt_max))
        self.step()
        return self.dt

    @property
    def courant_number(self) -> float:
        """Largest of dt sum |u_a| / h_a over the cells, with the present velocity and dt.

        What squeezes through faces whose centre is solid carries no momentum: it counts where there are
        scalars only.

        step() warns where this exceeds the limit: 0.25 for 'sou' and 0.5 for 'koren' and 'central' where
        advection is explicit; none where it is implicit, but 0.5 for scalars, which always are explicit.
        """
        self._require_geometry()
        return self._core.courant_number

    def _courant_limit(self) -> float:
        if self.advection_scheme is None:
            return math.inf
        if self.implicit_advection:
            return _COURANT_LIMIT_OF_SCALARS if self._core.scalar_names else math.inf
        return _COURANT_LIMIT[self.advection_scheme]

    @property
    def time(self) -> float:
        """Time that the steps so far have covered."""
        return self._core.time

    @property
    def number_of_steps(self) -> int:
        """Steps so far."""
        return self._core.number_of_steps

    # loads

    def hydro_force_torque_reaction(self) -> NDArray[np.float64]:
        """Force and torque of the fluid on every body in the last step, shape (2, n, 3).

        [0] are the forces, [1] the torques about the centres of rotation (world axes): what the discrete
        equations of the fluid lost to each body. Hydrostatic buoyancy is not in it unless the body force
        is. A body force counts with the volume of the fluid, of which its points are 0.1 to 1 % more or
        less (diagnostics.reaction_budget_terms() has the difference). Shape (2, 0, 3) without a scene;
        RuntimeError before the first step().
        """
        return self._loads("hydro_force_torque_reaction")

    def hydro_force_torque(self) -> NDArray[np.float64]:
        """Older name of hydro_force_torque_reaction()."""
        _warn_reaction("hydro_force_torque")
        return self._loads("hydro_force_torque")

    def force_shares(self) -> dict[str, NDArray[np.float64]]:
        """Shares of the force on every body, shape (n, 3) each: 'pressure' and 'viscous'.

        Their sum is the force of hydro_force_torque_reaction(). The pressure acts on the staircase of closed
        faces, the viscous share makes up for the rest: a sphere in Stokes flow has 0.26 of its drag from the
        pressure here, and 1/3 where stresses are taken at its surface.
        """
        self._require_loads("force_shares")
        return {"pressure": self._core.pressure_force(), "viscous": self._core.viscous_force()}

    # the rest

    @property
    def diagnostics(self) -> SolverDiagnostics:
        """Instruments: reports, counters and budgets."""
        return SolverDiagnostics(self._core, self._status, self._cells)

    @property
    def bytes(self) -> int:
        """Memory of the solver's arrays."""
        return self._core.bytes

    def __repr__(self) -> str:
        sizes = " x ".join(map(str, self._cells))
        spacing = " x ".join(f"{h:.6g}" for h in self._spacing) if self._physical_units else "1"
        count = self.num_scene_instances()
        bodies = f"{count} bod{'y' if count == 1 else 'ies'}"
        implicit = "implicit " if self.advection_scheme and self.implicit_advection else ""
        return (
            f"<Solver: {sizes} cells of size {spacing}, rho {self.density:g}, mu {self.viscosity:g}, "
            f"dt {self.dt:g}, advection {implicit}{self.advection_scheme or 'off'}, {bodies}, "
            f"step {self.number_of_steps}, time {self.time:g}>"
        )


def _warn_cap(solve: str, cap: int, tolerance: float, report: str | None = None) -> None:
    # Without the residual: Python shows the same text once, not every step.
    warnings.warn(
        f"step(): the {solve} solve met its cap of {cap} iterations before its tolerance {tolerance:g}; "
        f"{report or solve + '_report'} has the residual",
        RuntimeWarning,
        stacklevel=3,
    )


def _warn_courant(limit: float) -> None:
    # Without the number: as above.
    warnings.warn(
        f"step(): advection is explicit and the Courant number exceeds the limit {limit:g} of the scheme; "
        "courant_number has it. Reduce dt, use step_adaptive(), or set_implicit_advection() if there are no "
        "scalars",
        RuntimeWarning,
        stacklevel=3,
    )


def _cell_units(nx: Any, ny: Any, nz: Any) -> tuple[list[int], None, list[float]]:
    cells = [_checks.integer(n, name, 1, _LARGEST) for n, name in ((nx, "nx"), (ny, "ny"), (nz, "nz"))]
    return cells, None, [-0.5, -0.5, -0.5]


def _physical_units(
    cells: Any, extent: Any = None, origin: Any = None, global_cells: Any = None
) -> tuple[list[int], tuple[float, ...] | None, Sequence[float]]:
    numbers = _checks.integers(cells, "cells", 3, 1, _LARGEST)
    if global_cells is not None and _checks.integers(global_cells, "global_cells", 3, 1) != numbers:
        raise _checks.wrong_value(
            "global_cells", f"the same as cells, {numbers}: there is one process", global_cells
        )
    if extent is None:
        if origin is not None:
            raise _checks.wrong_value("origin", "none without an extent", origin)
        return _cell_units(*numbers)
    lengths = _checks.vector(extent, "extent")
    for axis, length in enumerate(lengths):
        _checks.positive(length, f"extent[{axis}]")
    return numbers, lengths, (0.0, 0.0, 0.0) if origin is None else _checks.vector(origin, "origin")


def _require_memory(cells: Sequence[int]) -> None:
    """Where memory is handed out before it exists, too large a grid would end the process."""
    if _flow.execution_space not in ("OpenMP", "Serial", "Threads") or not hasattr(os, "sysconf"):
        return
    needed = cells[0] * cells[1] * cells[2] * _BYTES_PER_CELL
    present = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if needed > present:
        raise MemoryError(
            f"cells: expected a grid that fits into the {present / 2**30:.0f} GiB of this machine, "
            f"found {cells[0]} x {cells[1]} x {cells[2]}, which need {needed / 2**30:.0f} GiB or more"
        )
