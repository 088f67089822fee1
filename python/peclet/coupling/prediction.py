"""Accelerations that the coupling extrapolates, so that fluid and bodies meet in the middle of the step."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]
_ARRAYS = ("last", "predicted", "felt")


class Prediction:
    """How far the velocity that the fluid sees is ahead of that of the bodies; arrays of shape (n, 3).

    In a step of length dt, friction acts on the velocity that the fluid is given. That is to be the one in
    the middle of the step, which its own reaction is to decide: v + dt/2 predicted. The acceleration a is
    predicted to be that of the last step; where it has more than halved since the step before, as it does
    after a jolt, min(1, 2 a . a_before / a_before^2) of that. A body that a contact has just stopped or
    pushed is predicted to go on with the velocity that it has.
    """

    def __init__(self, first: Vectors) -> None:
        self.last = first.copy()  # acceleration by the fluid in the last step
        self.predicted = first.copy()
        self.felt = 0.5 * first  # rate of change, in the step, of the velocity that the fluid is given

    def lead(self, time_step: float) -> Vectors:
        """What is to be added to the velocity of the bodies."""
        return 0.5 * time_step * self.predicted

    def advance(self, acceleration: Vectors, touched: NDArray[np.bool_]) -> None:
        """The step has shown the acceleration by the fluid; contacts acted on the bodies that touched."""
        squares = np.maximum((self.last**2).sum(axis=1, keepdims=True), np.finfo(float).tiny)
        remaining = (acceleration * self.last).sum(axis=1, keepdims=True) / squares
        following = np.where(touched[:, None], 0.0, np.clip(2 * remaining, 0.0, 1.0) * acceleration)
        self.felt = acceleration + 0.5 * (following - self.predicted)
        self.predicted = following
        self.last = acceleration

    def state(self) -> dict[str, Vectors]:
        """Copies of the arrays, by name."""
        return {name: getattr(self, name).copy() for name in _ARRAYS}

    def set_state(self, arrays: Mapping[str, Vectors]) -> None:
        """Take over what state() returned."""
        for name in _ARRAYS:
            setattr(self, name, arrays[name].copy())
