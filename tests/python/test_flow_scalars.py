"""Scalars: what their calls accept, and what their transport keeps."""

import numpy as np
import pytest
from peclet import flow

from tests.python.flow_scenes import box_with, spheres, state
from tests.same import assert_same

CELLS = (10, 8, 6)


def box(*bodies, cells=CELLS, diffusivity=0.2, scheme="koren"):
    """Flow driven around spheres, with a scalar 'c'."""
    solver = flow.Solver(*cells)
    solver.set_mu(0.2)
    solver.set_dt(0.5)
    solver.set_body_force(2e-3, 1e-3, 0)
    solver.set_advection(True)
    if bodies:
        box_with(solver, *bodies)
    solver.add_scalar("c", diffusivity, scheme)
    return solver


def pattern(solver):
    """A smooth field without symmetry, positive everywhere."""
    x, y, z = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in solver.cells), indexing="ij")
    return 2 + np.sin(x) * np.cos(y + 0.3) + 0.5 * np.cos(z - x)


def test_a_scalar_is_a_field():
    solver = box()
    assert solver.has_scalar("c")
    assert not solver.has_scalar("d")
    assert solver.scalar_names() == ["c"]
    assert solver.has_field("c")
    assert "c" in solver.field_names()
    values = pattern(solver)
    solver.set_field("c", values.astype(np.float32))
    np.testing.assert_array_equal(solver.get_field("c"), values.astype(np.float32))
    solver.get_field("c")[:] = 0
    np.testing.assert_array_equal(solver.get_field("c"), values.astype(np.float32))


@pytest.mark.parametrize("scheme", ["fou", "koren", "sou", 0, 1, 2])
@pytest.mark.parametrize("moving", [False, True])
def test_a_uniform_scalar_stays_uniform(scheme, moving):
    velocity = (0.06, -0.04, 0.02) if moving else (0, 0, 0)
    solver = box(((4.3, 3.6, 2.2), 2.1, velocity), scheme=scheme)
    solver.set_field("c", np.full(CELLS, 7.0))
    for step in range(6):
        if moving:
            solver.set_instance_transform(
                0, np.array([4.3, 3.6, 2.2]) + 0.5 * (step + 1) * np.array(velocity)
            )
        solver.step()
    # the fluxes sum to zero up to the tolerance of the pressure solve
    np.testing.assert_allclose(solver.get_field("c"), 7, rtol=1e-8)
    assert np.abs(solver.get_u()).max() > 1e-3


@pytest.mark.parametrize("diffusivity", [0.0, 0.3, 20.0])
def test_the_amount_is_conserved_by_walls_that_nothing_passes(diffusivity):
    solver = box(((4.3, 3.6, 2.2), 2.1), diffusivity=diffusivity)
    solver.set_field("c", pattern(solver))
    solver.step()
    start = solver.scalar_budget("c")["amount"]
    for _ in range(10):
        solver.step()
    budget = solver.scalar_budget("c")
    assert budget["amount"] == pytest.approx(start, rel=1e-12)
    assert budget["bodies"] == pytest.approx([0], abs=1e-14)


@pytest.mark.parametrize("kind", ["dirichlet", "neumann"])
def test_the_amount_changes_by_what_walls_sides_and_sources_give(kind):
    solver = box(((4.3, 3.6, 2.2), 2.1), ((8.6, 6.5, 4.5), 1.2))
    for face in ("-y", "+y"):
        solver.set_domain_bc(face, "wall")
    solver.set_scalar_wall("c", kind, 0.4)
    solver.set_scalar_wall("c", "neumann", -0.1, instance=1)
    solver.set_scalar_bc("c", "+y", kind, 0.7)
    solver.set_scalar_source("c", 0.01)
    solver.set_field("c", pattern(solver))
    solver.set_scalar_residual_tolerance("c", 1e-13)
    solver.step()
    sources = None
    for _ in range(4):
        old = solver.scalar_budget("c")["amount"]
        solver.step()
        budget = solver.scalar_budget("c")
        given = budget["bodies"].sum() + budget["sides"].sum()
        left = (budget["amount"] - old) / solver.dt - given
        # what is left is the source in the fluid, the same every step
        sources = left if sources is None else sources
        # the solve weighs links in single precision
        assert left == pytest.approx(sources, rel=1e-6)
        np.testing.assert_array_equal(solver.scalar_wall_flux("c"), budget["bodies"])
    assert 0.6 < sources / (0.01 * np.prod(CELLS)) < 1
    assert abs(budget["sides"][3]) > 0.1
    assert budget["sides"][[0, 1, 2, 4, 5]] == pytest.approx([0] * 5, abs=1e-13)


def test_given_flux_enters_through_the_area_of_the_wall():
    solver = box(((4.3, 3.6, 2.2), 2.1))
    solver.set_scalar_wall("c", "neumann", 0.25)
    solver.step()
    area = 4 * np.pi * 2.1**2
    # areas come from linear interpolation at two cells per radius
    assert solver.scalar_wall_flux("c")[0] == pytest.approx(0.25 * area, rel=0.06)


@pytest.mark.parametrize("scheme", ["fou", "koren"])
def test_limited_schemes_make_no_new_extrema(scheme):
    solver = flow.Solver(40, 1, 1)
    solver.set_mu(0)
    solver.set_dt(0.45)
    ones = np.ones((40, 1, 1))
    solver.set_state(ones, 0 * ones, 0 * ones)
    solver.add_scalar("c", 0, scheme)
    block = np.zeros((40, 1, 1))
    block[8:20] = 1
    solver.set_field("c", block)
    for _ in range(60):
        solver.step()
    found = solver.get_field("c")
    assert found.min() >= -1e-13
    assert found.max() <= 1 + 1e-13
    assert found.sum() == pytest.approx(block.sum(), rel=1e-13)
    assert found.max() > (0.9 if scheme == "koren" else 0.5)


def test_values_on_sides_give_the_exact_linear_profile():
    solver = flow.Solver((6, 5, 3), extent=(1.5, 1, 0.6))
    for face in ("-x", "+x", "-y", "+y"):
        solver.set_domain_bc(face, "slip")
    solver.add_scalar("c", 0.7)
    x, y, _ = solver.cell_centers()
    exact = np.broadcast_to((1 + 2 * x)[:, None, None] - y[None, :, None], (6, 5, 3))
    solver.set_scalar_bc("c", "-x", "dirichlet", np.broadcast_to((1 - y)[:, None], (5, 3)))
    solver.set_scalar_bc("c", "+x", "dirichlet", np.broadcast_to((4 - y)[:, None], (5, 3)))
    solver.set_scalar_bc("c", "-y", "neumann", 0.7)
    solver.set_scalar_bc("c", "+y", "neumann", -0.7)
    solver.set_field("c", exact)
    for _ in range(5):
        solver.step()
    np.testing.assert_allclose(solver.get_field("c"), exact, rtol=1e-12)
    assert solver.scalar_budget("c")["sides"][0] == pytest.approx(-0.7 * 2 * 0.6, rel=1e-11)


def test_inflow_carries_its_value_through_the_box():
    solver = flow.Solver((30, 4, 1), extent=(3, 0.4, 0.1))
    solver.set_domain_bc("-x", "inflow", [1, 0, 0])
    solver.set_domain_bc("+x", "outflow")
    for face in ("-y", "+y"):
        solver.set_domain_bc(face, "slip")
    solver.set_dt(0.04)
    solver.add_scalar("c")
    with pytest.raises(RuntimeError, match=r"scalar 'c' on the inflow side '-x'.*set_scalar_bc"):
        solver.step()
    assert solver.number_of_steps == 0
    solver.set_scalar_bc("c", "-x", "dirichlet", 2.5)
    for _ in range(150):
        solver.step()
    np.testing.assert_allclose(solver.get_field("c"), 2.5, rtol=1e-6)
    budget = solver.scalar_budget("c")["sides"]
    assert budget[:2] == pytest.approx([2.5 * 0.04, -2.5 * 0.04], rel=1e-6)


def test_a_mean_gradient_in_a_stream_is_a_source():
    solver = flow.Solver(8, 4, 4)
    shape = (8, 4, 4)
    solver.set_state(np.full(shape, 0.2), np.zeros(shape), np.zeros(shape))
    solver.set_dt(0.5)
    solver.add_scalar("c", 0.3)
    solver.set_scalar_mean_gradient("c", (2, 0, 0))
    for _ in range(4):
        solver.step()
    np.testing.assert_allclose(solver.get_field("c"), -0.2 * 2 * 4 * 0.5, rtol=1e-12)
    flux = solver.scalar_mean_flux("c")
    assert flux == pytest.approx([-0.3 * 2 + 0.2 * solver.get_field("c").mean(), 0, 0], rel=1e-12)


def test_a_mean_gradient_refuses_walls_of_given_value():
    solver = box(((4.3, 3.6, 2.2), 2.1))
    solver.set_scalar_mean_gradient("c", (1, 0, 0))
    solver.step()
    solver.set_scalar_wall("c", "dirichlet", 1.0)
    with pytest.raises(RuntimeError, match="scalar 'c', which has a mean gradient"):
        solver.step()
    assert solver.number_of_steps == 1


def test_conduction_along_a_mean_gradient_is_that_of_an_array():
    """Maxwell's dilute array of spheres that conduct nothing: D_eff / D = 1 - 3/2 phi + O(phi^2)."""
    cells, radius = 20, 5.0
    fraction = 4 / 3 * np.pi * radius**3 / cells**3
    solver = flow.Solver(cells, cells, cells)
    solver.set_scene(*spheres(((9.3, 9.6, 9.1), radius)), periodic=True)
    solver.set_solid_from_scene()
    solver.add_scalar("c", 2.0)
    solver.set_scalar_mean_gradient("c", (1, 0, 0))
    solver.solve_scalar_steady("c")
    along, *across = solver.scalar_mean_flux("c") / -2.0
    assert along == pytest.approx((1 - fraction) / (1 + fraction / 2), rel=5e-3)
    assert across == pytest.approx([0, 0], abs=1e-4)


def test_warm_fluid_rises_and_only_where_asked():
    solver = flow.Solver(12, 8, 8)
    solver.set_dt(1.0)
    solver.add_scalar("t", 0.1)
    warm = np.zeros((12, 8, 8))
    warm[4:6, 3:5, 3:5] = 1
    solver.set_field("t", warm)
    solver.step()
    assert solver.max_velocity() == 0
    solver.set_boussinesq("t", 0.01, warm.mean(), (-2, 0, 0))
    solver.step()
    u = solver.get_u()
    assert u[5, 3:5, 3:5].min() > 1e-3
    # the reference is the mean: no net force
    assert abs(u.mean()) < 1e-12
    assert np.abs(solver.get_v()).max() < u.max()
    solver.set_boussinesq("t", 0)


def test_uncovered_cells_start_from_the_wall():
    solver = box(((4.3, 3.6, 2.2), 2.1), diffusivity=0.0)
    solver.set_scalar_wall("c", "dirichlet", 5.0)
    solver.set_instance_motion(0, (0.2, 0, 0))
    solver.set_body_force(0, 0, 0)
    solver.step()
    assert solver.get_field("c")[4, 3, 2] == 5
    for step in range(8):
        solver.set_instance_transform(0, (4.3 + 0.1 * (step + 1), 3.6, 2.2))
        solver.step()
    values = solver.get_field("c")
    assert values.min() >= -0.05
    assert values.max() <= 5.05
    assert values[3, 4, 2] > 1


def test_scalars_can_advance_alone():
    solver = box()
    solver.set_field("c", pattern(solver))
    u = solver.get_u()
    solver.advance_scalars()
    assert solver.time == 0
    assert solver.number_of_steps == 0
    np.testing.assert_array_equal(solver.get_u(), u)
    assert np.ptp(solver.get_field("c")) < np.ptp(pattern(solver))


@pytest.mark.parametrize("scheme", ["fou", "koren"])
def test_the_steady_state_is_the_one_that_steps_lead_to(scheme):
    solver = flow.Solver((24, 12, 1), extent=(2, 1, 0.1))
    solver.set_domain_bc("-x", "inflow", [1, 0, 0])
    solver.set_domain_bc("+x", "outflow")
    for face in ("-y", "+y"):
        solver.set_domain_bc(face, "slip")
    solver.set_scene(*spheres(((0.7, 0.4, 0.05), 0.2)))
    solver.set_solid_from_scene()
    solver.set_mu(0.1)
    solver.set_dt(0.02)
    solver.add_scalar("c", 0.05, scheme)
    solver.set_scalar_bc("c", "-x", "dirichlet", 1.0)
    solver.set_scalar_wall("c", "dirichlet", 3.0)
    for _ in range(400):
        solver.step()
    marched, flux = solver.get_field("c"), solver.scalar_wall_flux("c")
    for start in (marched, np.zeros((24, 12, 1))):
        solver.set_field("c", start)
        solver.solve_scalar_steady("c")
        assert solver.diagnostics.scalar_report("c").converged
        np.testing.assert_allclose(solver.get_field("c"), marched, atol=2e-4)
        assert solver.scalar_wall_flux("c") == pytest.approx(flux, rel=1e-3)
    sides = solver.scalar_budget("c")["sides"]
    assert sides.sum() + flux.sum() == pytest.approx(0, abs=1e-3 * flux[0])


def test_a_steady_state_keeps_the_amount_where_no_value_is_given():
    solver = box(((4.3, 3.6, 2.2), 2.1))
    solver.set_field("c", pattern(solver))
    solver.step()
    amount = solver.scalar_budget("c")["amount"]
    solver.solve_scalar_steady("c")
    assert solver.scalar_budget("c")["amount"] == pytest.approx(amount, rel=1e-12)
    assert np.ptp(solver.get_field("c")) < 1e-6
    solver.set_scalar_source("c", 1.0)
    with pytest.raises(RuntimeError, match="no steady state"):
        solver.solve_scalar_steady("c")
    assert solver.scalar_budget("c")["amount"] == pytest.approx(amount, rel=1e-12)


@pytest.mark.parametrize("kind", ["dirichlet", "neumann"])
def test_scalars_go_on_from_a_checkpoint_bit_by_bit(kind):
    def make():
        solver = box(((4.3, 3.6, 2.2), 2.1, (0.06, 0, 0)))
        solver.set_scalar_wall("c", kind, 0.5)
        solver.set_boussinesq("c", 0.01)
        return solver

    def march(solver, first, last):
        for step in range(first, last):
            solver.set_instance_transform(0, (4.3 + 0.03 * step, 3.6, 2.2))
            solver.step()

    whole, first, second = make(), make(), make()
    for solver in (whole, first):
        solver.set_field("c", pattern(solver))
    march(whole, 0, 7)
    march(first, 0, 4)
    second.restore(first.checkpoint())
    march(second, 4, 7)
    for name, values in whole.checkpoint().items():
        assert_same(second.checkpoint()[name], values, name)


def test_reports_and_caps():
    solver = box(diffusivity=50.0)
    solver.set_field("c", pattern(solver))
    solver.step()
    report = solver.diagnostics.scalar_report("c")
    assert report.converged
    assert report.residual < 1e-8
    assert report.iterations > 1
    solver.diagnostics.set_scalar_max_iterations("c", 1)
    solver.set_scalar_residual_tolerance("c", 1e-12)
    solver.set_field("c", pattern(solver))
    with pytest.warns(RuntimeWarning, match="scalar 'c' solve met its cap of 1 iterations"):
        solver.step()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda s: s.add_scalar("c"), ValueError, "name: expected a name other than"),
        (lambda s: s.add_scalar("u"), ValueError, "name"),
        (lambda s: s.add_scalar(3), TypeError, "name"),
        (lambda s: s.add_scalar("d", -1), ValueError, "diffusivity"),
        (lambda s: s.add_scalar("d", 0, "upwind"), ValueError, "scheme: expected 'koren'"),
        (lambda s: s.add_scalar("d", 0, 3), ValueError, "scheme"),
        (lambda s: s.add_scalar("d", 0, True), TypeError, "scheme"),
        (lambda s: s.add_scalar("d", 0, "sou", 0), ValueError, "iters"),
        (lambda s: s.add_scalar("d", 0, "sou", None, 1), TypeError, "cutcell"),
        (lambda s: s.set_scalar_wall("d", "dirichlet"), ValueError, r"add_scalar\(\) \('c'\)"),
        (lambda s: s.set_scalar_wall("c", "robin"), ValueError, "type: expected one of 'dirichlet'"),
        (lambda s: s.set_scalar_wall("c", "neumann", np.inf), ValueError, "value"),
        (lambda s: s.set_scalar_wall("c", "neumann", 1, 2), ValueError, "coefficient"),
        (lambda s: s.set_scalar_wall("c", "neumann", instance=1), RuntimeError, "instance"),
        (lambda s: s.set_scalar_bc("c", "-x", "dirichlet"), ValueError, "periodic"),
        (lambda s: s.set_scalar_bc("c", "x", "dirichlet"), ValueError, "face"),
        (lambda s: s.set_scalar_bc("c", 6, "dirichlet"), ValueError, "face"),
        (lambda s: s.set_scalar_bc("c", "-y", "wall"), ValueError, "type"),
        (lambda s: s.set_scalar_bc("c", "-y", "neumann", np.zeros((3, 3))), ValueError, "value"),
        (lambda s: s.set_scalar_bc("c", "-y", "neumann", "1"), TypeError, "value"),
        (lambda s: s.set_scalar_source("c", np.zeros(3)), ValueError, "source"),
        (lambda s: s.set_scalar_source("c", np.nan), ValueError, "source"),
        (lambda s: s.set_scalar_mean_gradient("c", (1, 2)), ValueError, "gradient"),
        (lambda s: s.set_scalar_residual_tolerance("c", 0), ValueError, "rtol"),
        (lambda s: s.set_scalar_max_iterations("c", 0), ValueError, "max_iter"),
        (lambda s: s.set_boussinesq("c", np.nan), ValueError, "expansion"),
        (lambda s: s.set_boussinesq("c", 1, 0, (0, 1)), ValueError, "gravity"),
        (lambda s: s.set_field("c", np.zeros((2, 2, 2))), ValueError, "array"),
        (lambda s: s.scalar_wall_flux("c"), RuntimeError, r"step\(\)"),
        (lambda s: s.scalar_mean_flux("d"), ValueError, "name"),
    ],
)
def test_bad_arguments_are_named_and_change_nothing(call, error, message):
    solver = box(((4.3, 3.6, 2.2), 2.1))
    for face in ("-y", "+y"):
        solver.set_domain_bc(face, "wall")
    solver.set_field("c", pattern(solver))
    before = state(solver)
    with pytest.raises(error, match=message):
        call(solver)
    assert state(solver) == before


def test_a_new_scene_keeps_the_conditions_of_all_bodies():
    solver = box(((4.3, 3.6, 2.2), 2.1))
    solver.set_scalar_wall("c", "dirichlet", 3.0)
    solver.set_scene(*spheres(((2, 2, 2), 1.5), ((7, 5, 3), 1.5)), periodic=True)
    solver.set_solid_from_scene()
    solver.step()
    assert solver.scalar_wall_flux("c").shape == (2,)
    assert (solver.scalar_wall_flux("c") > 0).all()
