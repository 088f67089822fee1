"""The cylinder of cylinder.py once more, in unbounded fluid and without the solver.

Vorticity w and stream function psi in polar coordinates that move along with the cylinder, sines around it
(the flow is symmetric) and second-order differences along xi = ln(r / a):

    dw/dt + (psi_theta w_xi - psi_xi w_theta) / r^2 = nu (w_xi,xi + w_theta,theta) / r^2
    psi_xi,xi + psi_theta,theta = -r^2 w,   psi = psi_xi = 0 at the wall,   psi -> U r sin(theta) far away

where -U is the velocity of the cylinder. In time second-order differences backwards, the advection
extrapolated [AscherRuuthWetton1995]; the wall vorticity makes psi_xi zero.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from examples.validation.cylinder import OMEGA, PERIOD, REYNOLDS

RADIUS = 0.5
# Weight of the new vorticity over dt: in the first step, which has no past, and later.
FIRST, LATER = 1.0, 1.5


@dataclasses.dataclass(frozen=True)
class PolarGrid:
    """modes sines times `rings` circles from the wall to the radius `far`, in diameters."""

    modes: int
    rings: int
    far: float
    advection: bool = True

    @property
    def xi(self) -> np.ndarray:
        """ln(r / a)."""
        return np.linspace(0, np.log(self.far / RADIUS), self.rings)

    @property
    def r(self) -> np.ndarray:
        """Distance from the axis."""
        return RADIUS * np.exp(self.xi)

    def laplacian(self, mode: int) -> np.ndarray:
        """r^2 times the Laplacian of a mode; first and last row are left to the conditions there."""
        off, spacing = np.ones(self.rings - 1), self.xi[1]
        second = (np.diag(off, 1) + np.diag(off, -1) - 2 * np.eye(self.rings)) / spacing**2
        return second - mode**2 * np.eye(self.rings)


class PolarFlow:
    """Flow around the cylinder, from rest."""

    def __init__(self, grid: PolarGrid, dt: float, nu: float) -> None:
        self.grid, self.dt, self.nu = grid, dt, nu
        self.mode = np.arange(1, grid.modes + 1)
        angle = np.pi * (np.arange(3 * grid.modes // 2 + 1) + 0.5) / (3 * grid.modes // 2 + 1)
        self.sines = np.sin(np.outer(angle, self.mode))
        self.cosines = np.cos(np.outer(angle, self.mode)) * self.mode
        self.poisson = np.stack([self._poisson(mode) for mode in self.mode])
        self.diffusion = {weight: self._diffusion(weight) for weight in (FIRST, LATER)}
        self.w = np.zeros((grid.modes, grid.rings))
        self.old_w, self.old_advection = self.w, None
        self.psi = self.stream_function(self.w, 0)

    def _poisson(self, mode: int) -> np.ndarray:
        matrix, spacing = self.grid.laplacian(mode), self.grid.xi[1]
        matrix[0] = np.eye(self.grid.rings)[0]
        # psi_xi + mode psi is given where the vorticity ends
        matrix[-1, -2] = 2 / spacing**2
        matrix[-1, -1] -= 2 * mode / spacing
        return np.linalg.inv(matrix)

    def _diffusion(self, weight: float) -> np.ndarray:
        identity = np.eye(self.grid.rings)
        inverses = []
        for mode in self.mode:
            matrix = (
                weight / self.dt * identity - self.nu * self.grid.laplacian(mode) / self.grid.r[:, None] ** 2
            )
            matrix[[0, -1]] = identity[[0, -1]]
            inverses.append(np.linalg.inv(matrix))
        return np.stack(inverses)

    def stream_function(self, w: np.ndarray, speed: float) -> np.ndarray:
        """Of a vorticity, in a stream of this speed."""
        source = -(self.grid.r**2) * w
        source[:, 0] = 0
        source[0, -1] -= 4 * speed * self.grid.r[-1] / self.grid.xi[1]
        return _apply(self.poisson, source)

    def slip(self, w: np.ndarray, psi: np.ndarray) -> np.ndarray:
        """Zero if psi_xi is, at the wall."""
        return 2 * psi[:, 1] / self.grid.xi[1] ** 2 + RADIUS**2 * w[:, 0]

    def advection(self) -> np.ndarray:
        """Change of the vorticity by advection."""
        if not self.grid.advection:
            return np.zeros_like(self.w)
        w_xi = np.gradient(self.w, self.grid.xi[1], axis=1)
        psi_xi = np.gradient(self.psi, self.grid.xi[1], axis=1)
        product = (self.cosines @ self.psi) * (self.sines @ w_xi) - (self.sines @ psi_xi) * (
            self.cosines @ self.w
        )
        return 2 / len(self.sines) * self.sines.T @ product / self.grid.r**2

    def step(self, speed: float) -> None:
        """To the next time, when the stream has this speed."""
        advection = self.advection()
        if self.old_advection is None:
            weight, source = FIRST, self.w / self.dt - advection
        else:
            weight, source = (
                LATER,
                (2 * self.w - self.old_w / 2) / self.dt - 2 * advection + self.old_advection,
            )
        source[:, [0, -1]] = 0
        w = _apply(self.diffusion[weight], source)
        wall = self.diffusion[weight][:, :, 0]
        reaction = self.slip(wall, self.stream_function(wall, 0))
        w = w - (self.slip(w, self.stream_function(w, speed)) / reaction)[:, None] * wall
        self.old_w, self.w, self.old_advection = self.w, w, advection
        self.psi = self.stream_function(w, speed)

    def force(self, acceleration: float) -> float:
        """Along x, over rho U^2 d / 2: pressure, friction, and what the acceleration of the cylinder adds."""
        w = self.w[0, :5]
        slope = w @ np.array([-25, 48, -36, 16, -3]) / (12 * self.grid.xi[1] * RADIUS)
        return 2 * np.pi * RADIUS * (self.nu * (RADIUS * slope - w[0]) + RADIUS * acceleration)


def run(
    grid: PolarGrid, per_period: int, periods: int, *, reynolds: float = REYNOLDS
) -> tuple[np.ndarray, np.ndarray]:
    """Times over d / U and forces over rho U^2 d / 2 of all steps; the velocity is -cos(OMEGA t)."""
    dt = PERIOD / per_period
    flow = PolarFlow(grid, dt, 1 / reynolds)
    times, forces = dt * np.arange(1, periods * per_period + 1), []
    for time in times:
        flow.step(float(np.cos(OMEGA * time)))
        forces.append(flow.force(float(OMEGA * np.sin(OMEGA * time))))
    return times, np.array(forces)


def _apply(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.matmul(matrices, vectors[:, :, None])[:, :, 0]
