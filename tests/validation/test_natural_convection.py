"""A square cavity heated from one side, against the benchmark solution of de Vahl Davis (1983), Pr = 0.71."""

import numpy as np
import pytest
from peclet import flow

from tests.validation.helpers import Row

PRANDTL = 0.71
# Ra: mean Nusselt number, largest velocities along x and y in units of diffusivity / side
BENCHMARK = {1e3: (1.118, 3.649, 3.697), 1e4: (2.243, 16.178, 19.617), 1e5: (4.519, 34.73, 68.59)}


def cavity(cells, rayleigh, *, change=1e-5):
    """Steady solver, in units of the side, the difference of temperature and the diffusivity."""
    solver = flow.Solver((cells, cells, 1), extent=(1, 1, 1 / cells))
    solver.set_rho(1)
    solver.set_mu(PRANDTL)
    solver.set_advection_scheme("koren")
    solver.set_advection(True)
    for face in ("-x", "+x", "-y", "+y"):
        solver.set_domain_bc(face, "wall")
    solver.add_scalar("t", 1.0)
    solver.set_scalar_bc("t", "-x", "dirichlet", 1.0)
    solver.set_scalar_bc("t", "+x", "dirichlet", 0.0)
    solver.set_boussinesq("t", rayleigh * PRANDTL, 0.5, (0, -1, 0))
    x = solver.cell_centers()[0]
    solver.set_field("t", np.broadcast_to(1 - x[:, None, None], (cells, cells, 1)))
    solver.set_dt(0.4 / cells / BENCHMARK[rayleigh][2])
    old = 0.0
    for _ in range(100):
        for _ in range(100):
            solver.step()
        hot, cold = nusselt(solver)
        if abs(hot - old) <= change * hot and abs(hot - cold) <= change * hot:
            return solver
        old = hot
    raise AssertionError("not steady")


def nusselt(solver):
    """Mean Nusselt number of the hot and of the cold wall: the faces' area is 1 / cells."""
    sides = solver.scalar_budget("t")["sides"] * solver.cells[0]
    return sides[0], -sides[1]


def check(cells, rayleigh, target, velocity_target):
    solver = cavity(cells, rayleigh)
    reference, *velocities = BENCHMARK[rayleigh]
    hot, cold = nusselt(solver)
    row = Row(f"Ra {rayleigh:g}, {cells} cells", reference, hot, hot / reference - 1, target)
    assert abs(row.error) <= row.target
    assert hot == pytest.approx(cold, rel=1e-5)
    # the benchmark gives the velocities on the two middle lines
    middle = cells // 2
    u = solver.get_u()[middle, :, 0].max()
    v = solver.get_v()[:, middle, 0].max()
    assert (u, v) == pytest.approx(velocities, rel=velocity_target)
    # the two halves of the cavity mirror each other
    t = solver.get_field("t")
    assert t + t[::-1, ::-1] == pytest.approx(np.ones_like(t), abs=1e-5)


def test_ra_1000():
    check(16, 1e3, 3e-3, 0.03)


def test_ra_10000():
    check(24, 1e4, 5e-3, 0.03)


@pytest.mark.slow
@pytest.mark.parametrize(("cells", "rayleigh"), [(40, 1e3), (40, 1e4), (64, 1e5)])
def test_nusselt_within_one_percent(cells, rayleigh):
    check(cells, rayleigh, 5e-3, 0.01)
