"""The solid in the fluid: scenes with moving instances, or a sampled distance."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from numpy.typing import ArrayLike
from peclet import _checks
from peclet.flow._base import Part


def _warn_projection(call: str) -> None:
    warnings.warn(
        f"{call}(cutcell_pressure=False): the flow is projected on the open faces all the same",
        RuntimeWarning,
        stacklevel=3,
    )


def _warn_thin(body: int, thickness: float) -> None:
    warnings.warn(
        f"set_scene(): body {body} is {thickness:.2g} cells thick; the fluid may not see bodies that are "
        "thinner than a cell",
        RuntimeWarning,
        stacklevel=3,
    )


class Geometry(Part):
    """Lengths, positions and velocities are in scene coordinates: cells, or the user's units."""

    def set_scene(
        self,
        node_ints: ArrayLike,
        node_reals: ArrayLike,
        instance_ints: ArrayLike,
        instance_reals: ArrayLike,
        periodic: bool = False,
    ) -> None:
        """Describe the bodies by the records of peclet.core.geom.SceneBuilder.encode().

        Flat or two-dimensional: 3 integers and 16 numbers per node, 2 integers and 17 or 18 numbers per
        instance. With periodic, bodies appear on both sides of the box. Follow up with
        set_solid_from_scene(), or with rebuild_geometry() to keep the flow.

        Raises ValueError for records of the wrong length, unknown opcodes, indices out of range, cycles,
        and numbers that make no sense; the scene given before stays then. RuntimeWarning for a body that is
        thinner than a cell.
        """
        periodic = _checks.flag(periodic, "periodic")
        self._core.set_scene(
            _checks.numbers(node_ints, "node_ints"),
            _checks.numbers(node_reals, "node_reals"),
            _checks.numbers(instance_ints, "instance_ints"),
            _checks.numbers(instance_reals, "instance_reals"),
            periodic,
        )
        body, thickness = self._core.thinnest_body()
        if thickness < 1:
            _warn_thin(body, thickness)
        self._status.has_scene = True
        self._status.has_solid = False
        self._forget_loads()

    def set_solid_from_scene(self, cutcell_pressure: bool = True) -> None:
        """Sample the scene and put the fluid at rest.

        cutcell_pressure=False gives a warning: the projection is never skipped.
        """
        if not _checks.flag(cutcell_pressure, "cutcell_pressure"):
            _warn_projection("set_solid_from_scene")
        if not self._status.has_scene:
            raise RuntimeError("set_solid_from_scene(): call set_scene() first")
        self._core.build_geometry(False)
        self._status.has_solid = True
        self._forget_loads()

    def set_solid(
        self, sdf: ArrayLike, cutcell_pressure: bool = True, pressure_coarse: str = "const"
    ) -> None:
        """Solid given by signed distances at the cell centres, shape (nx, ny, nz), negative inside.

        It is at rest, joins the bodies of the scene, if there is one, and the fluid is put at rest.
        pressure_coarse is accepted from scripts and has no effect.
        """
        on = _checks.flag(cutcell_pressure, "cutcell_pressure")
        _checks.choice(pressure_coarse, "pressure_coarse", ("const", "linear"))
        self._core.set_sampled_solid(_checks.field(sdf, "sdf", self._cells))
        if not on:
            _warn_projection("set_solid")
        self._status.has_solid = True
        self._forget_loads()

    def set_instance_transform(
        self, instance: int, translation: Sequence[float], quat: Sequence[float] = (0.0, 0.0, 0.0, 1.0)
    ) -> None:
        """Place a body; takes effect with rebuild_geometry() or the next step().

        quat is (x, y, z, w) and need not be normalised. Positions outside a periodic box wrap.
        Raises RuntimeError when there is no such instance.
        """
        number = self._instance(instance, "instance")
        position = _checks.vector(translation, "translation")
        rotation = _checks.vector(quat, "quat", 4)
        if not any(rotation):
            raise _checks.wrong_value("quat", "a quaternion that is not zero", quat)
        self._core.set_pose(number, position, rotation)

    def set_instance_motion(
        self,
        instance: int,
        lin_vel: Sequence[float] = (0.0, 0.0, 0.0),
        ang_vel: Sequence[float] = (0.0, 0.0, 0.0),
        center: Sequence[float] | None = None,
    ) -> None:
        """Velocity of a body and its angular velocity (radians per time, world axes).

        Takes effect with rebuild_geometry(), refresh_wall_velocity() or the next step(). A center, once
        given, stays where it is; without one, the body turns about its translation.
        These are the velocities at the end of the step, see also set_prescribed_motion().
        Raises RuntimeError when there is no such instance.
        """
        number = self._instance(instance, "instance")
        linear = _checks.vector(lin_vel, "lin_vel")
        angular = _checks.vector(ang_vel, "ang_vel")
        pinned = None if center is None else _checks.vector(center, "center")
        self._core.set_motion(number, linear, angular, pinned)

    def set_prescribed_motion(self, on: bool) -> None:
        """True: bodies follow a motion that is known beforehand; False (the default): forces move them.

        Friction on a wall that accelerates follows its mean velocity in the step if the motion is
        prescribed: flow and forces are of second order in time, and the force of a step is that of its
        middle. Where the velocity follows from the force, an explicit exchange hands over the velocity of
        the beginning of the step; friction then follows the velocity that is given, which is late by half a
        step instead of a whole one. Bodies of constant velocity are the same either way.
        """
        self._core.prescribed_motion = _checks.flag(on, "on")

    @property
    def prescribed_motion(self) -> bool:
        """Whether friction follows the mean velocity of the bodies in a step."""
        return self._core.prescribed_motion

    def rebuild_geometry(self) -> None:
        """Sample the bodies where they are now; the flow is kept.

        Points that a body uncovers take the velocity of its surface there.
        """
        self._core.update_geometry()
        self._status.has_solid = True
        self._status.has_budget = False

    def refresh_wall_velocity(self) -> None:
        """Take over the velocities of the bodies, without sampling them anew."""
        self._core.refresh_wall_velocity()

    def has_scene(self) -> bool:
        """Whether set_scene() was called."""
        return self._status.has_scene

    def has_moving_instance(self) -> bool:
        """Whether any body has a velocity or an angular velocity."""
        return self._core.any_body_moves()

    def has_cutcell_pressure(self) -> bool:
        """Whether the geometry was built: the projection then acts on the open part of every face."""
        return self._status.has_solid

    def num_scene_instances(self) -> int:
        """Number of bodies in the scene."""
        return self._core.number_of_bodies

    def scene_instance_count(self) -> int:
        """Number of bodies in the scene: the older name of num_scene_instances()."""
        return self._core.number_of_bodies

    def instance_center(self, i: int) -> list[float]:
        """Centre of rotation of a body, as of the last rebuild or set_instance_motion()."""
        return list(self._core.body_center(self._instance(i, "i")))

    def _forget_loads(self) -> None:
        self._status.has_loads = False
        self._status.has_budget = False
