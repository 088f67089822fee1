"""Scripts written for either generation of calls run, and give the same numbers to the last bit."""

import numpy as np
import pytest
from peclet import flow
from peclet.core import geom

from tests.python.flow_scenes import assert_same_flow, spheres
from tests.same import assert_same

SHAPE = (12, 10, 14)
BODIES = ((5.3, 4.1, 6.2), 2.4), ((10.1, 8.2, 12.4), 1.7)


def first_generation(scheme):
    solver = flow.Solver(*SHAPE)
    solver.set_rho(1.2)
    solver.set_mu(0.07)
    solver.set_dt(0.8)
    solver.set_advection(True)
    solver.set_advection_scheme(scheme)
    solver.set_velocity_solver_params(60)
    solver.set_pressure_solver_params(100)
    solver.set_pressure_multigrid(True, 4)
    solver.set_pressure_pcg(True)
    solver.set_body_force(1e-3, 0.0, 2e-3)
    solver.set_scene(*spheres(*BODIES), periodic=True)
    solver.set_solid_from_scene(cutcell_pressure=True)
    solver.set_instance_motion(1, [0.0, 0.05, 0.0], [0.01, 0.0, 0.0])
    assert solver.scene_instance_count() == 2
    for n in range(3):
        solver.set_instance_transform(1, [10.1, 8.2 + 0.04 * (n + 1), 12.4], [0.0, 0.0, 0.0, 1.0])
        solver.rebuild_geometry()
        solver.step()
    return solver, solver.hydro_force_torque_reaction()


def second_generation(scheme):
    solver = flow.Solver(SHAPE, extent=SHAPE, origin=(-0.5, -0.5, -0.5))
    solver.density, solver.viscosity, solver.dt = 1.2, 0.07, 0.8
    solver.set_advection_scheme(scheme)
    solver.set_advection(True)
    solver.diagnostics.set_velocity_solver_params(60)
    solver.set_pressure_solver_params(100)
    solver.set_pressure_pcg(True, max_iter=200, rtol=1e-8)
    solver.set_body_force([1e-3, 0.0, 2e-3])
    builder = geom.SceneBuilder()
    roots = [builder.add_leaf("sphere", [radius]) for _, radius in BODIES]
    for root, (center, _) in zip(roots, BODIES, strict=True):
        builder.add_instance(root, translation=list(center))
    solver.set_scene(*builder.encode(), periodic=True)
    solver.set_solid_from_scene()
    solver.set_instance_motion(1, lin_vel=(0.0, 0.05, 0.0), ang_vel=(0.01, 0.0, 0.0))
    assert solver.num_scene_instances() == 2
    for n in range(3):
        solver.set_instance_transform(1, translation=(10.1, 8.2 + 0.04 * (n + 1), 12.4))
        solver.step()  # samples the moved body by itself
    return solver, solver.hydro_force_torque_reaction()


@pytest.mark.parametrize(("code", "name"), [(0, "sou"), (1, "koren")])
def test_both_generations_agree(code, name):
    first, first_force = first_generation(code)
    second, second_force = second_generation(name)
    assert_same_flow(first, second)
    assert_same(first_force, second_force)
    assert first.periodic_image_overlap_cells() == second.diagnostics.periodic_image_overlap_cells()
    assert first.last_pressure_iterations() == second.diagnostics.last_pressure_iterations()
    assert first.last_momentum_residual() == second.diagnostics.last_momentum_residual()


def test_schemes_by_name_number_and_enumerator_are_the_same():
    solver = flow.Solver(6, 6, 6)
    assert solver.advection_scheme is None
    solver.set_advection(True)
    assert solver.advection_scheme == "sou"
    for given, name in (
        (1, "koren"),
        (np.int64(0), "sou"),
        ("central", "central"),
        (flow.AdvectionScheme.KOREN, "koren"),
        (flow.AdvectionScheme.SECOND_UPWIND, "sou"),
    ):
        solver.set_advection_scheme(given)
        assert solver.advection_scheme == name
    solver.set_advection_scheme("koren")
    solver.set_advection(False)
    assert solver.advection_scheme is None
    solver.set_advection(True)
    assert solver.advection_scheme == "koren"


def test_body_force_in_every_form():
    solver = flow.Solver(4, 4, 4)
    forms = (
        lambda: solver.set_body_force(1, 2.0, np.float32(3)),
        lambda: solver.set_body_force(fx=1, fy=2, fz=3),
        lambda: solver.set_body_force(force=(1, 2, 3)),
        lambda: solver.set_body_force(np.array([1, 2, 3], dtype=np.int8)),
    )
    for form in forms:
        solver.set_body_force(0, 0, 0)
        form()
        assert solver.body_force == [1.0, 2.0, 3.0]


def test_grid_under_both_names():
    solver = flow.Solver(4, np.int32(5), 6)
    assert solver.get_resolution() == solver.global_resolution() == [4, 5, 6]
    assert solver.cells == solver.global_cells == [4, 5, 6]
    assert solver.get_spacing() == solver.spacing == [1, 1, 1]
    assert solver.extent == [4, 5, 6]
    assert solver.origin == [-0.5, -0.5, -0.5]
    assert not solver.physical_units
    assert (solver.ghost_width(), solver.rank(), solver.size(), solver.block_origin()) == (2, 0, 1, [0, 0, 0])
    assert [axis.tolist() for axis in solver.cell_centers()] == [list(range(n)) for n in (4, 5, 6)]


def test_caps_and_tolerances():
    solver = flow.Solver(4, 4, 4)
    default = solver.velocity_residual_tolerance()
    solver.set_velocity_solver_params(60)
    assert solver.velocity_residual_tolerance() == default
    solver.set_velocity_solver_params(60, 1e-5)
    assert solver.velocity_residual_tolerance() == 1e-5
    solver.set_velocity_residual_tolerance(-1)
    assert solver.velocity_residual_tolerance() == solver.pressure_tolerance()
    solver.set_pressure_pcg(True, 50, 1e-4)
    assert solver.pressure_tolerance() == solver.velocity_residual_tolerance() == 1e-4
    solver.set_velocity_residual_tolerance(1e-6)
    solver.set_pressure_tolerance(1e-3)
    assert (solver.pressure_tolerance(), solver.velocity_residual_tolerance()) == (1e-3, 1e-6)


def test_module_level_names():
    assert flow.execution_space in ("OpenMP", "Serial", "Cuda")
    assert flow.has_mpi is False
    assert flow.finalize() is None
    solver = flow.Solver(4, 4, 4)  # works all the same
    solver.step()
    assert isinstance(solver.diagnostics, flow.SolverDiagnostics)
    assert isinstance(solver.pressure_report, flow.SolverReport)


def test_repr_tells_what_it_is():
    solver = flow.Solver((4, 5, 6), extent=(1, 1, 3))
    text = repr(solver)
    assert "4 x 5 x 6 cells of size 0.25 x 0.2 x 0.5" in text
    assert "rho 1, mu 0.1, dt 50, advection off, 0 bodies, step 0" in text
