"""The figures of the page, from the recorded curves."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from examples.validation import cylinder
from examples.validation.results import published, read_curve
from examples.validation.tencate import Experiment

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
