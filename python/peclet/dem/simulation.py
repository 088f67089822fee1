"""Simulation: the calls of both generations of scripts over one compiled core."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from peclet import _checks
from peclet.dem import _arguments, _dem
from peclet.dem._growth import Growth
from peclet.dem._older_names import OlderNames
from peclet.dem._readback import CallableFloat, CallableInt
from peclet.dem.diagnostics import Diagnostics
from peclet.dem.soft_contacts import SoftContacts
from peclet.dem.surfaces import Surfaces

_SPHERES = ("sphere",)
_SPHERE_CODES = (0, 1)


class Simulation(Surfaces, SoftContacts, Growth, OlderNames):
    """Rigid spheres with contacts, friction and walls, advanced by substeps.

    Units are the user's own. Inputs may be float32, float64 or integers in any memory order; the state is
    kept in double precision and the getters return float64 copies. Positions, velocities, angular
    velocities, forces and torques are (N, 3) along world axes; quaternions (N, 4) as x, y, z, w. Errors
    name the argument, what was expected and what was found; the simulation stays as it was.

    By default contacts stop the approach (restitution 0, no friction) and keep touching spheres from
    overlapping. ``set_solver_iterations(n, 0)`` leaves velocities alone and only pushes overlapping spheres
    apart.
    """

    def __init__(self, capacity: int) -> None:
        """Room for ``capacity`` particles (at least 1); it grows when more are set."""
        self._core = _dem.Simulation(_checks.integer(capacity, "capacity", 1, 2**31 - 1))
        self._dt = 0.0
        self._diagnostics = Diagnostics(self._core)

    def __repr__(self) -> str:
        return f"<peclet.dem.Simulation of {self._core.count} particles at time {self._core.time:g}>"

    # Box and gravity

    def set_gravity(self, gravity: ArrayLike, gy: float | None = None, gz: float | None = None) -> None:
        """Acceleration of all particles that are not fixed: three numbers, or one sequence of three."""
        self._core.set_gravity(_arguments.three_numbers(gravity, gy, gz, "gravity"))

    def set_domain(self, *args: Any, **kwargs: Any) -> None:
        """The box, in one of these forms::

            set_domain(lx, ly, lz, px=True, py=True, pz=False)
            set_domain(min, max)
            set_domain(extent, origin=(0, 0, 0), periodic=(True, True, False))

        ``min``, ``max``, ``extent`` and ``origin`` are sequences of three; two sequences without names mean
        min and max, which leaves the periodicity as it is. Extent 0 means unbounded along that axis. The
        faces of the box are not walls. Periodic axes need an extent of at least the largest diameter;
        positions wrap into the box.
        """
        origin, extent, periodic = _arguments.box(args, kwargs)
        self._core.set_domain(origin, extent)
        if periodic is not None:
            self._core.set_periodic(*periodic)

    def set_periodic(self, x: bool, y: bool, z: bool) -> None:
        """Which axes of the domain are periodic. Contacts see all images, also in boxes of few diameters."""
        self._core.set_periodic(*_arguments.three_flags((x, y, z), "periodic"))

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Acceleration set by set_gravity."""
        return self._core.gravity

    @property
    def origin(self) -> tuple[float, float, float]:
        """Low corner of the domain."""
        return self._core.origin

    @property
    def extent(self) -> tuple[float, float, float]:
        """Lengths of the domain; 0: unbounded."""
        return self._core.extent

    @property
    def periodic(self) -> tuple[bool, bool, bool]:
        """Periodic axes."""
        return self._core.periodic

    # Shape and state of the particles

    def set_sphere_shape(self, radius: float) -> None:
        """All particles are spheres of this radius (times their scale). Comes before set_positions."""
        self._core.set_shape_radius(_checks.positive(radius, "radius") * self._global_scale)

    def initialize_shape(
        self, shape: str | int, radius: float, height: float = 0.0, thickness: float = 0.0
    ) -> None:
        """``initialize_shape('sphere', radius)`` is set_sphere_shape(radius); 0 and 1 stand for 'sphere'.
        Height and thickness belong to other shapes and must be finite; spheres have none.
        """
        if isinstance(shape, str):
            _checks.choice(shape, "shape", _SPHERES)
        else:
            _checks.integer(shape, "shape", _SPHERE_CODES[0], _SPHERE_CODES[-1])
        _checks.finite(height, "height")
        _checks.finite(thickness, "thickness")
        self.set_sphere_shape(radius)

    def set_positions(self, positions: ArrayLike) -> None:
        """(N, 3), or (N, 4) with the inverse masses in the last column (0: fixed). Sets the number of
        particles. Velocities, spins and quaternions, scales (1), inverse masses (1) and inertias start
        anew; external forces and torques and material ids stay if N stays. RuntimeError before a shape is
        set.
        """
        self._core.set_positions(positions)
        if self._growth_factor != 1.0:
            self._core.set_scales(np.full(self._core.count, self._growth_factor))

    def set_velocities(self, velocities: ArrayLike) -> None:
        """(N, 3)."""
        self._core.set_velocities(velocities)

    def set_angular_velocities(self, angular_velocities: ArrayLike) -> None:
        """(N, 3), radians per time along world axes."""
        self._core.set_angular_velocities(angular_velocities)

    def set_quaternions(self, quaternions: ArrayLike) -> None:
        """(N, 4) as x, y, z, w; normalised, zero ones are refused."""
        self._core.set_quaternions(quaternions)

    def set_inv_mass(self, inv_mass: ArrayLike) -> None:
        """(N,), not negative; 0 is a fixed body: it moves with its own velocity and nothing changes that.
        Inverse inertias follow as 2.5 inv_mass / radius^2 unless set_inv_inertia was called.
        """
        self._core.set_inv_mass(inv_mass)

    def set_inv_inertia(self, inv_inertia: ArrayLike) -> None:
        """(N, 3), not negative, diagonal along body axes; 0: nothing changes the spin about that axis."""
        self._core.set_inv_inertia(inv_inertia)

    def set_scales(self, scales: ArrayLike) -> None:
        """(N,), positive: radius = scale * radius of the shape. Masses stay."""
        self._core.set_scales(scales)

    def set_scales_uniform(self, scale: float) -> None:
        """One scale for all."""
        self._core.set_scales(np.full(self._core.count, _checks.positive(scale, "scale")))

    def set_external_forces(self, forces: ArrayLike) -> None:
        """(N, 3); act until replaced or cleared."""
        self._core.set_external_forces(forces)

    def set_external_torques(self, torques: ArrayLike) -> None:
        """(N, 3) along world axes; act until replaced or cleared."""
        self._core.set_external_torques(torques)

    def clear_external_forces(self) -> None:
        """All external forces become zero."""
        self._core.set_external_forces(np.zeros((self._core.count, 3)))

    def clear_external_torques(self) -> None:
        """All external torques become zero."""
        self._core.set_external_torques(np.zeros((self._core.count, 3)))

    def get_positions(self) -> NDArray[np.float64]:
        """(N, 3), a copy."""
        return self._core.get_positions()

    def get_velocities(self) -> NDArray[np.float64]:
        """(N, 3), a copy."""
        return self._core.get_velocities()

    def get_angular_velocities(self) -> NDArray[np.float64]:
        """(N, 3), a copy."""
        return self._core.get_angular_velocities()

    def get_quaternions(self) -> NDArray[np.float64]:
        """(N, 4) as x, y, z, w, a copy."""
        return self._core.get_quaternions()

    def get_scales(self) -> NDArray[np.float64]:
        """(N,), a copy."""
        return self._core.get_scales()

    def get_inv_inertia(self) -> NDArray[np.float64]:
        """(N, 3), a copy."""
        return self._core.get_inv_inertia()

    def get_masses(self) -> NDArray[np.float64]:
        """(N,), infinite for fixed bodies."""
        with np.errstate(divide="ignore"):
            return 1.0 / self._core.get_inv_mass()

    def get_positions_view(self) -> Any:
        """(N, 3), the memory itself: writing to it moves particles. It stays connected until set_positions
        needs more room. What is written is checked at the next step. On a GPU, an object for DLPack.
        """
        return self._core.positions_view()

    def get_velocities_view(self) -> Any:
        """(N, 3), the memory itself (see get_positions_view)."""
        return self._core.velocities_view()

    def get_external_forces_view(self) -> Any:
        """(N, 3), the memory itself (see get_positions_view)."""
        return self._core.external_forces_view()

    def get_inv_mass_view(self) -> Any:
        """(N,), the memory itself (see get_positions_view)."""
        return self._core.inv_mass_view()

    # Time

    def set_solver_iterations(self, pos: int, vel: int) -> None:
        """Caps on the sweeps over all contacts that separate overlaps and that settle velocities; a
        tolerance ends them earlier. ``vel`` = 0: contacts leave velocities alone.
        """
        self._core.set_iterations(
            _checks.integer(pos, "pos", 0, 10**6), _checks.integer(vel, "vel", 0, 10**6)
        )

    def set_dt(self, dt: float) -> None:
        """Length of the substeps of step(n)."""
        self._dt = _checks.positive(dt, "dt")

    @property
    def dt(self) -> float:
        """Set by set_dt; 0: not set."""
        return self._dt

    @property
    def time(self) -> float:
        """Sum of all substeps."""
        return self._core.time

    def step(self, dt: float | None = None) -> None:
        """One substep of length dt, or n substeps of the length given to set_dt::

        step(0.01)                      one substep
        step(0)                         relax(1)
        set_dt(0.01); step(); step(9)   1 and 9 substeps: whole numbers count once set_dt was called
        step()                          relax(1), while there is no dt
        """
        if dt is None:
            dt = 1 if self._dt > 0 else 0
        is_count = self._dt > 0 and hasattr(dt, "__index__") and np.ndim(dt) == 0
        count = _checks.integer(dt, "n", 0) if is_count else 1
        length = self._dt if is_count else _checks.non_negative(dt, "dt")
        if count == 0 or length == 0:
            self._core.relax(1)
            return
        for _ in range(count):
            self._core.step(length)
            self._grow(length)

    def get_carried_forces(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """What the contacts of the last substep hand on to the next one, for a run that goes on bit by bit:
        set it after the state of the particles.

        contacts: (n, 3), first and second body (second < 0: wall -1 - value) and number of the periodic image
        or, of walls, of the feature; forces: (n, 7), normal force, friction and normal (3 each) on the first
        body. Empty after a change of positions, and with elastic contacts, whose springs are not given here.
        """
        return self._core.carried_forces()

    def set_carried_forces(self, contacts: ArrayLike, forces: ArrayLike) -> None:
        """Take over what get_carried_forces returned."""
        self._core.set_carried_forces(contacts, forces)

    def relax(self, n: int = 1) -> None:
        """Push overlapping spheres apart, n times; velocities stay and time stands still."""
        for _ in range(_checks.integer(n, "n", 0)):
            self._core.relax(1)

    # Readback

    @property
    def num_particles(self) -> CallableInt:
        """Number of particles."""
        return CallableInt(self._core.count)

    @property
    def capacity(self) -> int:
        """Number of particles that there is room for."""
        return self._core.capacity

    @property
    def num_shapes(self) -> CallableInt:
        """1 once there is a shape."""
        return CallableInt(self._core.shape_radius > 0)

    @property
    def num_contacts(self) -> CallableInt:
        """Pairs of spheres, and spheres and walls, now closer than 0.1 radii (mean of the two)."""
        return CallableInt(self._core.census()[0])

    @property
    def num_manifolds(self) -> CallableInt:
        """The same: spheres have one point of contact."""
        return self.num_contacts

    @property
    def max_overlap(self) -> CallableFloat:
        """Largest overlap now, a length."""
        return CallableFloat(self._core.census()[1])

    @property
    def diagnostics(self) -> Diagnostics:
        """Contacts, energy, momentum and solver report."""
        return self._diagnostics
