"""Pictures of a coupled run: the flow in a plane, the motion over time."""

from __future__ import annotations

import dataclasses
import itertools
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
    """The flow in a plane: values at the points center + a directions[0] + b directions[1], indexed [a, b].

    Inside a body they are those of its motion. Vorticity is the component along the normal, which is the
    cross product of the two directions.
    """

    a: Array
    b: Array
    distance: Array  # to the nearest surface, negative inside solid
    velocity_a: Array
    velocity_b: Array
    speed: Array
    vorticity: Array
    time: float


def take(simulation: CoupledSimulation, normal: int, position: float) -> PlaneSlice:
    """The plane across an axis, as wide as the box, sampled beside each cell centre of the layer."""
    flow = simulation.flow
    axes = ((normal + 1) % 3, (normal + 2) % 3)
    center = np.zeros(3)
    center[normal] = position
    directions = np.eye(3)[list(axes)]
    return sample(simulation, center, directions, flow.cell_centers()[axes[0]], flow.cell_centers()[axes[1]])


def sample(simulation: CoupledSimulation, center: Array, directions: Array, a: Array, b: Array) -> PlaneSlice:
    """Any plane, by trilinear interpolation; directions are two orthogonal unit vectors."""
    flow = simulation.flow
    points = center + a[:, None, None] * directions[0] + b[None, :, None] * directions[1]
    cells = (points - np.array(flow.origin)) / np.array(flow.spacing) - 0.5
    distance = _interpolate(flow.get_field("sdf"), cells)
    velocity = np.empty((*distance.shape, 3))
    for axis, component in enumerate(_filled_velocity(simulation)):
        velocity[..., axis] = _interpolate(component, cells + 0.5 * np.eye(3)[axis])
    u, v = (velocity @ direction for direction in directions)
    along = [
        np.gradient(w, x, axis=n) if len(x) > 1 else np.zeros_like(w) for w, x, n in ((v, a, 0), (u, b, 1))
    ]
    return PlaneSlice(
        a=a,
        b=b,
        distance=distance,
        velocity_a=u,
        velocity_b=v,
        speed=np.linalg.norm(velocity, axis=-1),
        vorticity=along[0] - along[1],
        time=simulation.time,
    )


def _interpolate(field: Array, index: Array) -> Array:
    """Trilinear in a periodic box, at fractional indices of shape (..., 3)."""
    low = np.floor(index).astype(int)
    weight = index - low
    result = np.zeros(index.shape[:-1])
    for corner in itertools.product((0, 1), repeat=3):
        place = (low + corner) % field.shape
        share = np.where(corner, weight, 1 - weight).prod(axis=-1)
        result += share * field[place[..., 0], place[..., 1], place[..., 2]]
    return result


def _filled_velocity(simulation: CoupledSimulation) -> list[Array]:
    """Velocity components with v + w x r of the moving bodies on the faces inside them."""
    flow, state = simulation.flow, simulation.body_state()
    distance, owner = flow.get_field("sdf"), flow.get_cut_owner()
    extent = np.array(flow.spacing) * flow.cells
    result = [flow.get_u(), flow.get_v(), flow.get_w()]
    for axis, component in enumerate(result):
        behind = np.roll(distance, 1, axis)
        closed = distance + behind < 0
        nearest = np.where(behind < distance, np.roll(owner, 1, axis), owner)
        for n, body in enumerate(simulation.bodies):
            x, v, w = (state[name][n] for name in ("position", "velocity", "angular_velocity"))
            inside = np.nonzero(closed & (nearest == body.instance))
            shift = 0.5 - 0.5 * np.eye(3)[axis]
            arm = np.array(flow.origin) + (np.transpose(inside) + shift) * flow.spacing - x
            arm -= extent * np.round(arm / extent)
            component[inside] = v[axis] + np.cross(w, arm)[:, axis]
    return result


def plot_plane(plane: PlaneSlice, labels: tuple[str, str], show: str) -> Any:
    """Vorticity or speed in colour, solid in grey; returns the matplotlib figure."""
    import matplotlib.pyplot as plt

    extent = plane.a[-1] - plane.a[0], plane.b[-1] - plane.b[0]
    height = float(np.clip(5 * extent[1] / extent[0], 3, 9))
    figure, axes = plt.subplots(figsize=(1.6 + height * extent[0] / extent[1], height), layout="constrained")
    image = draw_plane(axes, plane, show)
    figure.colorbar(image, ax=axes, label=f"{show} (1 / time)" if show == "vorticity" else show)
    axes.set(xlabel=labels[0], ylabel=labels[1], title=f"time {plane.time:g}")
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
