"""Runs beside what is known: each function returns rows."""

from __future__ import annotations

import numpy as np

from examples.validation import arrays, cavity, channel, cylinder, tencate, walls, wide_tank
from examples.validation.results import Row, orders, published

Rows = list[Row]
# What the figures show: name of the curve -> columns. Full versions add theirs.
Curves = dict[str, dict[str, np.ndarray]]
# Where a sphere sits in its cell: on a cell centre, on a corner, and anywhere.
SHIFTS = ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5), (0.3, 0.1, -0.2), (0.25, 0.37, 0.11))


def cavity_rows(
    reynolds: int, cells: tuple[int, ...], target: float, least_order: float, curves: Curves | None = None
) -> Rows:
    """Extrema on the centrelines on the finest grid; order from the two finest, of all together."""
    runs = [cavity.solve(reynolds, n, change=1e-5) for n in cells]
    if curves is not None:
        finest = runs[-1]
        curves[f"cavity-{reynolds}"] = {"s": finest.y, "u": finest.u, "v": finest.v}
    names = ("u_min", "v_max", "v_min")
    exact = np.array([cavity_extremum(reynolds, name) for name in names])
    errors = np.array([[run.extrema[name] for name in names] for run in runs]) - exact
    order = float(orders(np.linalg.norm(errors, axis=1))[-1])
    return [
        Row(
            f"lid-driven cavity, Re {reynolds}",
            f"{name}, {cells[-1]} cells",
            value,
            value + error,
            target,
            error=error,
            order=order,
            least_order=least_order,
        )
        for name, value, error in zip(names, exact.tolist(), errors[-1].tolist(), strict=True)
    ]


def cavity_extremum(reynolds: int, name: str) -> float:
    """The value with the smallest uncertainty."""
    for line in published("lid_cavity_extrema", Re=str(reynolds)):
        if line["quantity"].startswith(name) and line["confidence"].startswith("A"):
            return float(line["value"])
    raise KeyError(f"{reynolds}: {name}")


def steady_cylinder(resolution: int, duration: float, target: float, lift_target: float) -> Rows:
    """Schaefer and Turek 2D-1."""
    end = channel.run(0.3, resolution, duration).after(duration - 0.05)
    values = {"C_D": (end.drag[-1], target), "C_L": (end.lift[-1], lift_target)}
    values["delta p"] = (end.pressure_difference[-1], 2 * target)
    return [
        Row(f"cylinder in a channel, 2D-1, d/h {resolution}", name, channel_value("2D-1", name), found, bound)
        for name, (found, bound) in values.items()
    ]


def channel_value(case: str, quantity: str) -> float:
    """The accurate value."""
    for line in published("schaefer_turek"):
        if line["case"].startswith(case) and line["quantity"].startswith(quantity):
            return float(line["accurate_value"])
    raise KeyError(f"{case}: {quantity}")


def shedding_cylinder(resolution: int, duration: float, target: float, curves: Curves) -> Rows:
    """Schaefer and Turek 2D-2: the last part of the history, when the shedding is periodic."""
    history = channel.run(1.5, resolution, duration)
    late = history.after(duration - 2)
    end = history.after(duration - 1)
    curves["shedding"] = {"time": end.time, "drag": end.drag, "lift": end.lift}
    found = {"C_D max": late.drag.max(), "C_L max": late.lift.max(), "Strouhal": late.strouhal}
    return [
        Row(
            f"cylinder in a channel, 2D-2, d/h {resolution}",
            name,
            channel_value("2D-2", name),
            float(value),
            target,
        )
        for name, value in found.items()
    ]


def array_rows(cells: int, solid_fraction: float, exact: float, target: float, shifts=SHIFTS) -> Rows:
    """Worst K over the positions, its scatter, and the worst force on the sphere."""
    runs = [arrays.drag_at_rest(cells, solid_fraction, shift) for shift in shifts]
    found, forces = np.array(runs).T
    name = f"spheres at rest, phi {solid_fraction}, {cells} cells"
    worst = found[np.argmax(np.abs(found - exact))]
    return [
        Row(name, f"worst K of {len(shifts)} positions", exact, float(worst), target),
        Row(
            name, "scatter of K", 0.0, float(np.ptp(found) / exact), 2e-3, error=float(np.ptp(found) / exact)
        ),
        Row(name, "force over (1 - phi) f L^3", 1.0, float(forces[np.argmax(np.abs(forces - 1))]), 1e-3),
    ]


def exact_drag(solid_fraction: float) -> float:
    """K of the simple cubic array."""
    (line,) = published("sphere_arrays_stokes", solid_fraction=str(solid_fraction))
    return float(line["K_computed"])


# K of Zick and Homsy (1982) for phi = 0.343, printed with three digits.
DENSE, DENSE_DRAG = 0.343, 15.4


def dense_and_dilute(cells: int, target: float) -> Rows:
    """Two solid fractions."""
    return array_rows(cells, 0.125, exact_drag(0.125), target) + array_rows(cells, DENSE, DENSE_DRAG, target)


def towed_rows(
    cells: int,
    courant: float,
    target: float,
    noise_target: float,
    largest_target: float,
    curves: Curves | None = None,
) -> Rows:
    """Mean K of the force and its noise, in Stokes flow.

    Where the centre moves in planes of symmetry of the grid, many points are covered at once.
    """
    run, in_planes = (
        arrays.towed(cells, courant, 3, 30, start=start) for start in ((0.1, 0.3, -0.2), (0, 0, 0))
    )
    if curves is not None:
        curves[f"towed-{courant}"] = {"way": courant * np.arange(1, len(run.force) + 1), "K": run.force}
    name = f"towed spheres, phi 0.064, {cells} cells, Courant number {courant}"
    rows = [Row(name, "mean K", exact_drag(0.064), float(run.force.mean()), target)]
    for where, found in (("", run), (", in planes of the grid", in_planes)):
        rms, largest = arrays.noise(found.force)
        rows += [
            Row(name, f"rms deviation of K{where}", 0.0, rms, noise_target, error=rms),
            Row(name, f"largest deviation of K{where}", 0.0, largest, largest_target, error=largest),
        ]
    return rows


def torque_rows(cells: int, solid_fraction: float, target: float) -> Rows:
    """Torque of a spinning sphere, and the torque across, which is zero by symmetry."""
    (line,) = published("sphere_arrays_stokes", solid_fraction=str(solid_fraction))
    exact = float(line["torque_factor_T_over_8pi_mu_a3_Omega"])
    name = f"spinning spheres, phi {solid_fraction}, {cells} cells"
    symmetric, across = arrays.torque(cells, solid_fraction)
    shifted, _ = arrays.torque(cells, solid_fraction, SHIFTS[3])
    return [
        Row(name, "torque", exact, symmetric, target),
        Row(name, "torque, off the lattice", exact, shifted, target),
        Row(name, "torque across", 0.0, across, 1e-7, error=across),
    ]


def stokes_reference(case: str, parameter: float) -> float:
    """The value of the first line whose case begins like this."""
    for line in published("stokes_references"):
        if line["case"].startswith(case) and float(line["parameter"]) == parameter:
            return float(line["value_K_or_formula"])
    raise KeyError(f"{case}: {parameter}")


def closed_cube(diameter: int, ratio: float, target: float) -> Rows:
    """K in the middle of a cube."""
    width = 2 * round(diameter / ratio / 2)
    found = walls.drag_in_closed_box(width, width, ratio * width)
    name = f"sphere in a closed cube, d/W {ratio}, d/h {diameter}"
    return [Row(name, "K", stokes_reference("sphere at centre of closed no-slip cube", ratio), found, target)]


def closed_duct(diameter: int, ratio: float, target: float) -> Rows:
    """K in the middle of a duct of four widths."""
    width = 2 * round(diameter / ratio / 2)
    found = walls.drag_in_closed_box(width, 4 * width, ratio * width)
    name = f"sphere in a square duct, d/W {ratio}, d/h {diameter}"
    return [
        Row(name, "K", stokes_reference("sphere on the axis of a long square duct", ratio), found, target)
    ]


def towards_plane(
    radius: int, width: int, gaps: tuple[float, ...], target: float, curves: Curves | None = None
) -> Rows:
    """K at several gaps, in radii; the slip sides are far away only for the smaller ones."""
    passed, drags = walls.drag_towards_plane(radius, width, gaps[0], gaps[-1], reynolds=0.1, steps=16)
    if curves is not None:
        curves["plane"] = {"gap": passed, "K": drags}
    found = np.interp(gaps, passed, drags)
    name = f"sphere approaching a plane, a/h {radius}"
    return [
        Row(name, f"K at a gap of {gap:g} a", walls.brenner(gap), float(K), target)
        for gap, K in zip(gaps, found, strict=True)
    ]


def oscillating_sphere(radius: int, per_period: int, target: float) -> Rows:
    """Both parts of the force, the inertia of the periodic cell taken into account."""
    in_phase, quadrature = walls.oscillation(radius, 12 * radius, per_period=per_period)
    (line,) = published("stokes_references", parameter_name="a/delta, delta=sqrt(2nu/w)", parameter="2")
    exact = dict(part.split("=") for part in line["value_K_or_formula"].split())
    fraction = 4 / 3 * np.pi / 12**3
    # added mass of the array over that of one sphere, on the potential part (2/9) (a / delta)^2
    inertia = 2 / 9 * 2**2 * ((1 + 2 * fraction) / (1 - fraction) - 1)
    name = f"oscillating sphere, a/h {radius}, {per_period} steps per period"
    return [
        Row(name, "in phase", float(exact["Re"]), in_phase, target),
        Row(name, "quadrature", float(exact["Im"]) + inertia, quadrature, target),
    ]


def falling_sphere(
    radius: int,
    width: int,
    density_ratio: float,
    dt: float,
    target: float,
    bound: float,
    times: tuple[str, ...],
    curves: Curves | None = None,
) -> Rows:
    """Velocity with added mass and history force."""
    fall = walls.free_fall(radius, width, density_ratio, float(times[-1]), dt=dt)
    if curves is not None:
        curves[f"fall-{density_ratio}"] = {"time": fall.time, "velocity": fall.velocity}
    name = f"fall from rest, density ratio {density_ratio}, d/h {2 * radius}"
    rows = []
    for time in times:
        found = float(np.interp(float(time), fall.time, fall.velocity))
        exact = exact_fall(density_ratio, time)
        rows.append(Row(name, f"v at t nu/a^2 = {time}", exact, found, target, bound=bound))
    return rows


# Of a fall from rest, over a^2 / nu, where the exact velocity is known.
FALL_TIMES = ("0.1", "0.5", "1", "2")


def exact_fall(density_ratio: float, time: str) -> float:
    """Velocity over that of Stokes' law, with added mass and history force."""
    (line,) = (
        line
        for line in published("stokes_references", parameter=time)
        if line["case"].endswith(f"rho_p/rho_f={density_ratio}: v/v_Stokes")
    )
    return float(line["value_K_or_formula"])


def settling_in_box(
    name: str, resolution: int, target: float, bound: float, curves: Curves | None = None
) -> Rows:
    """Largest speed against the band between the experiment and the simulation of the paper."""
    run = tencate.run(name, resolution)
    if curves is not None:
        curves[f"settling-{name}-{resolution}"] = {"time": run.time, "gap": run.gap, "speed": run.speed}
    low, high = sorted((run.experiment.measured, run.experiment.simulated))
    found = float(run.speed.max())
    nearest = min(max(found, low), high)
    case = f"ten Cate {name}, d/h {resolution}"
    return [Row(case, f"u_max / u_inf, band {low} to {high}", nearest, found, target, bound=bound)]


def settling_in_wide_tank(
    reynolds: float, resolution: int, width: float, height: float, target: float
) -> Rows:
    """Final speed of a sphere that settles in a wide tank, beside two correlations of the drag."""
    speed = wide_tank.terminal_speed(*wide_tank.settle(reynolds, resolution, width=width, height=height))
    name = f"settling in a tank {width:g} d wide, Re {reynolds:g}, d/h {resolution}"
    other = wide_tank.speed_of_balance(wide_tank.clift_grace_weber, reynolds)
    return [
        Row(name, "u / u of Schiller and Naumann", 1.0, speed, target),
        Row(name, "the same, drag of Clift, Grace and Weber", other, speed, target),
    ]


# Force above the 20th harmonic that the eye does not see, over the peak.
SMOOTH = 0.01


def oscillating_cylinder(
    run: cylinder.Oscillation,
    name: str,
    target: float,
    bounds: tuple[float, float],
    curves: Curves | None = None,
) -> Rows:
    """Coefficients of Morison's formula, and the force itself beside that in unbounded fluid.

    bounds: of the deviation of the force and of its roughness.
    """
    if curves is not None:
        last = run.last_period
        curves["cylinder"] = {"time": last.time / cylinder.PERIOD, "force": last.force}
    drag, added = run.morison()
    deviation, rough = run.deviation(*cylinder.unbounded_force()), run.roughness()
    return [
        Row(name, "c_d", 2.09, drag, target),
        Row(name, "c_m", 1.45, added, target),
        Row(name, "rms deviation of the force / peak", 0.0, deviation, target, deviation, bounds[0]),
        Row(name, "rms above the 20th harmonic / peak", 0.0, rough, SMOOTH, rough, bounds[1]),
    ]


def moving_cylinder(
    resolution: int,
    size: float,
    periods: int,
    target: float,
    bounds: tuple[float, float],
    curves: Curves | None = None,
) -> Rows:
    """The cylinder moves through the grid."""
    run = cylinder.run(resolution, length=size, width=size, periods=periods)
    return oscillating_cylinder(
        run, f"in-line oscillating cylinder, d/h {resolution}", target, bounds, curves
    )


def cylinder_at_rest(resolution: int, target: float) -> Rows:
    """The same flow in the frame of the cylinder."""
    run = cylinder.run_at_rest(resolution)
    name = f"in-line oscillating cylinder, in its own frame, d/h {resolution}"
    return oscillating_cylinder(run, name, target, (target, SMOOTH))


#: Where towed spheres start, in cells from the middle of the box: noise depends on how many points of the
#: grid the surface covers at once.
STARTS = ((0.1, 0.3, -0.2), (0, 0, 0), (0, 0.5, 0.5), (0.2, 0.25, 0.1), (0, 0.4, 0.4), (0, 0, 0.25))


def towed_with_inertia(
    reynolds: float, settle: int, target: float, bound: float | None = None
) -> tuple[Rows, float]:
    """Noise of the force at d/h = 12, and its mean K; reynolds: of the speed of the grid."""
    runs = [arrays.towed(24, 0.25, 4, settle, start=start, reynolds=reynolds) for start in STARTS]
    rms = [arrays.noise(run.force)[0] for run in runs]
    total = float(np.sqrt(np.mean(np.square(rms))))
    name = f"towed spheres, phi 0.064, 24 cells, Re {reynolds:g}"
    relative = f"(relative Re {runs[0].reynolds:.0f})"
    rows = [
        Row(name, f"rms deviation of the force {relative}", 0.0, rms[0], target, rms[0]),
        Row(name, f"the same at {len(runs)} places {relative}", 0.0, total, target, total, bound),
    ]
    return rows, float(np.mean([run.force.mean() for run in runs]))


def towed_and_at_rest(reynolds: float, settle: int, target: float, noise_bound: float | None = None) -> Rows:
    """Towed spheres, and their drag against that of spheres at rest at the same time after the start.

    The latter is taken for h = 0, of second order from d/h = 12 and 18: its own error on one grid is larger
    than the target.
    """
    rows, found = towed_with_inertia(reynolds, settle, target, noise_bound)
    coarse, fine = (
        arrays.towed(12 * n, 0.25, 2 * n, settle * n // 2, reynolds=reynolds, in_own_frame=True).force.mean()
        for n in (2, 3)
    )
    limit = float((9 * fine - 4 * coarse) / 5)
    return [
        *rows,
        Row(rows[0].case, "mean K against spheres at rest, h = 0", limit, found, target),
        Row(rows[0].case, "mean K against spheres at rest, same grid", float(coarse), found, 0.02),
    ]
