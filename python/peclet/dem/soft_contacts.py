"""Elastic contacts: the part of Simulation that step_hertz belongs to."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

from peclet import _checks
from peclet.dem import _arguments

if TYPE_CHECKING:
    from peclet.dem.simulation import Simulation

_SUBSTEPS_BETWEEN_INTERRUPTS = 256
_LARGEST_SHARE_OF_RAYLEIGH_TIME = 0.3
_FEWEST_SUBSTEPS_OF_AN_IMPACT = 20


class HertzTimes(NamedTuple):
    """What the substeps of step_hertz have to be short against."""

    rayleigh: float
    """Time that a surface wave needs around half of the smallest and stiffest particle."""
    impact: float
    """Duration of an impact of two such particles at the present speeds."""


class SoftContacts:
    """Part of Simulation."""

    def set_hertz_material(self: Simulation, mat: int, youngs: float, poisson: float) -> None:
        """Young's modulus and Poisson's ratio, in (-1, 0.5], of a material id (0 to 1023). Particles and
        planes have material 0 at first; so have scene walls until set_wall_material_id. Restitution and
        frictions are those of set_material_params, set_pair_material and the walls; tangential restitution
        follows from elasticity and is not used.
        """
        self._core.set_elastic_material(
            _checks.integer(mat, "mat", 0, 1023),
            _checks.positive(youngs, "youngs"),
            _checks.finite(poisson, "poisson"),
        )

    def hertz_times(self: Simulation) -> HertzTimes:
        """Time scales of elastic contact; infinite where nothing moves. RuntimeError while a particle or
        wall has no Young's modulus.
        """
        return HertzTimes(*self._core.soft_time_scales())

    def step_hertz(self: Simulation, *args: Any, **kwargs: Any) -> None:
        """Substeps with soft contacts: Hertz across, Mindlin along the contact, both damped so that the
        restitution comes out at any speed; friction and rolling resistance keep their springs from one
        substep to the next. In one of these forms::

            set_dt(dt); step_hertz(substeps=1, skin_frac=0.3)
            step_hertz(dt, substeps=1, skin_frac=0.3)

        Each substep has the length dt; once set_dt was called, a whole number comes first. skin_frac, in
        radii, is how far the neighbour list reaches beyond the surfaces: larger ones are made anew less
        often. ValueError if dt exceeds the Rayleigh time, RuntimeWarning if it resolves impacts badly
        (see hertz_times). A restitution below 0.01 counts as 0.01.
        """
        counts = self.dt > 0 and "dt" not in kwargs and (not args or hasattr(args[0], "__index__"))
        form = ("substeps", "skin_frac") if counts else ("dt", "substeps", "skin_frac")
        named = _arguments.by_name(form, args, kwargs, "step_hertz")
        if not counts and "dt" not in named:
            raise RuntimeError("step_hertz: expected a length dt, here or from set_dt, found none")
        dt = self.dt if counts else _checks.positive(named["dt"], "dt")
        substeps = _checks.integer(named.get("substeps", 1), "substeps", 0, 2**31 - 1)
        skin = _checks.positive(named.get("skin_frac", 0.3), "skin_frac")
        self._core.step_hertz(dt, 0, skin)
        self._warn_of_long_substeps(dt)
        for first in range(0, substeps, _SUBSTEPS_BETWEEN_INTERRUPTS):
            self._core.step_hertz(dt, min(_SUBSTEPS_BETWEEN_INTERRUPTS, substeps - first), skin)

    def _warn_of_long_substeps(self: Simulation, dt: float) -> None:
        times = self.hertz_times()
        longest = min(
            _LARGEST_SHARE_OF_RAYLEIGH_TIME * times.rayleigh, times.impact / _FEWEST_SUBSTEPS_OF_AN_IMPACT
        )
        if dt > longest:
            warnings.warn(
                f"step_hertz: dt = {dt:g} resolves contacts badly; expected at most {longest:.3g} "
                f"(Rayleigh time {times.rayleigh:.3g}, duration of an impact {times.impact:.3g})",
                RuntimeWarning,
                stacklevel=3,
            )
