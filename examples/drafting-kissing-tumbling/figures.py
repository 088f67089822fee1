"""The figures of the drafting-kissing-tumbling page."""

from __future__ import annotations

from collections.abc import Sequence

import dkt
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from peclet.coupling import PlaneSlice, draw_plane

COLORS = ("#0072B2", "#D55E00")  # leader, follower
NAMES = ("leader", "follower")
LINES = {"proper": "-", "position-only": (0, (4, 1.6))}
NOTES = {"proper": "velocities resolved", "position-only": "positions only"}
STYLE = {"axes.spines.top": False, "axes.spines.right": False, "font.size": 9, "legend.frameon": False}


def draw_history(results: Sequence[dkt.Result]) -> Figure:
    """Heights, gap, settling speeds and lateral separation; one kind of line per kind of contact."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(7.6, 5.2), sharex=True, layout="constrained")
        for result in results:
            draw_run(axes, result)
        heights, speeds, gap, lateral = axes.flat
        heights.set_ylabel("height of the centre (cm)")
        speeds.set_ylabel("settling speed (cm/s)")
        gap.set(ylabel="gap / d", xlabel="time (s)")
        lateral.set(ylabel="lateral separation / d", xlabel="time (s)")
        gap.axhline(0, color="0.6", linewidth=0.8)
        lateral.axhline(dkt.SIDE_BY_SIDE, color="0.6", linewidth=0.8)
        lateral.annotate(
            "side by side", (0.01, dkt.SIDE_BY_SIDE), (3, 3), textcoords="offset points", color="0.4"
        )
        for axis, letter in zip(axes.flat, "abcd", strict=True):
            axis.set_title(f"({letter})", loc="left", fontsize=9)
            axis.margins(x=0)
        mark_contact(axes, dkt.measure(results[0]).contact)
        heights.legend(handles=legend_entries(results), loc="lower left")
    return figure


def draw_run(axes: np.ndarray, result: dkt.Result) -> None:
    """The four curves of one run."""
    heights, speeds, gap, lateral = axes.flat
    line = LINES[result.case.contact]
    for body in (dkt.LEADER, dkt.FOLLOWER):
        heights.plot(result.time, result.position[:, body, 1], color=COLORS[body], linestyle=line)
        speeds.plot(result.time, result.fall_speed[:, body], color=COLORS[body], linestyle=line)
    gap.plot(result.time, result.gap, color="black", linestyle=line)
    lateral.plot(result.time, result.lateral_separation, color="black", linestyle=line)


def mark_contact(axes: np.ndarray, contact: float) -> None:
    """A vertical line in every panel."""
    if np.isnan(contact):
        return
    for axis in axes.flat:
        axis.axvline(contact, color="0.5", linewidth=0.8, linestyle=":")
    axes[0, 1].annotate(
        f"contact\n{contact:.3f} s", (contact, 0.3), (3, 0), textcoords="offset points", color="0.4"
    )


def legend_entries(results: Sequence[dkt.Result]) -> list:
    """Colours for the spheres; where two kinds of contact are compared, lines for those."""
    entries = [plt.Line2D([], [], color=c, label=name) for c, name in zip(COLORS, NAMES, strict=True)]
    kinds = [result.case.contact for result in results]
    if len(kinds) > 1:
        entries += [plt.Line2D([], [], color="0.3", linestyle=LINES[k], label=NOTES[k]) for k in kinds]
    return entries


def pick_frames(result: dkt.Result) -> list[tuple[str, PlaneSlice]]:
    """The slices next to drafting, kissing and tumbling; the last one for what the run did not reach."""
    measures = dkt.measure(result)
    moments = {
        "drafting": (measures.drafting + measures.contact) / 2,
        "kissing": measures.contact,
        "tumbling": measures.side_by_side,
    }
    times = np.array([frame.time for frame in result.frames])
    return [
        ("end of the run", result.frames[-1])
        if np.isnan(moment)
        else (name, result.frames[int(np.argmin(np.abs(times - moment)))])
        for name, moment in moments.items()
    ]


def draw_slices(result: dkt.Result) -> Figure:
    """Vorticity in the vertical plane of the two centres."""
    frames = pick_frames(result)
    strong = [np.quantile(np.abs(frame.vorticity[frame.distance > 0]), 0.99) for _, frame in frames]
    limit = max(10.0, 10 * round(float(max(strong)) / 10))
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, len(frames), figsize=(7.6, 3.9), layout="constrained")
        for axis, (name, frame) in zip(axes, frames, strict=True):
            image = draw_plane(axis, frame, "vorticity", limit=limit)
            axis.set_title(f"{name}, {frame.time:.3f} s", fontsize=9)
            axis.spines[["top", "right"]].set_visible(True)
        axes[0].set_ylabel("height (cm)")
        axes[1].set_xlabel("horizontal distance from the middle of the pair (cm)")
        figure.colorbar(image, ax=axes, label="vorticity (1/s)", extend="both", shrink=0.8)
    return figure
