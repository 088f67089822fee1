"""Marching to a steady flow, with a certified stop and Anderson's acceleration."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from peclet import _checks

State = dict[str, NDArray[np.float64]]
_VELOCITY = ("u", "v", "w")
_PAST = ("clock", "bodies")  # never mixed


@dataclass(frozen=True)
class SteadyResult:
    """How a march went.

    converged: whether the stop was certified. steps: steps made. reason: in words. residual: estimate of what
    the monitored value would still change, relative to it. value: the monitored value, also called monitor.
    history: (step, value) of every check.
    """

    converged: bool
    steps: int
    reason: str
    residual: float
    value: float
    history: list[tuple[int, float]] = field(repr=False)

    @property
    def monitor(self) -> float:
        """The monitored value."""
        return self.value


def march_to_steady(
    solver: Any,
    monitor: Callable[[Any], float] | Callable[[], float],
    rtol: float = 1e-4,
    max_steps: int = 5000,
    accelerate: bool = True,
    window: int = 5,
    check_every: int = 5,
    num_passes: int = 3,
    slow_rate: float = 0.997,
    roundoff: float = 1e-11,
    callback: Callable[[SteadyResult], object] | Callable[[int, str], object] | None = None,
) -> SteadyResult:
    """Step until monitor(solver), one number such as a force or a mean velocity, has settled.

    The monitor may also take no argument.

    Every check_every steps the value is looked at. From its last two changes d1, d2 the rest of a geometric
    decay is estimated, |d2| q / (1 - q) with q = |d2 / d1| (at most slow_rate, so that a slow drift is not
    taken for the end); the flow is steady when num_passes estimates in a row are below rtol times the value,
    or the changes have sunk to roundoff.

    accelerate: between checks, replace the state by the combination of the last window states whose change
    is smallest [WalkerNi2011]; a step that makes the change grow is taken back and the memory is dropped. The
    time of the solver then has no meaning. callback(result so far), or callback(steps, phase) with the phase
    "accelerate" or "certify" (plain steps) if it takes two arguments, ends the march by returning True.

    Raises ValueError or TypeError naming the argument. What step() raises passes through.

    >>> from peclet.flow import Solver
    >>> channel = Solver((2, 8, 2), extent=(1, 1, 1))
    >>> channel.set_domain_bc("-y", "wall"); channel.set_domain_bc("+y", "wall")
    >>> channel.set_mu(1); channel.set_dt(1); channel.set_body_force(12, 0, 0)
    >>> result = march_to_steady(channel, lambda s: s.get_u().mean(), rtol=1e-8)
    >>> result.converged, round(result.value, 2)
    (True, 1.01)
    """
    rtol = _checks.positive(rtol, "rtol")
    max_steps = _checks.integer(max_steps, "max_steps", low=1)
    window = _checks.integer(window, "window", low=1)
    check_every = _checks.integer(check_every, "check_every", low=1)
    num_passes = _checks.integer(num_passes, "num_passes", low=1)
    slow_rate = _checks.positive(slow_rate, "slow_rate")
    if slow_rate >= 1:
        raise _checks.wrong_value("slow_rate", "a number below 1", slow_rate)
    roundoff = _checks.non_negative(roundoff, "roundoff")
    accelerate = _checks.flag(accelerate, "accelerate")
    if not callable(monitor):
        raise _checks.wrong_type("monitor", "a function of the solver", monitor)

    read_monitor = functools.partial(monitor, *[solver][: _number_of_arguments(monitor)])

    settling = _Settling(rtol, num_passes, slow_rate, roundoff)
    mixing = _Anderson(window) if accelerate else None
    steps = 0
    while steps < max_steps:
        before = solver.checkpoint() if mixing else {}
        for _ in range(min(check_every, max_steps - steps)):
            solver.step()
            steps += 1
        settling.add(steps, _number(read_monitor()))
        result = settling.result(steps)
        if callback is not None and _report(callback, result, mixing is not None) is True:
            return settling.result(steps, "stopped by callback")
        if result.converged:
            return result
        if mixing and steps < max_steps:
            solver.restore(mixing.next(before, solver.checkpoint()))
    return settling.result(steps, f"max_steps reached: {max_steps}")


class _Settling:
    """Judges a sequence of values."""

    def __init__(self, rtol: float, num_passes: int, slow_rate: float, roundoff: float) -> None:
        self._rtol, self._num_passes = rtol, num_passes
        self._slow_rate, self._roundoff = slow_rate, roundoff
        self._history: list[tuple[int, float]] = []
        self._passes = self._still = 0
        self._residual = math.inf

    def add(self, step: int, value: float) -> None:
        self._history.append((step, value))
        values = [v for _, v in self._history[-3:]]
        if len(values) < 3:
            return
        first, last = abs(values[1] - values[0]), abs(values[2] - values[1])
        size = abs(values[2])
        rate = min(last / first, self._slow_rate) if first > 0 else 0.0
        # oscillating or growing changes say nothing about their end
        rest = last * rate / (1 - rate) if last < first or last == 0 else last / (1 - self._slow_rate)
        rest = max(rest, last)
        self._residual = rest / size if size > 0 else (0.0 if rest == 0 else math.inf)
        self._passes = self._passes + 1 if self._residual <= self._rtol else 0
        self._still = self._still + 1 if last <= self._roundoff * size else 0

    def result(self, steps: int, otherwise: str = "still changing") -> SteadyResult:
        value = self._history[-1][1]
        converged, reason = True, f"estimated change below rtol {self._rtol:g} in {self._num_passes} checks"
        if self._still >= self._num_passes:
            reason = f"changes below roundoff {self._roundoff:g}"
        elif self._passes < self._num_passes:
            converged, reason = False, otherwise
        return SteadyResult(converged, steps, reason, self._residual, value, list(self._history))


class _Anderson:
    """Fixed-point iteration x -> G(x) sped up by a least-squares combination of steps [WalkerNi2011].

    With f = G(x) - x of the velocity, the weights a (sum 1) minimise |sum a f|; the next x is sum a G(x).
    """

    def __init__(self, window: int) -> None:
        self._window = window
        self._images: list[State] = []
        self._changes: list[NDArray[np.float64]] = []

    def next(self, before: State, after: State) -> State:
        """The state to go on from, G(before) being after."""
        change = np.concatenate([(after[c] - before[c]).ravel(order="K") for c in _VELOCITY])
        if self._changes and np.linalg.norm(change) > 2 * np.linalg.norm(self._changes[-1]):
            self._images, self._changes = [], []
            return after
        self._images = [*self._images, after][-self._window :]
        self._changes = [*self._changes, change][-self._window :]
        weights = self._weights()
        return {
            name: array
            if name in _PAST
            else sum((w * image[name] for w, image in zip(weights, self._images, strict=True)), 0 * array)
            for name, array in after.items()
        }

    def _weights(self) -> NDArray[np.float64]:
        f = self._changes
        gram = np.array([[a @ b for b in f] for a in f])
        size = np.trace(gram)
        if len(f) == 1 or size == 0:
            return np.eye(len(f))[-1]
        ones = np.ones(len(f))
        weights = np.linalg.lstsq(gram + 1e-14 * size * np.eye(len(f)), ones, rcond=None)[0]
        return weights / weights.sum()


def _number_of_arguments(function: Callable[..., Any]) -> int:
    """How many arguments without a default a function takes; one if it does not tell or takes any."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:
        return 1
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    if any(p.kind == inspect.Parameter.VAR_POSITIONAL for p in parameters):
        return 1
    return sum(p.kind in positional and p.default is inspect.Parameter.empty for p in parameters)


def _report(callback: Callable[..., object], result: SteadyResult, is_accelerated: bool) -> object:
    if _number_of_arguments(callback) == 2:
        return callback(result.steps, "accelerate" if is_accelerated else "certify")
    return callback(result)


def _number(value: Any) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise RuntimeError(f"monitor: expected a finite number, found {number}")
    return number
