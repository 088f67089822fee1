"""Rows of the table of results: made by the cases, bounded by the tests, shown on the page."""

from __future__ import annotations

import csv
import dataclasses
import pathlib
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
PUBLISHED = FOLDER.parents[1] / "tests" / "validation" / "data"
RECORD = FOLDER / "data" / "results.csv"


@dataclasses.dataclass(frozen=True)
class Row:
    """One number that was compared.

    |error| shall not exceed target; where it does, the tests check bound. The error is relative to the
    reference unless it is given; the order shall not fall below least_order.
    """

    case: str
    quantity: str
    reference: float
    found: float
    target: float
    error: float | None = None
    bound: float | None = None
    order: float | None = None
    least_order: float | None = None

    def __post_init__(self) -> None:
        if self.error is None:
            object.__setattr__(self, "error", self.found / self.reference - 1)
        if self.bound is None:
            object.__setattr__(self, "bound", self.target)

    @property
    def meets_target(self) -> bool:
        """Within the target."""
        return abs(self.error) <= self.target

    @property
    def failures(self) -> list[str]:
        """What a test complains about."""
        name = f"{self.case}, {self.quantity}: found {self.found:.6g}, reference {self.reference:.6g}"
        found = []
        if not abs(self.error) <= self.bound:
            found.append(f"{name}: error {self.error:.3g} exceeds {self.bound:.3g}")
        if self.least_order is not None and not (self.order or 0) >= self.least_order:
            found.append(f"{name}: order {self.order} is below {self.least_order}")
        return found


def published(table: str, **selection: str) -> list[dict[str, str]]:
    """The rows of tests/validation/data/<table>.csv whose columns have these values."""
    with (PUBLISHED / f"{table}.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [row for row in rows if all(row[name] == value for name, value in selection.items())]


def orders(errors: Sequence[float], factor: float = 2) -> np.ndarray:
    """Observed orders between successive refinements by factor."""
    errors = np.abs(np.asarray(errors, dtype=float))
    return np.log(errors[:-1] / errors[1:]) / np.log(factor)


def with_order(
    compare: Callable[[int], Sequence[Row]], resolutions: tuple[int, int], least_order: float | None = None
) -> list[Row]:
    """The rows of the finer resolution, with the order of all of them together, in units of their targets."""
    coarse, fine = (compare(resolution) for resolution in resolutions)
    sizes = [float(np.linalg.norm([row.error / row.target for row in rows])) for rows in (coarse, fine)]
    order = float(orders(sizes, resolutions[1] / resolutions[0])[0])
    return [dataclasses.replace(row, order=order, least_order=least_order) for row in fine]


def write(rows: Iterable[Row], path: pathlib.Path = RECORD) -> None:
    """Replace the recorded rows of the same cases; those of other cases stay."""
    rows = list(rows)
    fresh = {row.case for row in rows}
    kept = [row for row in read(path) if row.case not in fresh] if path.exists() else []
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [field.name for field in dataclasses.fields(Row)]
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(names)
        for row in kept + rows:
            table.writerow([_text(getattr(row, name)) for name in names])


def read(path: pathlib.Path = RECORD) -> list[Row]:
    """The recorded rows."""
    with path.open(newline="", encoding="utf-8") as file:
        return [
            Row(
                line.pop("case"),
                line.pop("quantity"),
                **{name: float(text) if text else None for name, text in line.items()},
            )
            for line in csv.DictReader(file)
        ]


def write_curve(name: str, columns: Mapping[str, np.ndarray]) -> None:
    """Columns of equal length, for the figures."""
    np.savetxt(
        FOLDER / "data" / f"{name}.csv",
        np.column_stack(list(columns.values())),
        delimiter=",",
        header=",".join(columns),
        comments="",
        fmt="%.6g",
    )


def read_curve(name: str) -> dict[str, np.ndarray]:
    """The columns by name."""
    path = FOLDER / "data" / f"{name}.csv"
    names = path.read_text(encoding="utf-8").split("\n", 1)[0].split(",")
    return dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2).T, strict=True))


def table(rows: Iterable[Row]) -> str:
    """A Markdown table."""
    lines = [
        "| case | quantity | reference | found | error | target | met | order |",
        "|---|---|--:|--:|--:|--:|---|--:|",
    ]
    for row in rows:
        order = "" if row.order is None else f"{row.order:.2f}"
        met = "yes" if row.meets_target else "**no**"
        lines.append(
            f"| {row.case} | {row.quantity} | {row.reference:.5g} | {row.found:.5g} | {row.error:.2g} "
            f"| {row.target:.2g} | {met} | {order} |"
        )
    return "\n".join(lines)


def _text(value: str | float | None) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else f"{value:.6g}"
