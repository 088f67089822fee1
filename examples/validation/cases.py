"""The cases of the page, each in a coarse version for every test run and in the full one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from examples.validation.comparisons import (
    FALL_TIMES,
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
from examples.validation.results import with_order


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
        full=lambda curves: with_order(lambda n: steady_cylinder(n, 8, 0.02, 0.02), (10, 20)),
    ),
    Case(
        "cylinder in a channel, shedding",
        small=None,
        full=lambda curves: with_order(lambda n: shedding_cylinder(n, 6, 0.02, curves), (15, 30)),
    ),
    Case(
        "spheres at rest",
        small=lambda: with_order(lambda n: dense_and_dilute(n, 5e-3), (8, 16), 1.8),
        full=lambda curves: (
            with_order(lambda n: dense_and_dilute(n, 5e-3), (8, 16), 1.8)
            + with_order(lambda n: dense_and_dilute(n, 3e-3), (16, 32))
        ),
    ),
    Case(
        "towed spheres",
        small=lambda: towed_rows(18, 0.25, 1.2e-2, 2e-3, 5e-3),
        full=lambda curves: (
            with_order(lambda n: towed_rows(n, 0.25, 5e-3, 5e-4, 2.2e-3, curves), (12, 24))
            + with_order(lambda n: towed_rows(n, 0.1, 5e-3, 1e-3, 2.2e-3, curves), (12, 24))
        ),
    ),
    Case(
        "spinning spheres",
        small=lambda: torque_rows(19, 0.125, 0.02),
        full=lambda curves: (
            with_order(lambda n: torque_rows(n, 0.125, 0.02), (10, 19))
            + with_order(lambda n: torque_rows(n, 0.064, 0.02), (12, 24))
            + with_order(lambda n: torque_rows(n, 0.027, 0.02), (16, 32))
        ),
    ),
    Case(
        "towed spheres with inertia",
        small=lambda: towed_with_inertia(1, 20, 5e-3)[0] + towed_with_inertia(20, 100, 5e-3)[0],
        full=lambda curves: (
            towed_with_inertia(1, 40, 5e-3)[0]
            + towed_and_at_rest(20, 300, 5e-3)
            + towed_and_at_rest(100, 600, 5e-3, noise_bound=0.013)
        ),
    ),
    Case(
        "sphere in a closed cube",
        small=lambda: closed_cube(6, 0.3, 0.02),
        full=lambda curves: (
            with_order(lambda n: closed_cube(n, 0.3, 0.02), (6, 12))
            + with_order(lambda n: closed_cube(n, 0.3, 0.01), (12, 20))
        ),
    ),
    Case(
        "sphere in a square duct",
        small=lambda: closed_duct(4, 0.2, 0.03),
        full=lambda curves: with_order(lambda n: closed_duct(n, 0.2, 0.02), (6, 12)),
    ),
    Case(
        "sphere approaching a plane",
        small=lambda: towards_plane(4, 48, (1, 0.75), 0.04),
        full=lambda curves: with_order(lambda a: towards_plane(a, 16 * a, (2, 1, 0.5), 0.04, curves), (3, 6)),
    ),
    Case(
        "oscillating sphere",
        small=lambda: oscillating_sphere(4, 48, 0.05),
        full=lambda curves: with_order(lambda a: oscillating_sphere(a, 16 * a, 0.03), (3, 6)),
    ),
    Case(
        "fall from rest",
        small=lambda: falling_sphere(4, 48, 1.5, 0.05, 0.06, 0.06, ("0.5", "1")),
        full=lambda curves: (
            with_order(
                lambda a: falling_sphere(a, 20 * a, 1.5, 0.075 / a, 0.03, 0.03, FALL_TIMES, curves), (3, 6)
            )
            + with_order(
                lambda a: falling_sphere(a, 20 * a, 7.8, 0.075 / a, 0.03, 0.03, FALL_TIMES, curves), (3, 6)
            )
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
        small=lambda: moving_cylinder(16, 8, 2, 0.13, (0.06, 0.015)),
        full=lambda curves: moving_cylinder(16, 16, 4, 0.04, (0.04, 0.015)),
    ),
    Case(
        "oscillating cylinder, finer grid",
        small=None,
        full=lambda curves: with_order(
            lambda n: moving_cylinder(n, 16, 6, 0.04, (0.04, 0.01), curves), (16, 32)
        ),
    ),
    Case(
        "oscillating cylinder in its own frame",
        small=lambda: cylinder_at_rest(12, 0.08),
        full=lambda curves: with_order(lambda n: cylinder_at_rest(n, 0.04), (12, 24)),
    ),
    Case(
        "heated sphere",
        small=lambda: with_order(lambda n: sphere_rows(n, 5e-3), (8, 16), 1.5),
        full=lambda curves: with_order(lambda n: sphere_rows(n, 1e-3), (24, 48), 1.5),
    ),
    Case(
        "heated cavity",
        small=lambda: heated_cavity_rows(16, 1000, 3e-3, 0.03) + heated_cavity_rows(24, 10000, 5e-3, 0.03),
        full=lambda curves: (
            with_order(lambda n: heated_cavity_rows(n, 1000, 5e-3, 0.01), (20, 40))
            + with_order(lambda n: heated_cavity_rows(n, 10000, 5e-3, 0.01), (20, 40))
            + with_order(lambda n: heated_cavity_rows(n, 100000, 5e-3, 0.01), (32, 64))
        ),
    ),
)
