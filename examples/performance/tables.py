"""The recorded tables of the benchmarks, and the figure of the page."""

from __future__ import annotations

import dataclasses
import json
import pathlib
from collections.abc import Iterable

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

DATA = pathlib.Path(__file__).resolve().parent / "data"
WITH_REFERENCE = ("coupled_step", "static_array")
NAMES = (*WITH_REFERENCE, "geometry", "sizes", "threads", "pressure", "viscous", "dem", "startup")
STYLE = {"axes.spines.top": False, "axes.spines.right": False, "font.size": 9, "legend.frameon": False}
COLORS = ("#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "0.7")
PARTS = ("geometry", "momentum", "viscous", "pressure", "loads", "rest")


@dataclasses.dataclass(frozen=True)
class Recorded:
    """One table as a benchmark wrote it."""

    name: str
    date: str
    machine: dict[str, str | int]
    columns: list[str]
    rows: list[list[str | float | None]]

    def __post_init__(self) -> None:
        if any(len(row) != len(self.columns) for row in self.rows):
            raise ValueError(f"{self.name}: expected {len(self.columns)} entries in every row")

    def value(self, row: str, column: str = "value") -> float:
        """The number in the row that begins so."""
        place = self.columns.index(column)
        return next(entries[place] for entries in self.rows if entries[0] == row)

    def markdown(self) -> str:
        """A table for the page."""
        shown = [c for c, _ in enumerate(self.columns) if any(row[c] not in (None, "") for row in self.rows)]
        lines = [[self.columns[c] for c in shown], ["---", *["--:"] * (len(shown) - 1)]]
        lines += [[_text(row[c]) for c in shown] for row in self.rows]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def read(name: str) -> Recorded:
    """The table that was recorded under this name."""
    return Recorded(**json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))


def show(*names: str) -> None:
    """Print tables for the page."""
    for name in names:
        print(read(name).markdown(), end="\n\n")


def machines(names: Iterable[str] = NAMES) -> str:
    """Where and when the tables were recorded."""
    lines = ["| table | date | processor | cores | threads | memory, GB |", "|---|---|---|--:|--:|--:|"]
    for table in map(read, names):
        machine = table.machine
        facts = (machine[key] for key in ("processor", "cores", "threads", "memory_GB"))
        lines.append(f"| {table.name.replace('_', ' ')} | {table.date} | {' | '.join(map(str, facts))} |")
    return "\n".join(lines)


def draw_step() -> Figure:
    """Parts of the coupled step, their bandwidth, and time per cell over the size of the grid."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 3, figsize=(9, 3), layout="constrained", width_ratios=(1, 1, 1.3))
        _draw_parts(axes[0])
        _draw_bandwidth(axes[1])
        _draw_sizes(axes[2])
    return figure


def _draw_parts(axis: Axes) -> None:
    step = read("coupled_step")
    values = [step.value(part) for part in PARTS]
    axis.barh(PARTS, values, color=COLORS)
    axis.bar_label(axis.containers[0], fmt="%.0f", padding=2, fontsize=7, color="0.4")
    axis.invert_yaxis()
    axis.set(xlabel="ms per coupled step")


def _draw_bandwidth(axis: Axes) -> None:
    step = read("coupled_step")
    parts = [part for part in PARTS if step.value(part, "GB/s") is not None]
    colors = [COLORS[PARTS.index(part)] for part in parts]
    axis.barh(parts, [step.value(part, "GB/s") for part in parts], color=colors)
    axis.axvline(step.value("copy in memory", "GB/s"), color="0.6", linewidth=0.8)
    axis.annotate(
        "copy",
        (step.value("copy in memory", "GB/s"), 1),
        (-2, -8),
        ("data", "axes fraction"),
        "offset points",
        color="0.4",
        fontsize=7,
        ha="right",
    )
    axis.invert_yaxis()
    axis.set(xlabel="GB/s")


def _draw_sizes(axis: Axes) -> None:
    sizes = read("sizes")
    names = [str(row[0]) for row in sizes.rows if str(row[0])[0].isdigit()]
    bottom = [0.0] * len(names)
    for part, color in zip(PARTS, COLORS, strict=True):
        if part == "rest":
            heights = [sizes.value(name, "ns/cell") - low for name, low in zip(names, bottom, strict=True)]
        else:
            heights = [sizes.value(name, f"{part} ns/cell") for name in names]
        axis.bar([name.replace("^3", "³") for name in names], heights, bottom=bottom, color=color, label=part)
        bottom = [low + height for low, height in zip(bottom, heights, strict=True)]
    axis.set(ylabel="ns per cell and step")
    axis.tick_params(axis="x", labelsize=7)
    axis.legend(fontsize=7, ncols=2, loc="upper right")
    axis.set_ylim(top=1.35 * max(bottom))


def _text(value: str | float | None) -> str:
    if value is None:
        return ""
    return (
        value.replace("|", "\\|").replace("<=", "≤").replace(">=", "≥")
        if isinstance(value, str)
        else f"{value:.4g}"
    )
