"""A sphere that settles in a closed box of silicon oil: experiments of ten Cate et al., in SI units."""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.coupling import Body, CoupledSimulation
from peclet.dem import Simulation
from peclet.flow import Solver

from examples.validation.results import published

GRAVITY = 9.81


@dataclasses.dataclass(frozen=True)
class Experiment:
    """One of the four fluids; speeds over u_inf, that of a sphere in unbounded fluid [TenCateEtAl2002]."""

    name: str
    density: float
    viscosity: float
    sphere_density: float
    diameter: float
    unbounded_speed: float
    measured: float
    simulated: float
    box: tuple[float, float, float] = (0.10, 0.10, 0.16)
    release: float = 0.1275

    @classmethod
    def named(cls, name: str) -> Experiment:
        """From the table."""
        (row,) = published("ten_cate", case=name)
        columns = (
            "rho_f_kg_m3",
            "mu_f_Pa_s",
            "rho_p_kg_m3",
            "d_m",
            "u_inf_m_s",
            "u_max_over_u_inf_exp",
            "u_max_over_u_inf_LBM_of_paper",
        )
        return cls(name, *(float(row[column]) for column in columns))


@dataclasses.dataclass(frozen=True)
class Settling:
    """Time in s, gap to the floor in diameters, speed downwards over u_inf."""

    experiment: Experiment
    time: np.ndarray
    gap: np.ndarray
    speed: np.ndarray


def run(name: str, resolution: int, *, courant: float = 0.25, scheme: str = "koren") -> Settling:
    """From release until the speed has fallen to 95 % of its peak."""
    case = Experiment.named(name)
    h = case.diameter / resolution
    cells = tuple(round(length / h) for length in case.box)
    start = (case.box[0] / 2, case.box[1] / 2, case.release)

    flow = Solver(cells, extent=case.box)
    for side in ("-x", "+x", "-y", "+y", "-z", "+z"):
        flow.set_domain_bc(side, "wall")
    scene = SceneBuilder()
    scene.add_instance(scene.add_leaf("sphere", [case.diameter / 2]), translation=list(start))
    flow.set_advection_scheme(scheme)
    flow.set_advection(True)
    flow.set_scene(*scene.encode())
    flow.set_solid_from_scene()

    contacts = Simulation(1)
    contacts.set_sphere_shape(case.diameter / 2)
    contacts.set_positions([start])
    contacts.add_plane((0, 0, 0), (0, 0, 1))
    simulation = CoupledSimulation(
        flow,
        contacts,
        [Body.sphere(0, radius=case.diameter / 2, density=case.sphere_density)],
        time_step=courant * h / case.unbounded_speed,
        viscosity=case.viscosity,
        density=case.density,
        gravity=(0, 0, -GRAVITY),
    )

    def is_past_its_peak(simulation: CoupledSimulation) -> bool:
        speed = -simulation.history["velocity"][:, 0, 2]
        return bool(speed[-1] < 0.95 * speed.max())

    simulation.run(time=10, progress=False, callback=is_past_its_peak)
    history = simulation.history
    return Settling(
        case,
        time=history["time"],
        gap=history["position"][:, 0, 2] / case.diameter - 0.5,
        speed=-history["velocity"][:, 0, 2] / case.unbounded_speed,
    )
