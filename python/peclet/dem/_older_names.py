"""Calls that the first generation of scripts uses, each in terms of the present one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from peclet.dem.simulation import Simulation


class OlderNames:
    """Part of Simulation."""

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
