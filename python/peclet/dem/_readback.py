"""Numbers that read as values and as calls: both generations of scripts use them."""

from __future__ import annotations


class CallableInt(int):
    """An int; calling it returns the plain int (``sim.num_particles`` and ``sim.num_particles()``)."""

    def __call__(self) -> int:
        return int(self)


class CallableFloat(float):
    """A float; calling it returns the plain float."""

    def __call__(self) -> float:
        return float(self)
