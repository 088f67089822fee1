"""Arguments that come in more than one form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from peclet import _checks

Box = tuple[tuple[float, ...], tuple[float, ...], "list[bool] | None"]


def three_numbers(first: Any, second: Any, third: Any, name: str) -> tuple[float, ...]:
    """Three numbers, or one sequence of three.

    >>> three_numbers([0, 0, -1], None, None, "gravity") == three_numbers(0, 0, -1, "gravity")
    True
    """
    if second is None and third is None:
        return _checks.vector(first, name)
    if second is None or third is None:
        raise TypeError(f"{name}: expected three numbers or one sequence of three, found two arguments")
    return tuple(_checks.finite(value, f"{name}[{n}]") for n, value in enumerate((first, second, third)))


def three_flags(values: Any, name: str) -> list[bool]:
    """A sequence of three times True or False."""
    if isinstance(values, (str, bytes)) or np.ndim(values) != 1 or len(values) != 3:
        raise _checks.wrong_type(name, "a sequence of 3 flags", values)
    return [_checks.flag(value, f"{name}[{n}]") for n, value in enumerate(values)]


def by_name(
    form: Sequence[str], args: Sequence[Any], kwargs: Mapping[str, Any], caller: str = "set_domain"
) -> dict[str, Any]:
    """What was given, by name, for a call that takes the arguments of form in this order.

    >>> by_name(("dt", "substeps"), (0.1,), {"substeps": 3}, "step_hertz")
    {'dt': 0.1, 'substeps': 3}
    """
    if len(args) > len(form):
        raise TypeError(
            f"{caller}: expected at most {len(form)} arguments ({', '.join(form)}), found {len(args)}"
        )
    named = dict(zip(form, args, strict=False))
    for name, value in kwargs.items():
        if name not in form:
            raise TypeError(f"{caller}: expected {', '.join(form)}, found an argument {name!r}")
        if name in named:
            raise TypeError(f"{caller}: expected one value for {name}, found two")
        named[name] = value
    return named


def _require(named: Mapping[str, Any], names: Sequence[str]) -> None:
    missing = [name for name in names if name not in named]
    if missing:
        raise TypeError(f"set_domain: expected {', '.join(names)}; {', '.join(missing)} is missing")


def _box_of_lengths(named: Mapping[str, Any]) -> Box:
    _require(named, ("lx", "ly", "lz"))
    extent = tuple(_checks.non_negative(named[name], name) for name in ("lx", "ly", "lz"))
    flags = [_checks.flag(named.get(name, name != "pz"), name) for name in ("px", "py", "pz")]
    return (0.0, 0.0, 0.0), extent, flags


def _box_of_corners(named: Mapping[str, Any]) -> Box:
    _require(named, ("min", "max"))
    low, high = _checks.vector(named["min"], "min"), _checks.vector(named["max"], "max")
    for axis in range(3):
        if high[axis] < low[axis]:
            raise ValueError(f"max[{axis}]: expected at least min[{axis}] = {low[axis]}, found {high[axis]}")
    return low, tuple(b - a for a, b in zip(low, high, strict=True)), None


def _box_of_extent(named: Mapping[str, Any]) -> Box:
    _require(named, ("extent",))
    extent = _checks.vector(named["extent"], "extent")
    for axis in range(3):
        _checks.non_negative(extent[axis], f"extent[{axis}]")
    origin = _checks.vector(named.get("origin", (0.0, 0.0, 0.0)), "origin")
    return origin, extent, three_flags(named.get("periodic", (True, True, False)), "periodic")


def box(args: Sequence[Any], kwargs: Mapping[str, Any]) -> Box:
    """Origin, extent and periodicity (None: unchanged) of the forms of Simulation.set_domain.

    >>> box(([0, 0, 0], [1, 2, 3]), {})
    ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), None)
    """
    if (args and np.ndim(args[0]) == 0) or {"lx", "ly", "lz"} & kwargs.keys():
        return _box_of_lengths(by_name(("lx", "ly", "lz", "px", "py", "pz"), args, kwargs))
    if {"min", "max"} & kwargs.keys() or (len(args) == 2 and not kwargs):
        return _box_of_corners(by_name(("min", "max"), args, kwargs))
    return _box_of_extent(by_name(("extent", "origin", "periodic"), args, kwargs))
