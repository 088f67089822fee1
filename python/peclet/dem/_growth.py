"""Particles that grow: the part of Simulation that packings are made with."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from peclet import _checks
from peclet.dem._readback import CallableFloat

if TYPE_CHECKING:
    from peclet.dem.simulation import Simulation

_FIRST_FACTOR = 0.01


class Growth:
    """Part of Simulation."""

    _growth_rate = 0.0
    _growth_factor = 1.0
    _global_scale = 1.0

    def set_growth_params(self: Simulation, rate: float, new_factor: float = -1.0) -> None:
        """After each step sizes are multiplied by exp(rate dt), until the factor reaches 1. ``new_factor``
        in (0, 1] is the factor to go on from; without it (-1) the present one, or 0.01 the first time.
        Masses stay.
        """
        rate = _checks.finite(rate, "rate")
        new_factor = _checks.finite(new_factor, "new_factor")
        if new_factor != -1.0 and not 0 < new_factor <= 1:
            raise _checks.wrong_value("new_factor", "a number in (0, 1], or -1", new_factor)
        is_first = self._growth_rate == 0.0 and self._growth_factor == 1.0
        if new_factor == -1.0:
            new_factor = _FIRST_FACTOR if is_first else self._growth_factor
        self._set_growth_factor(new_factor)
        self._growth_rate = rate

    @property
    def growth_rate(self) -> float:
        """Relative growth per time; 0: none."""
        return self._growth_rate

    @property
    def growth_factor(self) -> float:
        """Present size over full size."""
        return self._growth_factor

    def set_global_scale(self: Simulation, scale: float) -> None:
        """Factor on the radius of all particles, besides their own scales."""
        scale = _checks.positive(scale, "scale")
        if self._core.shape_radius > 0:
            self._core.set_shape_radius(self._core.shape_radius * (scale / self._global_scale))
        self._global_scale = scale

    @property
    def global_scale(self) -> CallableFloat:
        """Set by set_global_scale."""
        return CallableFloat(self._global_scale)

    def _grow(self: Simulation, dt: float) -> None:
        if self._growth_rate != 0.0:
            self._set_growth_factor(min(1.0, self._growth_factor * math.exp(self._growth_rate * dt)))

    def _set_growth_factor(self: Simulation, factor: float) -> None:
        if factor != self._growth_factor:
            self._core.set_scales(self._core.get_scales() * (factor / self._growth_factor))
        self._growth_factor = factor
