"""Drafting, kissing and tumbling of two spheres: the case, its run, and what is measured on it.

Physical quantities are in cm, g and s; the solvers work in cells and a unit of time of their own.
"""

from __future__ import annotations

import dataclasses
import math
import pathlib
import time as clock

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.coupling import Body, CoupledSimulation, PlaneSlice
from peclet.dem import Simulation
from peclet.flow import Solver

TANK = np.array([1.0, 4.0, 1.0])  # y points up
DIAMETER = 1 / 6
DENSITY, DENSITY_RATIO = 1.0, 1.14
VISCOSITY = 0.01
GRAVITY = 981.0
# Above the floor: the leader, body 0, and the follower, body 1, which is shifted sideways by OFFSET.
HEIGHTS = (3.16, 3.5)
OFFSET = 0.005 * DIAMETER
DURATION = 1960 * 3.28e-4

RESOLUTIONS = (6, 8, 12, 16)
CONTACTS = ("proper", "position-only")
SCHEMES = {"sou": 0, "koren": 1}
LEADER, FOLLOWER = 0, 1

# In units of the solver, and in s per cm of cell size: at 8.5 cm/s, five steps per cell at every resolution.
TIME_STEP = 3.75
STEP_PER_CELL_SIZE = 3.28e-4 / (DIAMETER / 12)
# Surfaces that lie on points of the grid would make the two sides of a body differ.
LATTICE_SHIFT = 0.3


@dataclasses.dataclass(frozen=True)
class Case:
    """The same physics on grids of `resolution` cells per diameter."""

    resolution: int = 8
    contact: str = "proper"
    scheme: str = "koren"
    added_mass: float | str = "auto"

    def __post_init__(self) -> None:
        for name, choices in (("resolution", RESOLUTIONS), ("contact", CONTACTS), ("scheme", tuple(SCHEMES))):
            value = getattr(self, name)
            if value not in choices:
                raise ValueError(f"{name}: expected one of {choices}, found {value!r}")

    # Units of the solver in cm and s.
    @property
    def cell_size(self) -> float:
        """In cm."""
        return DIAMETER / self.resolution

    @property
    def time_unit(self) -> float:
        """In s."""
        return STEP_PER_CELL_SIZE * self.cell_size / TIME_STEP

    @property
    def time_step(self) -> float:
        """In s."""
        return TIME_STEP * self.time_unit

    @property
    def number_of_steps(self) -> int:
        """Of the whole run."""
        return round(DURATION / self.time_step)

    # Quantities in units of the solver.
    @property
    def radius(self) -> float:
        """In cells."""
        return self.resolution / 2

    @property
    def tank(self) -> np.ndarray:
        """Inner size in cells."""
        return np.rint(TANK / self.cell_size).astype(int)

    @property
    def cells(self) -> np.ndarray:
        """Of the periodic box: the tank with a shell of at least six cells, in multiples of eight."""
        return -(-(self.tank + 12) // 8) * 8

    @property
    def center(self) -> np.ndarray:
        """Of the tank, in scene coordinates."""
        return self.cells / 2 + LATTICE_SHIFT

    @property
    def viscosity(self) -> float:
        """Kinematic, which is also the dynamic one: the density of the fluid is 1."""
        return VISCOSITY / DENSITY * self.time_unit / self.cell_size**2

    @property
    def gravity(self) -> float:
        """Acceleration downwards."""
        return GRAVITY * self.time_unit**2 / self.cell_size

    @property
    def start(self) -> np.ndarray:
        """Centres of the spheres in scene coordinates."""
        floor = self.center[1] - self.tank[1] / 2
        rows = [
            (self.center[0] + shift / self.cell_size, floor + height / self.cell_size, self.center[2])
            for height, shift in zip(HEIGHTS, (0.0, OFFSET), strict=True)
        ]
        return np.array(rows)


def make_flow(case: Case) -> Solver:
    """Fluid at rest in a tank: a slab with a cavity, in a periodic box, and two spheres."""
    builder = SceneBuilder()
    slab = builder.add_leaf("box", (case.cells / 2 + 1).tolist())
    cavity = builder.add_leaf("box", (case.tank / 2).tolist())
    tank = builder.add_difference(slab, cavity)
    sphere = builder.add_leaf("sphere", [case.radius])
    builder.add_instance(tank, translation=case.center.tolist())
    for center in case.start:
        builder.add_instance(sphere, translation=center.tolist())

    flow = Solver(*(int(n) for n in case.cells))
    flow.set_advection(True)
    flow.set_advection_scheme(SCHEMES[case.scheme])
    flow.set_scene(*builder.encode(), periodic=True)
    flow.set_solid_from_scene()
    if flow.periodic_image_overlap_cells() != 0:
        raise RuntimeError("the images of the tank reach into its cavity")
    return flow


def make_contacts(case: Case) -> Simulation:
    """Two inelastic, frictionless spheres in the same tank."""
    contacts = Simulation(2)
    contacts.set_sphere_shape(case.radius)
    contacts.set_positions(case.start)
    for axis in range(3):
        for side in (-1, 1):
            point, normal = case.center.copy(), np.zeros(3)
            point[axis] += side * case.tank[axis] / 2
            normal[axis] = -side
            contacts.add_plane(tuple(point.tolist()), tuple(normal.tolist()))
    if case.contact == "position-only":
        contacts.set_solver_iterations(10, 0)
    return contacts


def make_simulation(case: Case) -> CoupledSimulation:
    """The coupled run, before its first step."""
    spheres = [Body.sphere(1 + n, radius=case.radius, density=DENSITY_RATIO) for n in (LEADER, FOLLOWER)]
    return CoupledSimulation(
        make_flow(case),
        make_contacts(case),
        spheres,
        time_step=TIME_STEP,
        viscosity=case.viscosity,
        gravity=(0.0, -case.gravity, 0.0),
        added_mass=case.added_mass,
    )


@dataclasses.dataclass(frozen=True)
class Result:
    """Motion in cm and s, one row per step; the second index is the sphere (LEADER, FOLLOWER)."""

    case: Case
    time: np.ndarray
    position: np.ndarray  # from the middle of the floor
    velocity: np.ndarray
    angular_velocity: np.ndarray
    contact_momentum: np.ndarray  # given by contacts during the step, in g cm/s
    frames: tuple[PlaneSlice, ...]  # in cm and s too, heights above the floor
    seconds_per_step: float
    is_interrupted: bool = False

    @property
    def fall_speed(self) -> np.ndarray:
        """Downwards, of each sphere."""
        return -self.velocity[:, :, 1]

    @property
    def line_of_centers(self) -> np.ndarray:
        """Unit vectors from the follower to the leader."""
        line = self.position[:, LEADER] - self.position[:, FOLLOWER]
        return line / np.linalg.norm(line, axis=1, keepdims=True)

    @property
    def gap(self) -> np.ndarray:
        """Between the surfaces, in diameters; negative where they overlap."""
        line = self.position[:, LEADER] - self.position[:, FOLLOWER]
        return np.linalg.norm(line, axis=1) / DIAMETER - 1

    @property
    def lateral_separation(self) -> np.ndarray:
        """Horizontal distance of the centres, in diameters."""
        line = self.position[:, LEADER] - self.position[:, FOLLOWER]
        return np.hypot(line[:, 0], line[:, 2]) / DIAMETER

    @property
    def speed_along_line(self) -> np.ndarray:
        """Of each sphere, along the line of centres."""
        return np.einsum("tbi,ti->tb", self.velocity, self.line_of_centers)

    def write_csv(self, path: pathlib.Path) -> None:
        """Time, then position, velocity and angular velocity of leader and follower."""
        kinds = {"position_cm": self.position, "velocity_cm_per_s": self.velocity}
        kinds["angular_velocity_per_s"] = self.angular_velocity
        names = ["time_s"] + [
            f"{body}_{kind}_{axis}" for kind in kinds for body in ("leader", "follower") for axis in "xyz"
        ]
        columns = [self.time[:, None]] + [rows.reshape(len(rows), -1) for rows in kinds.values()]
        np.savetxt(path, np.hstack(columns), delimiter=",", header=",".join(names), comments="", fmt="%.9g")


def run(case: Case, steps: int | None = None, *, frames: int = 48, progress: bool = True) -> Result:
    """Simulate; Ctrl-C ends the run early. Slices are kept about `frames` times."""
    simulation = make_simulation(case)
    steps = case.number_of_steps if steps is None else steps
    interval = max(1, steps // frames)
    kept: list[PlaneSlice] = []

    def keep_slice(simulation: CoupledSimulation, always: bool = False) -> None:
        if always or simulation.number_of_steps % interval == 0 or simulation.number_of_steps == steps:
            kept.append(take_frame(case, simulation))

    is_interrupted = False
    begin = clock.perf_counter()
    try:
        simulation.run(steps, progress=progress, callback=keep_slice)
    except KeyboardInterrupt:
        is_interrupted = True
        print(f"\nStopped after {simulation.number_of_steps} of {steps} steps.")
    elapsed = clock.perf_counter() - begin
    if not kept:
        keep_slice(simulation, always=True)
    result = collect(case, simulation, kept, elapsed / max(1, simulation.number_of_steps))
    return dataclasses.replace(result, is_interrupted=is_interrupted)


WINDOW = (1.0, 1.8)  # width and height of a frame in cm


def take_frame(case: Case, simulation: CoupledSimulation) -> PlaneSlice:
    """The vertical plane through both centres, or across z while these are one above the other."""
    leader, follower = simulation.body_state()["position"]
    across = (leader - follower) * (1, 0, 1)
    if np.linalg.norm(across) < 0.1 * case.resolution:
        across = np.array([1.0, 0.0, 0.0])
    center = (leader + follower) / 2
    floor = case.center[1] - case.tank[1] / 2
    size = np.array(WINDOW) / case.cell_size
    # a little more above the spheres than below
    low = np.clip(center[1] - 0.35 * size[1], floor, floor + case.tank[1] - size[1])
    a = np.linspace(-0.5, 0.5, 2 * int(size[0]) + 1) * size[0]
    b = np.linspace(0, 1, 2 * int(size[1]) + 1) * size[1] + low
    return simulation.sample_plane((center[0], 0, center[2]), (across, (0, 1, 0)), a, b)


def collect(case: Case, simulation: CoupledSimulation, frames: list[PlaneSlice], seconds: float) -> Result:
    """From units of the solver to cm, g and s."""
    history = simulation.history
    floor = case.center - np.array([0, case.tank[1] / 2, 0])
    speed = case.cell_size / case.time_unit

    def scaled(frame: PlaneSlice) -> PlaneSlice:
        return dataclasses.replace(
            frame,
            a=frame.a * case.cell_size,
            b=(frame.b - floor[1]) * case.cell_size,
            distance=frame.distance * case.cell_size,
            velocity_a=frame.velocity_a * speed,
            velocity_b=frame.velocity_b * speed,
            speed=frame.speed * speed,
            vorticity=frame.vorticity / case.time_unit,
            time=frame.time * case.time_unit,
        )

    return Result(
        case=case,
        time=history["time"] * case.time_unit,
        position=(history["position"] - floor) * case.cell_size,
        velocity=history["velocity"] * speed,
        angular_velocity=history["angular_velocity"] / case.time_unit,
        contact_momentum=history["contact_impulse"] * DENSITY * case.cell_size**3 * speed,
        frames=tuple(map(scaled, frames)),
        seconds_per_step=seconds,
    )


# What the two spheres do. A gap of a thousandth of a diameter counts as contact: spheres kept apart by
# impulses approach zero from above. One is "faster" from 5 % on.
TOUCH = 1e-3
NO_IMPULSE = 1e-6  # of a contact, relative to the momentum of a sphere
FASTER = 1.05
SIDE_BY_SIDE = 0.8


def first_time(result: Result, condition: np.ndarray) -> float:
    """Time at which the condition is first met; NaN if it never is."""
    return float(result.time[int(np.argmax(condition))]) if condition.any() else math.nan


def wall_distance(result: Result) -> np.ndarray:
    """Of each sphere's surface from the nearest wall, in diameters."""
    low = result.position + np.array([TANK[0] / 2, 0, TANK[2] / 2])
    return np.minimum(low, TANK - low).min(axis=2) / DIAMETER - 0.5


@dataclasses.dataclass(frozen=True)
class Measures:
    """Times in s, speeds in cm/s; NaN for what did not happen."""

    drafting: float
    contact: float
    side_by_side: float
    peak_leader: float
    peak_follower: float
    largest_overlap: float  # in diameters
    speeds_before_touch: tuple[float, float]  # along the line of centres, leader and follower
    speeds_after_touch: tuple[float, float]
    momentum_error: float  # sum of the contact impulses over both spheres, over the momentum of one of them


def measure(result: Result) -> Measures:
    """The numbers that the literature and the reference give."""
    touching = result.gap <= TOUCH
    contact = int(np.argmax(touching)) if touching.any() else None
    approach = np.arange(len(result.time)) < (len(result.time) if contact is None else contact)
    faster = result.fall_speed[:, FOLLOWER] > FASTER * result.fall_speed[:, LEADER]
    nothing = (math.nan, math.nan)
    before, after = nothing, nothing
    momentum = DENSITY_RATIO * DENSITY * math.pi / 6 * DIAMETER**3 * np.abs(result.velocity).max()
    if contact is not None:
        # the impulse may come a step after the gap is counted as closed; position-only contact has none
        pushed = np.abs(result.contact_momentum).max(axis=(1, 2)) > NO_IMPULSE * momentum
        touch = contact + int(np.argmax(pushed[contact:]))
        along = result.speed_along_line
        before, after = tuple(along[touch - 1].tolist()), tuple(along[touch].tolist())
    impulse = result.contact_momentum[touching & (wall_distance(result) > 0.01).all(axis=1)]
    return Measures(
        drafting=first_time(result, faster & approach & (result.time > 0)),
        contact=math.nan if contact is None else float(result.time[contact]),
        side_by_side=first_time(result, (result.lateral_separation >= SIDE_BY_SIDE) & ~approach),
        peak_leader=float(result.fall_speed[:, LEADER].max()),
        peak_follower=float(result.fall_speed[:, FOLLOWER].max()),
        largest_overlap=float(max(0.0, -result.gap.min())),
        speeds_before_touch=before,
        speeds_after_touch=after,
        momentum_error=float(np.abs(impulse.sum(axis=1)).max(initial=0) / momentum),
    )
