"""The figures of the page, from the recorded curves."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from examples.validation import cylinder
from examples.validation.comparisons import FALL_TIMES, exact_drag, exact_fall
from examples.validation.results import published, read_curve
from examples.validation.tencate import Experiment
from examples.validation.walls import brenner

STYLE = {"axes.spines.top": False, "axes.spines.right": False, "font.size": 9, "legend.frameon": False}
BLUE, ORANGE = "#0072B2", "#D55E00"


def draw_cavity() -> Figure:
    """Velocity on the two centrelines beside the reference."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2), layout="constrained")
        for axis, reynolds in zip(axes, (100, 1000), strict=True):
            curve = read_curve(f"cavity-{reynolds}")
            for component, color in (("u", BLUE), ("v", ORANGE)):
                rows = published("lid_cavity_centrelines", Re=str(reynolds), component=component)
                place = [float(row["k_of_128"]) / 128 for row in rows]
                value = [float(row["reference_computed"]) for row in rows]
                axis.plot(curve["s"], curve[component], color=color, label=component)
                axis.plot(place, value, "o", color=color, markersize=3, fillstyle="none")
            axis.set_title(f"Re {reynolds}", fontsize=9)
            axis.set_xlabel("y on x = 1/2 for u, x on y = 1/2 for v")
        axes[0].legend()
    return figure


def draw_shedding() -> Figure:
    """Drag and lift of the cylinder in the channel."""
    curve = read_curve("shedding")
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(7.6, 2.8), layout="constrained")
        for axis, name, reference in zip(axes, ("drag", "lift"), (3.2266, 0.9866), strict=True):
            axis.plot(curve["time"], curve[name], color=BLUE)
            axis.axhline(reference, color="0.6", linewidth=0.8)
            axis.set(xlabel="time (s)", ylabel=f"coefficient of {name}")
    return figure


def draw_oscillation() -> Figure:
    """Force on the oscillating cylinder in its last period, and that in unbounded fluid."""
    curve = read_curve("cylinder")
    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(5.2, 3), layout="constrained")
        axis.plot(
            curve["time"] - np.floor(curve["time"][0]), curve["force"], color=BLUE, linewidth=1, label="found"
        )
        axis.plot(
            *cylinder.unbounded_force(),
            color=ORANGE,
            linestyle="--",
            linewidth=1,
            label="unbounded fluid, polar grid",
        )
        axis.set(xlabel="time / period", ylabel="2 F / (rho U² d)")
        axis.legend()
    return figure


def draw_towed() -> Figure:
    """Drag of towed spheres from step to step."""
    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(5.2, 2.6), layout="constrained")
        for courant, color in ((0.25, BLUE), (0.1, ORANGE)):
            curve = read_curve(f"towed-{courant}")
            axis.plot(
                curve["way"], curve["K"], ".-", color=color, linewidth=0.8, markersize=4, label=f"{courant}"
            )
        axis.axhline(exact_drag(0.064), color="0.6", linewidth=0.8)
        axis.annotate("exact", (0, exact_drag(0.064)), (2, -12), textcoords="offset points", color="0.4")
        axis.set(xlabel="way / spacing", ylabel="K", ylim=(2.79, 2.82))
        axis.legend(title="Courant number", ncols=2)
    return figure


def draw_slow_motion() -> Figure:
    """Drag of a sphere near a plane, and velocity of spheres that fall from rest."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(7.6, 2.8), layout="constrained")
        plane = read_curve("plane")
        axes[0].plot(plane["gap"], plane["K"], color=BLUE, label="found")
        exact = [brenner(gap) for gap in plane["gap"]]
        axes[0].plot(plane["gap"], exact, color=ORANGE, linestyle="--", label="exact")
        axes[0].set(xlabel="gap / radius", ylabel="K", xlim=(0.5, 2))
        for ratio, color in ((1.5, BLUE), (7.8, ORANGE)):
            fall = read_curve(f"fall-{ratio}")
            axes[1].plot(fall["time"], fall["velocity"], color=color, label=f"density ratio {ratio}")
            exact = [exact_fall(ratio, time) for time in FALL_TIMES]
            axes[1].plot([float(time) for time in FALL_TIMES], exact, "o", color=color, fillstyle="none")
        axes[1].set(xlabel="time nu / a²", ylabel="velocity / that of Stokes' law")
        for axis in axes:
            axis.legend()
    return figure


def draw_settling() -> Figure:
    """Speed of the settling sphere, the measured and the simulated peak of the paper."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(7.6, 2.8), sharey=True, layout="constrained")
        for axis, name in zip(axes, ("E1", "E4"), strict=True):
            curve, case = read_curve(f"settling-{name}-12"), Experiment.named(name)
            axis.plot(curve["time"], curve["speed"], color=BLUE)
            for value, text in ((case.measured, "measured"), (case.simulated, "simulated")):
                axis.axhline(value, color="0.6", linewidth=0.8)
                axis.annotate(text, (0, value), (2, 1), textcoords="offset points", color="0.4", fontsize=7)
            axis.set(xlabel="time (s)", title=name)
        axes[0].set_ylabel("speed / speed in unbounded fluid")
    return figure
