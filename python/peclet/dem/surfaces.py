"""Materials and walls: what touching surfaces are like."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike
from peclet import _checks

if TYPE_CHECKING:
    from peclet.dem.simulation import Simulation


class Surfaces:
    """Part of Simulation."""

    def set_material_params(
        self: Simulation,
        restitution_normal: float,
        restitution_tangent: float = 0.0,
        friction: float = 0.0,
        rolling_friction: float = 0.0,
    ) -> None:
        """Of all contacts that have nothing of their own: normal restitution in [0, 1], tangential
        restitution in [-1, 1] (of sticking impacts, so without effect without friction), Coulomb
        coefficient, and rolling resistance: its moment is at most rolling_friction times the normal force
        and the effective radius R, 1/R = 1/R_a + 1/R_b.
        """
        self._core.set_default_material(
            _checks.finite(restitution_normal, "restitution_normal"),
            _checks.finite(restitution_tangent, "restitution_tangent"),
            _checks.non_negative(friction, "friction"),
            _checks.non_negative(rolling_friction, "rolling_friction"),
        )

    def set_pair_material(
        self: Simulation, a: int, b: int, restitution: float, friction: float, rolling_friction: float = 0.0
    ) -> None:
        """Of contacts between material ids a and b (0 to 1023); planes have id 0."""
        self._core.set_pair_material(
            _checks.integer(a, "a", 0, 1023),
            _checks.integer(b, "b", 0, 1023),
            _checks.finite(restitution, "restitution"),
            _checks.non_negative(friction, "friction"),
            _checks.non_negative(rolling_friction, "rolling_friction"),
        )

    def set_material_ids(self: Simulation, ids: Sequence[int]) -> None:
        """(N,) integers from 0 to 1023; 0 is where particles start."""
        self._core.set_material_ids(ids)

    def add_plane(
        self: Simulation, point: ArrayLike | float, normal: ArrayLike | float, *rest: float
    ) -> None:
        """Half space behind ``point``; ``normal`` (any length) points to the free side. Also as six
        numbers. Its material is that of set_material_params.
        """
        if not rest:
            self._core.add_plane(_checks.vector(point, "point"), _checks.vector(normal, "normal"))
            return
        if len(rest) != 4:
            raise TypeError(
                f"add_plane: expected (point, normal) or six numbers, found {2 + len(rest)} arguments"
            )
        numbers = _checks.vector((point, normal, *rest), "plane", 6)
        self._core.add_plane(numbers[:3], numbers[3:])

    def add_analytic_wall(
        self: Simulation,
        node_ints: ArrayLike,
        node_reals: ArrayLike,
        root: int,
        invert: bool,
        restitution: float = 0.0,
        friction: float = 0.0,
        rolling_friction: float = 0.0,
    ) -> int:
        """The solid of node ``root`` of a scene (``SceneBuilder.encode()``) as a wall; with ``invert`` its
        complement (a sphere becomes a spherical cave). Restitution and frictions hold for all that touches
        it. Returns the index of the wall among those added here.
        """
        return self._core.add_scene_wall(
            node_ints,
            node_reals,
            _checks.integer(root, "root", 0),
            _checks.flag(bool(invert) if invert in (0, 1) else invert, "invert"),
            _checks.finite(restitution, "restitution"),
            _checks.non_negative(friction, "friction"),
            _checks.non_negative(rolling_friction, "rolling_friction"),
        )

    def set_wall_transform(
        self: Simulation,
        wall_index: int,
        translation: ArrayLike = (0.0, 0.0, 0.0),
        quat: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    ) -> None:
        """Place a wall. Walls do not move by themselves: give a moving one its place before each step, and
        its velocity.
        """
        wall = _checks.integer(wall_index, "wall_index", 0)
        self._core.set_wall_transform(
            wall, _checks.vector(translation, "translation"), _checks.vector(quat, "quat", 4)
        )

    def set_wall_velocity(
        self: Simulation,
        wall_index: int,
        lin_vel: ArrayLike = (0.0, 0.0, 0.0),
        ang_vel: ArrayLike = (0.0, 0.0, 0.0),
        center: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        """Velocity of a wall's surface: lin_vel + ang_vel x (x - center), as felt by what touches it."""
        self._core.set_wall_velocity(
            _checks.integer(wall_index, "wall_index", 0),
            _checks.vector(lin_vel, "lin_vel"),
            _checks.vector(ang_vel, "ang_vel"),
            _checks.vector(center, "center"),
        )

    def set_wall_material_id(self: Simulation, wid: int, mat: int) -> None:
        """From now on contacts with this wall follow set_pair_material."""
        self._core.set_wall_material_id(_checks.integer(wid, "wid", 0), _checks.integer(mat, "mat", 0, 1023))
