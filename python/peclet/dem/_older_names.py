"""Calls that the first generation of scripts uses, each in terms of the present one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike
from peclet import _checks

if TYPE_CHECKING:
    from peclet.dem.simulation import Simulation


_STABILIZATIONS = ("off", "onesided", "multilevel", "escalate", "ordered")


class OlderNames:
    """Part of Simulation."""

    _stabilization = "off"

    def set_stabilization(self: Simulation, mode: str | bool) -> None:
        """Accepted from scripts, without effect: contacts conserve momentum and need no stabilisation."""
        if not isinstance(mode, str):
            mode = "onesided" if _checks.flag(mode, "mode") else "off"
        self._stabilization = _checks.choice(mode, "mode", _STABILIZATIONS)

    def set_stabilization_mode(self: Simulation, mode: str) -> None:
        """set_stabilization."""
        self.set_stabilization(_checks.choice(mode, "mode", _STABILIZATIONS))

    @property
    def stabilization(self) -> str:
        """Set by set_stabilization."""
        return self._stabilization

    def set_velocity_use_gs(self: Simulation, use_gs: bool) -> None:
        """diagnostics.set_velocity_solver('gs' or 'jacobi')."""
        self.diagnostics.set_velocity_solver("gs" if _checks.flag(use_gs, "use_gs") else "jacobi")

    def get_growth_rate(self: Simulation) -> float:
        """growth_rate."""
        return self.growth_rate

    def get_growth_factor(self: Simulation) -> float:
        """growth_factor."""
        return self.growth_factor

    def initialize(
        self: Simulation,
        shape_type: str | int,
        radius: float = 0.5,
        height: float = 2.0,
        thickness: float = 0.0,
    ) -> None:
        """initialize_shape with defaults."""
        self.initialize_shape(shape_type, radius, height, thickness)

    def enable_periodicity(self: Simulation, x: bool, y: bool, z: bool) -> None:
        """set_periodic."""
        self.set_periodic(x, y, z)

    def get_domain_min(self: Simulation) -> tuple[float, float, float]:
        """Low corner of the domain."""
        return self.origin

    def get_domain_max(self: Simulation) -> tuple[float, ...]:
        """High corner of the domain."""
        return tuple(low + length for low, length in zip(self.origin, self.extent, strict=True))

    def get_num_contacts(self: Simulation) -> int:
        """num_contacts."""
        return int(self.num_contacts)

    def get_num_manifolds(self: Simulation) -> int:
        """num_manifolds."""
        return int(self.num_manifolds)

    def get_max_overlap(self: Simulation) -> float:
        """max_overlap."""
        return float(self.max_overlap)

    def compute_overlaps(self: Simulation) -> float:
        """max_overlap."""
        return float(self.max_overlap)

    def get_profiling_info(self: Simulation) -> dict[str, float]:
        """diagnostics.profiling_info()."""
        return self.diagnostics.profiling_info()

    def debug_coloring_conflicts(self: Simulation) -> tuple[int, int]:
        """diagnostics.coloring_conflicts()."""
        return self.diagnostics.coloring_conflicts()

    def wall_sdf_at(self: Simulation, wall_index: int, points: ArrayLike) -> list[float]:
        """diagnostics.wall_sdf_at(), as a list."""
        return self.diagnostics.wall_sdf_at(wall_index, points).tolist()
