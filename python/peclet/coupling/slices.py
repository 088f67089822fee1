"""Pictures of a coupled run: the flow in a plane, the motion over time."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from peclet.coupling.simulation import CoupledSimulation

Array = NDArray[np.float64]
# Distinguishable with any kind of colour vision (Okabe and Ito).
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


@dataclasses.dataclass(frozen=True)
class PlaneSlice:
    """The flow in a plane of cell centres; a, b and the normal are a right-handed triple of axes.

    All arrays are indexed [a, b] and hold values at cell centres; inside a body they are those of its motion.
    """

    axes: tuple[str, str]
    a: Array
    b: Array
    distance: Array
    velocity_a: Array
    velocity_b: Array
    speed: Array
    vorticity: Array
    time: float


def take(simulation: CoupledSimulation, normal: str, position: float) -> PlaneSlice:
    """The layer of cells whose centres are next to the plane at this position along the normal."""
    flow = simulation.flow
    n = "xyz".index(normal)
    axes = ((n + 1) % 3, (n + 2) % 3)
    spacing, origin, cells = (np.array(values) for values in (flow.spacing, flow.origin, flow.cells))
    layer = int(np.clip(np.floor((position - origin[n]) / spacing[n]), 0, cells[n] - 1))
    centers = [origin[d] + spacing[d] * (np.arange(cells[d]) + 0.5) for d in range(3)]

    def plane(array: NDArray[Any]) -> NDArray[Any]:
        flat = array.take(layer, axis=n)
        return flat if axes[0] < axes[1] else flat.T

    velocities = (flow.get_u, flow.get_v, flow.get_w)
    u = [plane(velocities[d]()) for d in axes]
    distance, owner = plane(flow.get_field("sdf")), plane(flow.get_cut_owner())
    motion = _rigid_motion(simulation, owner, axes, n, centers, layer)
    for d in range(2):
        # the nearer of the two cells beside a face decides whose face it is
        behind = np.roll(distance, 1, d) < distance
        closed = distance + np.roll(distance, 1, d) < 0
        u[d] = np.where(closed, np.where(behind, np.roll(motion[d], 1, d), motion[d]), u[d])
    along_normal = plane(0.5 * (velocities[n]() + np.roll(velocities[n](), -1, n)))
    h = [spacing[d] for d in axes]
    at_corner = (u[1] - np.roll(u[1], 1, 0)) / h[0] - (u[0] - np.roll(u[0], 1, 1)) / h[1]
    ahead = 0.5 * (at_corner + np.roll(at_corner, -1, 0))
    at_center = [0.5 * (u[d] + np.roll(u[d], -1, d)) for d in range(2)]
    return PlaneSlice(
        axes=("xyz"[axes[0]], "xyz"[axes[1]]),
        a=centers[axes[0]],
        b=centers[axes[1]],
        distance=distance,
        velocity_a=at_center[0],
        velocity_b=at_center[1],
        speed=np.sqrt(at_center[0] ** 2 + at_center[1] ** 2 + np.where(distance > 0, along_normal, 0) ** 2),
        vorticity=0.5 * (ahead + np.roll(ahead, -1, 1)),
        time=simulation.time,
    )


def _rigid_motion(
    simulation: CoupledSimulation,
    owner: NDArray[np.int32],
    axes: tuple[int, int],
    normal: int,
    centers: list[Array],
    layer: int,
) -> list[Array]:
    """Velocity v + w x r of the body that owns each cell, two components; zero for what stands still."""
    result = [np.zeros(owner.shape), np.zeros(owner.shape)]
    state = simulation.body_state()
    for n, body in enumerate(simulation.bodies):
        x, v, w = (state[name][n] for name in ("position", "velocity", "angular_velocity"))
        inside = owner == body.instance
        arm = [centers[d] - x[d] for d in axes]
        above = centers[normal][layer] - x[normal]
        first = v[axes[0]] + w[axes[1]] * above - w[normal] * arm[1][None, :]
        second = v[axes[1]] + w[normal] * arm[0][:, None] - w[axes[0]] * above
        result[0] = np.where(inside, np.broadcast_to(first, owner.shape), result[0])
        result[1] = np.where(inside, np.broadcast_to(second, owner.shape), result[1])
    return result


def plot_plane(plane: PlaneSlice, show: str) -> Any:
    """Vorticity or speed in colour, solid in grey; returns the matplotlib figure."""
    import matplotlib.pyplot as plt

    extent = plane.a[-1] - plane.a[0], plane.b[-1] - plane.b[0]
    height = float(np.clip(5 * extent[1] / extent[0], 3, 9))
    figure, axes = plt.subplots(figsize=(1.6 + height * extent[0] / extent[1], height), layout="constrained")
    image = draw_plane(axes, plane, show)
    figure.colorbar(image, ax=axes, label=f"{show} (1 / time)" if show == "vorticity" else show)
    axes.set(xlabel=plane.axes[0], ylabel=plane.axes[1], title=f"time {plane.time:g}")
    return figure


def draw_plane(
    axes: Any, plane: PlaneSlice, show: str, *, scale: float = 1.0, limit: float | None = None
) -> Any:
    """Draw a slice into matplotlib axes, lengths multiplied by scale; returns the coloured image.

    limit: largest value of the colour scale; by default, the one that all but 0.5 % of the fluid stay below.
    """
    values = plane.vorticity if show == "vorticity" else plane.speed
    fluid = plane.distance > 0
    if limit is None:
        limit = float(np.quantile(np.abs(values[fluid]), 0.995)) if fluid.any() else 0.0
    limit = limit or 1.0
    low, colors = (-limit, "RdBu_r") if show == "vorticity" else (0.0, "viridis")
    half = [(c[1] - c[0]) / 2 if len(c) > 1 else 0.5 for c in (plane.a, plane.b)]
    extent = [scale * x for c, h in zip((plane.a, plane.b), half, strict=True) for x in (c[0] - h, c[-1] + h)]
    image = axes.imshow(
        values.T, origin="lower", extent=extent, vmin=low, vmax=limit, cmap=colors, interpolation="bilinear"
    )
    if plane.distance.min() < 0 < plane.distance.max():
        a, b, d = scale * plane.a, scale * plane.b, plane.distance.T
        axes.contourf(a, b, d, levels=[d.min(), 0], colors=["0.75"])
        axes.contour(a, b, d, levels=[0], colors=["0.2"], linewidths=0.8)
    return image


def plot_motion(history: Mapping[str, Array], axis: str) -> Any:
    """Position and velocity along one axis over time, one colour per body; returns the matplotlib figure."""
    import matplotlib.pyplot as plt

    component = "xyz".index(axis)
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.6), sharex=True, layout="constrained")
    for name, panel in zip(("position", "velocity"), panels, strict=True):
        for n in range(history[name].shape[1]):
            color = COLORS[n % len(COLORS)]
            panel.plot(history["time"], history[name][:, n, component], color=color, label=f"body {n}")
        panel.set(xlabel="time", ylabel=f"{name} along {axis}")
        panel.spines[["top", "right"]].set_visible(False)
    if history["position"].shape[1] <= len(COLORS):
        panels[0].legend(frameon=False)
    return figure
