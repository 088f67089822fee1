"""Vectors between world and body axes; quaternions (x, y, z, w) turn the body actively."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def from_body_axes(quaternions: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """World components of vectors given along the axes of bodies, v + 2 q x (q x v + w v), row by row.

    >>> quarter_turn_about_z = np.array([[0, 0, np.sqrt(0.5), np.sqrt(0.5)]])
    >>> from_body_axes(quarter_turn_about_z, np.array([[1.0, 0, 0]])).round(12)
    array([[0., 1., 0.]])
    """
    axis, w = quaternions[:, :3], quaternions[:, 3:]
    return vectors + 2 * np.cross(axis, np.cross(axis, vectors) + w * vectors)


def to_body_axes(quaternions: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """The inverse of from_body_axes."""
    return from_body_axes(quaternions * np.array([-1.0, -1.0, -1.0, 1.0]), vectors)
