"""What happened to the bodies, step by step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

_COLUMNS = {
    "time": 0,
    "position": 3,
    "velocity": 3,
    "angular_velocity": 3,
    "orientation": 4,
    "force": 3,
    "torque": 3,
    "contact_impulse": 3,
}
_LOADS = ("force", "torque", "contact_impulse")


class History:
    """Rows in storage that doubles when it is full: reading it after every step stays cheap."""

    def __init__(self, first: Mapping[str, Any]) -> None:
        bodies = len(first["position"])
        self._length = 0
        self._storage = {name: np.zeros((64, *_row_shape(name, bodies))) for name in _COLUMNS}
        self.append({**first, **{name: np.zeros((bodies, 3)) for name in _LOADS}})

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]], bodies: int) -> History:
        """The inverse of arrays(); refuses what it cannot have returned."""
        if set(arrays) != set(_COLUMNS):
            raise ValueError(f"history: expected {sorted(_COLUMNS)}, found {sorted(arrays)}")
        length = arrays["time"].size
        for name, array in arrays.items():
            expected = (length, *_row_shape(name, bodies))
            if array.shape != expected or length < 1:
                raise ValueError(f"history/{name}: expected shape {expected}, found {array.shape}")
        history = cls({name: array[0] for name, array in arrays.items()})
        history._storage = {name: np.array(arrays[name], dtype=np.float64) for name in _COLUMNS}
        history._length = length
        return history

    def append(self, row: Mapping[str, Any]) -> None:
        """Add what is known after a step."""
        if self._length == len(self._storage["time"]):
            self._storage = {name: np.concatenate([a, np.zeros_like(a)]) for name, a in self._storage.items()}
        for name, array in self._storage.items():
            array[self._length] = row[name]
        self._length += 1

    def arrays(self) -> dict[str, NDArray[np.float64]]:
        """Copies, one row per step."""
        return {name: array[: self._length].copy() for name, array in self._storage.items()}

    def last(self, name: str, rows: int = 1) -> NDArray[np.float64]:
        """The last rows of one array, without copying the rest."""
        return self._storage[name][max(0, self._length - rows) : self._length].copy()


def _row_shape(name: str, bodies: int) -> tuple[int, ...]:
    columns = _COLUMNS[name]
    return (bodies, columns) if columns else ()
