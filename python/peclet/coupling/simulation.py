"""The coupled loop: the fluid moves the bodies, the bodies touch, and move the fluid."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from peclet import _checks
from peclet.coupling import checkpoint, slices
from peclet.coupling.bodies import Body, fluid_inertia
from peclet.coupling.history import History
from peclet.coupling.interrupt import between_steps
from peclet.coupling.prediction import Prediction
from peclet.coupling.rotation import from_body_axes, to_body_axes
from peclet.coupling.state import contact_state, require_valid, restore

Vectors = NDArray[np.float64]
_AXES = ("x", "y", "z")
_MOTION = ("positions", "quaternions", "velocities", "angular_velocities")
# Smaller changes of the momentum of a body are rounding, not contact.
_ROUNDING = 1e-9


class CoupledSimulation:
    """Rigid bodies in a fluid: one object to run, save, restart and plot.

    flow is a peclet.flow.Solver whose scene holds the bodies (and what stands still), contacts is a
    peclet.dem.Simulation with one particle per body, in the order of bodies, in the units and coordinates
    of the flow. Positions, velocities and orientations of the particles are the initial state. The
    properties of the fluid, the masses of the particles and all poses in the flow are set here.

    One step of length dt: the fluid goes on with the bodies at their present pose and with the velocity
    v + dt/2 a_p that they are predicted to have in the middle of the step, returns force and torque, and the
    bodies go on in substeps with these loads frozen; a_p: see Prediction. An explicit exchange would be
    unstable for bodies that are light beside the fluid they set in motion [CausinGerbeauNobile2005], so what
    the reaction changes by where the new acceleration a differs from the one that the fluid has felt, a_f,
    and from a_p is implicit [SchwarzKempeFroehlich2015]:

        m a = F + (m - rho V) g - m_a (a - a_f) - m_d (a - a_p / 2)

    with added mass m_a and damping m_d estimated from the size, or m_a = added_mass rho V and m_d = 0. Only
    half of a_p counts as felt by the drag, since the fluid around the body follows half a step later.
    Rotations do the same with nothing predicted, a_p = 0. Contacts act on the masses m alone, after that,
    and conserve momentum; a_f is without them, so that the velocity lost in an impact is not handed back in
    the next step.
    """

    def __init__(
        self,
        flow: Any,
        contacts: Any,
        bodies: Sequence[Body],
        *,
        time_step: float,
        viscosity: float,
        density: float = 1.0,
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
        substeps: int = 10,
        added_mass: float | str = "auto",
    ) -> None:
        self._bodies = tuple(bodies)
        for n, body in enumerate(self._bodies):
            if not isinstance(body, Body):
                raise _checks.wrong_type(f"bodies[{n}]", "a peclet.coupling.Body", body)
        self._time_step = _checks.positive(time_step, "time_step")
        density = _checks.positive(density, "density")
        viscosity = _checks.non_negative(viscosity, "viscosity")
        self._substeps = _checks.integer(substeps, "substeps", low=1)
        self._require_matching(flow, contacts)
        self._flow, self._contacts = flow, contacts

        self._instances = [body.instance for body in self._bodies]
        self._mass = np.array([[body.mass] for body in self._bodies])
        self._inertia = np.array([body.inertia for body in self._bodies])
        volume = np.array([[body.volume] for body in self._bodies])
        self._weight = (self._mass - density * volume) * np.array(_checks.vector(gravity, "gravity"))
        coefficient = None if added_mass == "auto" else _checks.non_negative(added_mass, "added_mass")
        self._fluid = fluid_inertia(self._bodies, density, viscosity, self._time_step, coefficient)
        self._resistance = self._mass + (self._fluid.added_mass + self._fluid.damping)[:, None]
        self._motion = Prediction(self._weight / self._resistance)
        self._angular_acceleration = np.zeros((len(self._bodies), 3))

        flow.set_rho(density)
        flow.set_mu(viscosity)
        flow.set_dt(self._time_step)
        flow.set_prescribed_motion(False)
        self._set_masses()
        self._time, self._number_of_steps = 0.0, 0
        self._history = History({"time": 0.0} | self.body_state())
        self._place_bodies()

    def _require_matching(self, flow: Any, contacts: Any) -> None:
        instances = [body.instance for body in self._bodies]
        if not instances or len(set(instances)) < len(instances):
            raise ValueError(
                f"bodies: expected at least one, each with its own instance, found instances {instances}"
            )
        available = flow.scene_instance_count()
        if max(instances) >= available:
            raise ValueError(
                f"bodies: expected instances below {available}, the number in the scene of the flow, "
                f"found {max(instances)}"
            )
        count = contacts.num_particles()
        if count != len(instances):
            raise ValueError(f"contacts: expected {len(instances)} particles, one per body, found {count}")

    def _require_unchanged(self) -> None:
        if self._flow.dt != self._time_step:
            raise RuntimeError(
                f"step(): expected flow.dt to stay at the time step of the simulation, {self._time_step:g}, "
                f"found {self._flow.dt:g}"
            )
        count = self._contacts.num_particles()
        if count != len(self._bodies):
            raise RuntimeError(f"step(): expected {len(self._bodies)} particles, one per body, found {count}")

    flow = property(lambda self: self._flow, doc="The flow solver.")
    contacts = property(lambda self: self._contacts, doc="The contact simulation.")
    bodies = property(lambda self: self._bodies, doc="The bodies that the fluid moves.")
    time = property(lambda self: self._time, doc="Time since the initial state.")
    time_step = property(lambda self: self._time_step, doc="Length of one step.")
    number_of_steps = property(lambda self: self._number_of_steps, doc="Steps since the initial state.")

    @property
    def history(self) -> dict[str, NDArray[np.float64]]:
        """Arrays with one row per step, from the initial state on; the second index is the body.

        time; position, velocity, angular_velocity and orientation of the bodies; force and torque of the
        fluid on them and contact_impulse during the step that led there.
        """
        return self._history.arrays()

    def step(self) -> None:
        """Advance fluid and bodies by one time step.

        Raises RuntimeError if flow.dt or the number of particles differs from that of the simulation.
        """
        self._require_unchanged()
        self._place_bodies(ahead=True)
        self._flow.rebuild_geometry()
        self._flow.step()
        force, torque = np.asarray(self._flow.hydro_force_torque_reaction())[:, self._instances]
        acceleration = self._acceleration(force)
        applied = self._mass * acceleration
        self._contacts.set_external_forces(applied)
        self._contacts.set_external_torques(self._accelerate_rotation(torque))
        before = self._contacts.get_velocities()
        for _ in range(self._substeps):
            self._contacts.step(self._time_step / self._substeps)
        bodies = self.body_state()
        impulse = self._mass * (bodies["velocity"] - before) - applied * self._time_step
        momentum = self._mass * (np.abs(before) + np.abs(bodies["velocity"]))
        touched = np.abs(impulse).max(axis=1) > _ROUNDING * momentum.max(axis=1)
        self._motion.advance(acceleration, touched)
        self._number_of_steps += 1
        self._time = self._number_of_steps * self._time_step
        loads = {"force": force, "torque": torque, "contact_impulse": impulse}
        self._history.append({"time": self._time} | bodies | loads)

    def run(
        self,
        steps: int | None = None,
        *,
        time: float | None = None,
        progress: bool = True,
        callback: Callable[[CoupledSimulation], object] | None = None,
    ) -> None:
        """Advance by so many steps, or until the given time is reached.

        callback(simulation) is called after every step; when it returns True, the run ends. Ctrl-C ends
        the run after the step under way and raises KeyboardInterrupt; the simulation can go on from there.
        """
        if (steps is None) == (time is None):
            raise ValueError(f"run(): expected either steps or time, found steps={steps!r} and time={time!r}")
        if steps is None:
            remaining = (_checks.finite(time, "time") - self._time) / self._time_step
            steps = max(0, int(np.ceil(remaining - 1e-9)))
        steps = _checks.integer(steps, "steps", low=0)
        with between_steps(steps, progress) as passes:
            for _ in passes:
                self.step()
                if callback is not None and callback(self) is True:
                    break

    def save(self, path: str | pathlib.Path) -> None:
        """Write everything that the run needs to go on: .npz, or .h5 with h5py (extra "io")."""
        checkpoint.write(path, self.state())

    def restart(self, path: str | pathlib.Path) -> None:
        """Go on from a file that `save` wrote.

        The simulation must have been set up by the same calls as the one that was saved; it then goes on bit
        by bit, for the same number of threads.
        """
        self.set_state(checkpoint.read(path))

    def state(self) -> dict[str, NDArray[Any]]:
        """What `save` writes."""
        own = {
            "time": np.array(self._time),
            "number_of_steps": np.array(self._number_of_steps),
            "angular_acceleration": self._angular_acceleration.copy(),
        }
        own |= self._motion.state()
        return checkpoint.join(
            {
                "flow": self._flow.checkpoint(),
                "contacts": contact_state(self._contacts),
                "coupling": own,
                "history": self._history.arrays(),
            }
        )

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Take over what `state` returned; on error nothing has changed."""
        parts = checkpoint.split(state, ("flow", "contacts", "coupling", "history"))
        own = parts["coupling"]
        checkpoint.require_shapes(own, self._own_shapes(), "coupling")
        history = History.from_arrays(parts["history"], len(self._bodies))
        require_valid(self._flow, parts["flow"], self._contacts, parts["contacts"])
        restore(self._flow, parts["flow"], self._contacts, parts["contacts"])
        self._set_masses()
        self._time, self._number_of_steps = float(own["time"]), int(own["number_of_steps"])
        self._motion.set_state(own)
        self._angular_acceleration = own["angular_acceleration"].copy()
        self._history = history

    def _own_shapes(self) -> dict[str, tuple[int, ...]]:
        vectors = ("angular_acceleration", *self._motion.state())
        return {"time": (), "number_of_steps": ()} | dict.fromkeys(vectors, (len(self._bodies), 3))

    def plot(self, axis: str = "y") -> Any:
        """Position and velocity of all bodies along one axis over time, as a matplotlib figure."""
        return slices.plot_motion(self.history, _checks.choice(axis, "axis", _AXES))

    def plot_slice(self, normal: str = "z", position: float | None = None, *, show: str = "vorticity") -> Any:
        """The flow in a plane (by default through the first body), as a matplotlib figure.

        show: "vorticity" (along the normal) or "speed".
        """
        show = _checks.choice(show, "show", ("vorticity", "speed"))
        plane = self.take_slice(normal, position)
        n = _AXES.index(normal)
        return slices.plot_plane(plane, (_AXES[(n + 1) % 3], _AXES[(n + 2) % 3]), show)

    def take_slice(self, normal: str = "z", position: float | None = None) -> slices.PlaneSlice:
        """The flow in a plane across an axis (by default through the first body) as arrays."""
        n = _AXES.index(_checks.choice(normal, "normal", _AXES))
        if position is None:
            position = float(self._contacts.get_positions()[0][n])
        return slices.take(self, n, _checks.finite(position, "position"))

    def sample_plane(
        self, center: Sequence[float], directions: Sequence[Sequence[float]], a: ArrayLike, b: ArrayLike
    ) -> slices.PlaneSlice:
        """The flow at the points center + a directions[0] + b directions[1], by linear interpolation.

        directions: two orthogonal vectors, made unit vectors; a, b: ascending coordinates along them.
        """
        axes = np.array([_checks.vector(row, f"directions[{n}]") for n, row in enumerate(directions)])
        lengths = np.linalg.norm(axes, axis=-1)
        if axes.shape != (2, 3) or not lengths.all() or abs(axes[0] @ axes[1]) > 1e-9 * lengths.prod():
            raise _checks.wrong_value("directions", "two orthogonal vectors", directions)
        coordinates = [np.array(values, dtype=np.float64) for values in (a, b)]
        for name, values in zip("ab", coordinates, strict=True):
            if values.ndim != 1 or len(values) == 0 or not (np.diff(values) > 0).all():
                raise _checks.wrong_value(name, "ascending coordinates", values)
        unit = axes / lengths[:, None]
        return slices.sample(self, np.array(_checks.vector(center, "center")), unit, *coordinates)

    def body_state(self) -> dict[str, Vectors]:
        """Position, velocity, angular velocity and orientation of the bodies as they are now."""
        return {
            "position": self._contacts.get_positions(),
            "velocity": self._contacts.get_velocities(),
            "angular_velocity": self._contacts.get_angular_velocities(),
            "orientation": self._contacts.get_quaternions(),
        }

    def _set_masses(self) -> None:
        self._contacts.set_inv_mass(1 / self._mass[:, 0])
        self._contacts.set_inv_inertia(1 / self._inertia)

    def _place_bodies(self, *, ahead: bool = False) -> None:
        """Pose and velocity of the particles go to the flow; ahead: predicted for the middle of the step."""
        positions, orientations, velocities, spins = (
            getattr(self._contacts, f"get_{name}")() for name in _MOTION
        )
        if ahead:
            velocities = velocities + self._motion.lead(self._time_step)
        for instance, x, q, v, w in zip(
            self._instances, positions, orientations, velocities, spins, strict=True
        ):
            self._flow.set_instance_transform(instance, x, q)
            self._flow.set_instance_motion(instance, v, w)

    def _acceleration(self, force: Vectors) -> Vectors:
        """Acceleration of the bodies within the fluid, without contacts."""
        added, damping = self._fluid.added_mass[:, None], self._fluid.damping[:, None]
        total = force + self._weight + added * self._motion.felt + 0.5 * damping * self._motion.predicted
        return total / self._resistance

    def _accelerate_rotation(self, torque: Vectors) -> Vectors:
        """The torque that gives bodies without fluid the angular acceleration that they have within it.

        Euler's equation I dw/dt + w x I w = T along the axes of the body, nothing predicted.
        """
        added, damping = self._fluid.added_inertia, self._fluid.rotational_damping[:, None]
        orientation = self._contacts.get_quaternions()
        felt = to_body_axes(orientation, self._angular_acceleration)
        w = to_body_axes(orientation, self._contacts.get_angular_velocities())
        gyroscopic = np.cross(w, self._inertia * w)
        total = to_body_axes(orientation, torque) + added * felt - gyroscopic
        acceleration = total / (self._inertia + added + damping)
        self._angular_acceleration = from_body_axes(orientation, acceleration)
        return from_body_axes(orientation, self._inertia * acceleration + gyroscopic)
