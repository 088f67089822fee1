"""The cases of the page, each in a coarse version for every test run and in the full one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from examples.validation.comparisons import (
    Curves,
    Rows,
    cavity_rows,
    closed_cube,
    closed_duct,
    cylinder_at_rest,
    dense_and_dilute,
    falling_sphere,
    moving_cylinder,
    oscillating_sphere,
    settling_in_box,
    settling_in_wide_tank,
    shedding_cylinder,
    steady_cylinder,
    torque_rows,
    towards_plane,
    towed_and_at_rest,
    towed_rows,
    towed_with_inertia,
)
from examples.validation.heat import cavity_rows as heated_cavity_rows
from examples.validation.heat import sphere_rows


@dataclasses.dataclass(frozen=True)
class Case:
    """A set-up in two sizes."""

    name: str
    small: Callable[[], Rows] | None
    full: Callable[[Curves], Rows]


CASES = (
    Case(
        "lid-driven cavity, Re 100",
        small=lambda: cavity_rows(100, (16, 32), 0.02, 1.7),
        full=lambda curves: cavity_rows(100, (16, 32, 64), 0.005, 1.8, curves),
    ),
    Case(
        "lid-driven cavity, Re 1000",
        small=lambda: cavity_rows(1000, (16, 32), 0.1, 0.5),
        full=lambda curves: cavity_rows(1000, (32, 64, 128), 0.022, 1.8, curves),
    ),
    Case(
        "cylinder in a channel, steady",
        small=lambda: steady_cylinder(10, 4, 0.02, 0.3),
        full=lambda curves: steady_cylinder(20, 8, 0.02, 0.02),
    ),
    Case(
        "cylinder in a channel, shedding",
        small=None,
        full=lambda curves: shedding_cylinder(30, 6, 0.02, curves),
    ),
    Case(
        "spheres at rest",
        small=lambda: dense_and_dilute(16, 5e-3),
        full=lambda curves: dense_and_dilute(16, 5e-3) + dense_and_dilute(32, 3e-3),
    ),
    Case(
        "towed spheres",
        small=lambda: towed_rows(16, 0.25, 1.2e-2, 2e-3, 5e-3),
        full=lambda curves: (
            towed_rows(24, 0.25, 5e-3, 5e-4, 2.2e-3) + towed_rows(24, 0.1, 5e-3, 1e-3, 2.2e-3)
        ),
    ),
    Case(
        "spinning spheres",
        small=lambda: torque_rows(19, 0.125, 0.02),
        full=lambda curves: (
            torque_rows(19, 0.125, 0.02) + torque_rows(24, 0.064, 0.02) + torque_rows(32, 0.027, 0.02)
        ),
    ),
    Case(
        "towed spheres with inertia",
        small=lambda: towed_with_inertia(1, 20, 5e-3)[0] + towed_with_inertia(20, 100, 5e-3)[0],
        full=lambda curves: (
            towed_with_inertia(1, 40, 5e-3)[0]
            + towed_and_at_rest(20, 300, 5e-3)
            + towed_and_at_rest(100, 600, 5e-3)
        ),
    ),
    Case(
        "sphere in a closed cube",
        small=lambda: closed_cube(6, 0.3, 0.02),
        full=lambda curves: closed_cube(12, 0.3, 0.02) + closed_cube(20, 0.3, 0.01),
    ),
    Case(
        "sphere in a square duct",
        small=lambda: closed_duct(4, 0.2, 0.03),
        full=lambda curves: closed_duct(12, 0.2, 0.02),
    ),
    Case(
        "sphere approaching a plane",
        small=lambda: towards_plane(4, 48, (1, 0.75), 0.04),
        full=lambda curves: towards_plane(6, 96, (2, 1, 0.5), 0.04),
    ),
    Case(
        "oscillating sphere",
        small=lambda: oscillating_sphere(4, 48, 0.05),
        full=lambda curves: oscillating_sphere(6, 96, 0.03),
    ),
    Case(
        "fall from rest",
        small=lambda: falling_sphere(4, 48, 1.5, 0.05, 0.06, 0.06, ("0.5", "1")),
        full=lambda curves: (
            falling_sphere(6, 120, 1.5, 0.0125, 0.03, 0.035, ("0.1", "0.5", "1", "2"))
            + falling_sphere(6, 120, 7.8, 0.0125, 0.03, 0.03, ("0.1", "0.5", "1", "2"))
        ),
    ),
    Case(
        "ten Cate E1",
        small=lambda: settling_in_box("E1", 6, 0.02, 0.02),
        full=lambda curves: settling_in_box("E1", 12, 0.02, 0.02, curves),
    ),
    Case(
        "ten Cate E4",
        small=None,
        full=lambda curves: settling_in_box("E4", 12, 0.02, 0.02, curves),
    ),
    Case(
        "ten Cate E1, finer grid",
        small=None,
        full=lambda curves: settling_in_box("E1", 16, 0.02, 0.02),
    ),
    Case(
        "ten Cate E4, finer grid",
        small=None,
        full=lambda curves: settling_in_box("E4", 16, 0.02, 0.02),
    ),
    Case(
        "settling in a wide tank, Re 20",
        small=None,
        full=lambda curves: settling_in_wide_tank(20, 10, 24, 32, 0.03),
    ),
    Case(
        "settling in a wide tank, Re 80",
        small=None,
        full=lambda curves: settling_in_wide_tank(80, 8, 8, 30, 0.03),
    ),
    Case(
        "oscillating cylinder",
        small=lambda: moving_cylinder(12, 10, 2, 0.13, 0.06),
        full=lambda curves: moving_cylinder(16, 16, 4, 0.04, 0.04),
    ),
    Case(
        "oscillating cylinder, finer grid",
        small=None,
        full=lambda curves: moving_cylinder(32, 16, 6, 0.04, 0.05, curves),
    ),
    Case(
        "oscillating cylinder in its own frame",
        small=lambda: cylinder_at_rest(12, 0.08),
        full=lambda curves: cylinder_at_rest(24, 0.04),
    ),
    Case(
        "heated sphere",
        small=lambda: sphere_rows(16, 5e-3),
        full=lambda curves: sphere_rows(48, 1e-3),
    ),
    Case(
        "heated cavity",
        small=lambda: heated_cavity_rows(16, 1000, 3e-3, 0.03) + heated_cavity_rows(24, 10000, 5e-3, 0.03),
        full=lambda curves: (
            heated_cavity_rows(40, 1000, 5e-3, 0.01)
            + heated_cavity_rows(40, 10000, 5e-3, 0.01)
            + heated_cavity_rows(64, 100000, 5e-3, 0.01)
        ),
    ),
)
