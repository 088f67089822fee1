"""Checks of arguments where they enter; every message names the argument, the expected and the found."""

from __future__ import annotations

import operator
import sys
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")


def _describe(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def wrong_type(name: str, expected: str, value: Any) -> TypeError:
    """The error for an argument of the wrong type."""
    return TypeError(f"{name}: expected {expected}, found {_describe(value)} ({type(value).__name__})")


def wrong_value(name: str, expected: str, value: Any) -> ValueError:
    """The error for an argument of the right type with a value that makes no sense."""
    return ValueError(f"{name}: expected {expected}, found {_describe(value)}")


def flag(value: Any, name: str) -> bool:
    """True or False; numbers are refused.

    >>> flag(np.True_, "on")
    True
    """
    if not isinstance(value, (bool, np.bool_)):
        raise wrong_type(name, "True or False", value)
    return bool(value)


def integer(value: Any, name: str, low: int | None = None, high: int | None = None) -> int:
    """A whole number within low and high, both included; True and False are refused."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise wrong_type(name, "an integer", value) from None
    if (low is not None and number < low) or (high is not None and number > high):
        if high is None:
            raise wrong_value(name, f"an integer of at least {low}", number)
        raise wrong_value(name, f"an integer from {low} to {high}", number)
    return number


def finite(value: Any, name: str) -> float:
    """A finite real number; True, False and text are refused.

    >>> finite(np.float32(0.5), "x")
    0.5
    """
    try:
        if isinstance(value, (bool, np.bool_, str, bytes)) or np.ndim(value) > 0:
            raise TypeError
        if isinstance(value, np.ndarray) and value.dtype.kind not in "iuf":
            raise TypeError
        number = float(value)
    except (TypeError, ValueError):
        raise wrong_type(name, "a real number", value) from None
    except OverflowError:
        number = float("inf")
    if not np.isfinite(number):
        raise wrong_value(name, "a finite number", number)
    return number


def positive(value: Any, name: str) -> float:
    """A finite number above zero, whose inverse is finite too."""
    number = finite(value, name)
    if number < sys.float_info.min:
        raise wrong_value(name, "a positive number", number)
    return number


def non_negative(value: Any, name: str) -> float:
    """A finite number, zero or above."""
    number = finite(value, name)
    if number < 0:
        raise wrong_value(name, "zero or a positive number", number)
    return number


def numbers(value: Any, name: str, expected: str = "an array of numbers") -> NDArray[Any]:
    """numpy.asarray for integers and real numbers."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise wrong_type(name, expected, value) from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: expected {expected}, found {_describe(value)} (dtype {array.dtype})")
    return array


def _require_finite_entries(array: NDArray[np.float64], name: str) -> None:
    if np.isfinite(array).all():
        return
    place = tuple(int(n) for n in np.argwhere(~np.isfinite(array))[0])
    entry = f"{name}[{', '.join(map(str, place))}]"
    raise ValueError(f"{entry}: expected a finite number, found {array[place]}")


def vector(value: Any, name: str, length: int = 3) -> tuple[float, ...]:
    """A sequence of so many finite numbers.

    >>> vector(np.array([1, 2, 3]), "force")
    (1.0, 2.0, 3.0)
    """
    expected = f"a sequence of {length} numbers"
    array = numbers(value, name, expected)
    if array.shape != (length,):
        raise ValueError(f"{name}: expected {expected}, found shape {array.shape}")
    array = array.astype(np.float64)
    _require_finite_entries(array, name)
    return tuple(array.tolist())


def integers(
    value: Any, name: str, length: int = 3, low: int | None = None, high: int | None = None
) -> list[int]:
    """A sequence of so many whole numbers within low and high."""
    expected = f"a sequence of {length} integers"
    if isinstance(value, (str, bytes, dict, set)) or not hasattr(value, "__len__") or np.shape(value) == ():
        raise wrong_type(name, expected, value)
    if len(value) != length:
        raise wrong_value(name, expected, value)
    return [integer(entry, f"{name}[{n}]", low, high) for n, entry in enumerate(value)]


def field(value: Any, name: str, shape: Sequence[int]) -> NDArray[np.float64]:
    """Finite float64 values in Fortran order, converted where they are not: one per cell."""
    array = numbers(value, name, f"an array of real numbers of shape {tuple(shape)}")
    if array.shape != tuple(shape):
        raise ValueError(f"{name}: expected an array of shape {tuple(shape)}, found {array.shape}")
    array = np.asfortranarray(array, dtype=np.float64)
    _require_finite_entries(array, name)
    return array


def choice(value: Any, name: str, choices: Sequence[str]) -> str:
    """One of these words."""
    expected = "one of " + ", ".join(map(repr, choices))
    if not isinstance(value, str):
        raise wrong_type(name, expected, value)
    if value not in choices:
        raise wrong_value(name, expected, value)
    return value


def code(value: Any, name: str, codes: Mapping[str | int, T], expected: str) -> T:
    """What a name, or the integer that older scripts use for it, stands for.

    >>> code(1, "scheme", {"koren": "k", 1: "k"}, "'koren' or 1")
    'k'
    """
    if not isinstance(value, str):
        try:
            value = integer(value, name)
        except TypeError:
            raise wrong_type(name, expected, value) from None
    if value not in codes:
        raise wrong_value(name, expected, value)
    return codes[value]
