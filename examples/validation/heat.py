"""Heat: conduction between spheres, and a cavity heated from one side."""

from __future__ import annotations

import dataclasses

import numpy as np
from peclet.core.geom import SceneBuilder
from peclet.flow import Solver

from examples.validation.results import Row, published

PRANDTL = 0.71
# A spherical shell of fluid between a small body and the inside of a hollow solid, off the lattice.
INNER, OUTER = 0.2, 0.45
CENTER = np.array([0.513, 0.521, 0.483])


@dataclasses.dataclass(frozen=True)
class Shell:
    """Steady conduction with unit diffusivity; amounts per time are into the fluid."""

    values: np.ndarray  # of the fluid cells
    radius: np.ndarray  # of their centres
    inner_flux: float
    outer_flux: float

    def difference(self, exact: np.ndarray) -> np.ndarray:
        """Error of the fluid cells."""
        return self.values - exact


def conduct(cells: int, inner: tuple[str, float], outer: tuple[str, float]) -> Shell:
    """Conditions (type, value) on the sphere and on the hollow wall around it."""
    solver = Solver((cells, cells, cells), extent=(1, 1, 1))
    x, y, z = solver.cell_centers()
    squares = np.add.outer(np.add.outer((x - CENTER[0]) ** 2, (y - CENTER[1]) ** 2), (z - CENTER[2]) ** 2)
    radius = np.sqrt(squares)
    scene = SceneBuilder()
    scene.add_instance(scene.add_leaf("sphere", [INNER]), translation=list(CENTER))
    solver.set_scene(*scene.encode())
    solver.set_solid(OUTER - radius)
    solver.add_scalar("temperature", 1.0, iters=5000)
    solver.set_scalar_wall("temperature", *outer)
    solver.set_scalar_wall("temperature", *inner, instance=0)
    solver.set_dt(0.05)
    old = solver.get_field("temperature")
    for _ in range(300):
        solver.advance_scalars()
        new = solver.get_field("temperature")
        if np.abs(new - old).max() < 1e-6:
            break
        old = new
    else:
        raise RuntimeError("the temperature is not steady")
    fluid = (radius > INNER) & (radius < OUTER)
    budget = solver.scalar_budget("temperature")
    return Shell(new[fluid], radius[fluid], float(budget["bodies"][0]), budget["sampled"])


def hot_sphere(cells: int) -> Shell:
    """Temperature 1 on the sphere, 0 around."""
    return conduct(cells, ("dirichlet", 1.0), ("dirichlet", 0.0))


def hot_sphere_exact(radius: np.ndarray) -> np.ndarray:
    """Temperature between the spheres."""
    return (1 / radius - 1 / OUTER) / (1 / INNER - 1 / OUTER)


def sphere_rows(cells: int, target: float) -> list[Row]:
    """Conduction Nusselt number Q / (pi d D dT) = 2 / (1 - a / b) of the inner sphere."""
    found = hot_sphere(cells).inner_flux / (2 * np.pi * INNER)
    return [Row("heated sphere, conduction", f"Nu, {cells} cells", 2 / (1 - INNER / OUTER), found, target)]


def heated_cavity(cells: int, rayleigh: int) -> Solver:
    """Steady flow in units of the side, the difference of temperature and the diffusivity."""
    solver = Solver((cells, cells, 1), extent=(1, 1, 1 / cells))
    solver.set_rho(1)
    solver.set_mu(PRANDTL)
    solver.set_advection_scheme("koren")
    solver.set_advection(True)
    for face in ("-x", "+x", "-y", "+y"):
        solver.set_domain_bc(face, "wall")
    solver.add_scalar("temperature", 1.0)
    solver.set_scalar_bc("temperature", "-x", "dirichlet", 1.0)
    solver.set_scalar_bc("temperature", "+x", "dirichlet", 0.0)
    solver.set_boussinesq("temperature", rayleigh * PRANDTL, 0.5, (0, -1, 0))
    x = solver.cell_centers()[0]
    solver.set_field("temperature", np.broadcast_to(1 - x[:, None, None], (cells, cells, 1)))
    solver.set_dt(0.22 / cells / benchmark(rayleigh, "v_max"))
    old = 0.0
    for _ in range(100):
        for _ in range(100):
            solver.step()
        hot, cold = nusselt_numbers(solver)
        if abs(hot - old) <= 1e-5 * hot and abs(hot - cold) <= 1e-5 * hot:
            return solver
        old = hot
    raise RuntimeError("the flow is not steady")


def nusselt_numbers(solver: Solver) -> tuple[float, float]:
    """Means of the hot and of the cold wall, whose area is 1 / cells."""
    sides = solver.scalar_budget("temperature")["sides"] * solver.cells[0]
    return float(sides[0]), -float(sides[1])


def benchmark(rayleigh: int, quantity: str) -> float:
    """The published value."""
    for line in published("heated_cavity", Ra=str(rayleigh), quantity=quantity):
        return float(line["value"])
    raise KeyError(f"{rayleigh}: {quantity}")


def cavity_rows(cells: int, rayleigh: int, target: float, velocity_target: float) -> list[Row]:
    """Nusselt number, and largest velocities on the two middle lines."""
    solver = heated_cavity(cells, rayleigh)
    middle = cells // 2
    found = {
        "Nu": (nusselt_numbers(solver)[0], target),
        "u_max": (solver.get_u()[middle, :, 0].max(), velocity_target),
        "v_max": (solver.get_v()[:, middle, 0].max(), velocity_target),
    }
    case = f"heated cavity, Ra {rayleigh}"
    return [
        Row(case, f"{name}, {cells} cells", benchmark(rayleigh, name), float(value), bound)
        for name, (value, bound) in found.items()
    ]
