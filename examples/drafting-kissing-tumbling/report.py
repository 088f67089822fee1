"""What was found beside what is known."""

from __future__ import annotations

import math
from collections.abc import Sequence

import dkt

# Published run of the reference at d/h = 12, with contacts that act on positions only.
PUBLISHED = {
    "drafting": 0.153,
    "contact": 0.333,
    "side_by_side": 0.482,
    "peak_leader": 6.05,
    "peak_follower": 8.48,
}
LABELS = {
    "drafting": ("drafting from", "s"),
    "contact": ("contact", "s"),
    "side_by_side": ("side by side", "s"),
    "peak_leader": ("peak speed of the leader", "cm/s"),
    "peak_follower": ("peak speed of the follower", "cm/s"),
}


def number(value: float, digits: int = 3) -> str:
    """Fixed point, or a dash for what did not happen."""
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def describe(result: dkt.Result) -> str:
    """Result lines for the terminal."""
    measures = dkt.measure(result)
    lines = [f"  {'':28} {'found':>8}   published"]
    for name, (label, unit) in LABELS.items():
        lines.append(f"  {label:28} {number(getattr(measures, name)):>8} {unit:5} {PUBLISHED[name]}")
    before, after = measures.speeds_before_touch, measures.speeds_after_touch
    for label, pair in (("before the touch", before), ("after the touch", after)):
        text = ", ".join(number(value) for value in pair)
        lines.append(f"  along the line of centres, {label}: leader, follower {text} cm/s")
    lines.append(f"  largest overlap {measures.largest_overlap:.2e} d")
    lines.append(f"  momentum made by contacts {measures.momentum_error:.1e} of that of a sphere")
    lines.append(f"  {result.seconds_per_step:.3f} s per step")
    return "\n".join(lines)


def claims_table(results: Sequence[dkt.Result]) -> str:
    """Claim, measured, reference: a Markdown table with one column per run."""
    kinds = [result.case.contact for result in results]
    measured = [dkt.measure(result) for result in results]
    rows = [
        ["claim", *(f"measured, {kind} contact" for kind in kinds), "reference"],
        ["---"] * (len(kinds) + 2),
    ]
    for name, (label, unit) in LABELS.items():
        found = [number(getattr(m, name)) for m in measured]
        rows.append([f"{label} ({unit})", *found, f"{PUBLISHED[name]}"])
    differences = [abs(m.speeds_after_touch[0] - m.speeds_after_touch[1]) for m in measured]
    rows.append(
        ["speeds along the line of centres differ after the touch by (cm/s)", *map(number, differences), "0"]
    )
    rows.append(["largest overlap / d", *(f"{m.largest_overlap:.1e}" for m in measured), "below 1e-3"])
    rows.append(
        ["momentum made by contacts / that of a sphere", *(f"{m.momentum_error:.0e}" for m in measured), "0"]
    )
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)
