"""Arrays in and out: shape, dtype, order, conversion, copies, and what solid faces hold."""

import numpy as np
import pytest
from peclet import flow
from peclet.core import geom

from tests.python.flow_scenes import box_with, face_is_fluid
from tests.python.views import needs_readable_views
from tests.same import assert_same

SHAPE = (7, 5, 9)


@pytest.fixture
def values():
    return np.random.default_rng(1).standard_normal(SHAPE)


def every_form(array):
    """The same numbers in other memory orders and types."""
    wide = np.zeros(tuple(2 * n for n in array.shape))
    wide[::2, ::2, ::2] = array
    return {
        "C": np.ascontiguousarray(array),
        "Fortran": np.asfortranarray(array),
        "strided": wide[::2, ::2, ::2],
        "reversed": np.ascontiguousarray(array[::-1, :, ::-1])[::-1, :, ::-1],
        "read-only": np.frombuffer(array.tobytes()).reshape(array.shape),
        "list": array.tolist(),
        "big-endian": array.astype(">f8"),
    }


def test_what_comes_out():
    solver = flow.Solver(*SHAPE)
    box_with(solver, ((3, 2, 4), 1.6))
    assert solver.field_names() == ["p", "sdf", "u", "v", "w"]
    arrays = [solver.get_field(name) for name in solver.field_names()]
    arrays += [solver.get_ox(), solver.get_oy(), solver.get_oz(), solver.get_uf(), solver.get_ox_proj()]
    for array in arrays:
        assert (array.shape, array.dtype) == (SHAPE, np.float64)
        assert array.flags.f_contiguous
        assert array.flags.writeable
    owner = solver.get_cut_owner()
    assert (owner.shape, owner.dtype) == (SHAPE, np.int32)
    assert solver.has_field("u")
    assert not solver.has_field("temperature")


def test_results_are_copies(values):
    solver = flow.Solver(*SHAPE)
    solver.set_state(values, values, values)
    solver.set_field("p", values)
    for name in ("u", "v", "w", "p"):
        solver.get_field(name)[:] = 77
        np.testing.assert_array_equal(solver.get_field(name), values)
    given = values.copy()
    solver.set_velocity(0, given)
    given[:] = 77
    np.testing.assert_array_equal(solver.get_u(), values)


def test_inputs_in_every_order_keep_their_indices(values):
    solver = flow.Solver(*SHAPE)
    for form, array in every_form(values).items():
        for c, get in enumerate((solver.get_u, solver.get_v, solver.get_w)):
            solver.set_velocity(c, np.zeros(SHAPE))
            solver.set_velocity(c, array)
            np.testing.assert_array_equal(get(), values, err_msg=form)
        solver.set_field("p", array)
        np.testing.assert_array_equal(solver.get_p(), values, err_msg=form)
        solver.set_state(np.zeros(SHAPE), array, 2 * values)
        np.testing.assert_array_equal(solver.get_v(), values, err_msg=form)
        np.testing.assert_array_equal(solver.get_field("w"), 2 * values, err_msg=form)


@pytest.mark.parametrize("dtype", [np.float32, np.float16, np.int64, np.uint8])
def test_other_types_are_converted(dtype):
    solver = flow.Solver(*SHAPE)
    array = (np.arange(np.prod(SHAPE)) % 100).reshape(SHAPE).astype(dtype)
    solver.set_field("u", array)
    np.testing.assert_array_equal(solver.get_u(), array.astype(float))


def test_a_component_leaves_the_others_alone(values):
    solver = flow.Solver(*SHAPE)
    solver.set_state(values, 2 * values, 3 * values)
    solver.set_velocity(1, np.zeros(SHAPE))
    np.testing.assert_array_equal(solver.get_u(), values)
    np.testing.assert_array_equal(solver.get_v(), 0)
    np.testing.assert_array_equal(solver.get_w(), 3 * values)


def test_velocity_given_before_the_geometry_is_kept_by_the_first_step():
    solver = flow.Solver(*SHAPE)
    solver.set_dt(0.1)
    ones = np.ones(SHAPE)
    solver.set_state(ones, 2 * ones, -ones)
    solver.step()
    np.testing.assert_allclose(solver.get_v(), 2, rtol=1e-12)
    assert solver.max_open_divergence() < 1e-12


def test_without_geometry_the_box_is_full_of_fluid_and_projected(values):
    solver = flow.Solver(*SHAPE)
    solver.set_dt(1e-3)
    solver.set_state(values, np.roll(values, 1), np.roll(values, 2))
    means = [solver.get_field(c).mean() for c in "uvw"]
    assert solver.max_open_divergence() > 0.1
    solver.step()
    assert solver.max_open_divergence() < 1e-8
    # neither viscosity nor pressure changes the momentum of the box; the viscous solve stops at 1e-8
    np.testing.assert_allclose([solver.get_field(c).mean() for c in "uvw"], means, atol=1e-7)
    assert (solver.get_field("sdf") > 0).all()
    assert (solver.get_cut_owner() == -1).all()


def test_solid_faces_hold_zero_and_no_others_do(values):
    solver = flow.Solver(12, 11, 13)
    solver.set_dt(0.5)
    box_with(solver, ((5.3, 5.1, 5.8), 3.2, (0.1, 0.05, -0.1), (0.02, 0, 0)))
    solver.set_body_force(1e-2, 2e-2, 3e-2)
    for _ in range(2):
        solver.step()
    sdf = solver.get_field("sdf")
    for axis, (name, opening) in enumerate(zip("uvw", ("x", "y", "z"), strict=True)):
        fluid = face_is_fluid(sdf, axis)
        velocity = solver.get_field(name)
        open_part = getattr(solver, f"get_o{opening}")()
        assert (~fluid).any()
        assert (velocity[~fluid] == 0).all()
        assert (velocity[fluid] != 0).all()
        assert (open_part[fluid] > 0).all()
        assert open_part.max() == 1
        carrying = getattr(solver, f"get_{name}f")()
        np.testing.assert_array_equal(carrying[fluid], velocity[fluid])
        # slits carry mass and show no velocity
        np.testing.assert_array_equal(carrying[~fluid] != 0, open_part[~fluid] > 0)
        assert (open_part[~fluid] > 0).any()
        assert solver.fluid_momentum_cells()[axis] == fluid.sum()


def test_velocity_written_into_solid_is_ignored(values):
    solver = flow.Solver(12, 12, 12)
    box_with(solver, ((5.3, 5.1, 5.8), 3.2))
    ones = np.ones((12, 12, 12))
    solver.set_state(ones, ones, ones)
    sdf = solver.get_field("sdf")
    for axis, name in enumerate("uvw"):
        np.testing.assert_array_equal(solver.get_field(name), face_is_fluid(sdf, axis))


def test_one_cell_thick_boxes_work():
    for shape in ((1, 1, 1), (16, 1, 1), (1, 7, 5), (2, 3, 4)):
        solver = flow.Solver(*shape)
        solver.set_dt(0.5)
        solver.set_body_force(1, 2, 3)
        solver.step()
        for component, force in zip("uvw", (1, 2, 3), strict=True):
            np.testing.assert_allclose(solver.get_field(component), 0.5 * force, rtol=1e-7)


def stream_past_a_moving_sphere():
    solver = flow.Solver((16, 10, 8), extent=(1.6, 1.0, 0.8))
    solver.set_domain_bc("-x", "inflow", [0.5, 0, 0])
    solver.set_domain_bc("+x", "outflow")
    solver.set_domain_bc("-y", "slip")
    solver.set_domain_bc("+y", "wall")
    builder = geom.SceneBuilder()
    sphere = builder.add_leaf("sphere", [0.21])
    builder.add_instance(sphere, translation=[0.5, 0.52, 0.41], lin_vel=[0.2, 0, 0])
    solver.set_scene(*builder.encode())
    solver.set_solid_from_scene()
    solver.set_mu(0.01)
    solver.set_dt(0.02)
    solver.set_advection(True)
    solver.add_scalar("dye", 1e-3)
    solver.set_scalar_bc("dye", "-x", "dirichlet", 1.0)
    return solver


def advance(solver, steps):
    for n in steps:
        solver.set_instance_transform(0, [0.5 + 0.004 * n, 0.52, 0.41])
        solver.rebuild_geometry()
        solver.step()


def test_a_run_goes_on_from_a_checkpoint_bit_by_bit():
    whole, first, second = (stream_past_a_moving_sphere() for _ in range(3))
    advance(whole, range(1, 9))
    advance(first, range(1, 5))
    second.restore(first.checkpoint())
    assert second.time == first.time
    advance(second, range(5, 9))
    for name, values in whole.checkpoint().items():
        assert_same(second.checkpoint()[name], values, name)
    assert_same(second.hydro_force_torque_reaction(), whole.hydro_force_torque_reaction())


def test_a_body_set_in_motion_after_the_checkpoint_rests_again():
    forces = []
    for moves in (False, True):
        solver = box_with(flow.Solver(12, 12, 12), ((6.2, 6.0, 6.0), 2.5))
        solver.set_body_force(1e-3, 0, 0)
        solver.step()
        at_rest = solver.checkpoint()
        if moves:
            solver.set_instance_transform(0, [6.9, 6.0, 6.0])
            solver.set_instance_motion(0, [0.1, 0, 0])
            solver.step()
            solver.restore(at_rest)
        solver.step()
        forces.append(solver.hydro_force_torque_reaction())
    assert_same(*forces)


def test_a_checkpoint_that_does_not_fit_is_refused():
    solver = stream_past_a_moving_sphere()
    advance(solver, range(1, 3))
    before = solver.checkpoint()
    for name, broken in (
        ("state", {k: v for k, v in before.items() if k != "u"}),
        (r"state\['u'\]", before | {"u": before["u"][1:]}),
        (r"state\['p'\]", before | {"p": np.full_like(before["p"], np.nan)}),
    ):
        with pytest.raises(ValueError, match=name):
            solver.restore(broken)
        for key, values in solver.checkpoint().items():
            assert np.array_equal(values, before[key]), key


# ------------------------------------------------------------------------------------------- without a copy


@needs_readable_views
@pytest.mark.parametrize("name", ["u", "v", "w", "p", "heat"])
def test_views_are_the_memory(values, name):
    solver = flow.Solver(*SHAPE)
    solver.add_scalar("heat", 0.1)
    solver.set_field(name, values)
    view = solver.diagnostics.field_view(name)
    np.testing.assert_array_equal(view, values)
    assert np.shares_memory(view, solver.field_view(name))
    view[1, 2, 3] = 5
    assert solver.get_field(name)[1, 2, 3] == 5
    solver.set_field(name, 2 * values)
    np.testing.assert_array_equal(view, 2 * values)


@needs_readable_views
def test_dlpack_shares_the_memory(values):
    solver = flow.Solver(*SHAPE)
    solver.set_field("p", values)
    taken = np.from_dlpack(solver.field_view("p"))
    assert np.shares_memory(taken, solver.field_view("p"))
    taken[2, 1, 0] = -3
    assert solver.get_p()[2, 1, 0] == -3
    copy = solver.get_p()
    assert np.shares_memory(np.from_dlpack(copy), copy)


@needs_readable_views
def test_views_outlive_the_solver(values):
    solver = flow.Solver(*SHAPE)
    solver.set_field("p", values)
    view = np.from_dlpack(solver.field_view("p"))
    del solver
    np.testing.assert_array_equal(view, values)


@needs_readable_views
def test_what_views_wrote_counts_once_it_is_set(values):
    one, other = flow.Solver(*SHAPE), flow.Solver(*SHAPE)
    for solver in (one, other):
        box_with(solver, ((3, 2, 4), 1.6))
        solver.set_dt(0.1)
        solver.step()
    view = one.field_view("u")
    view[:] = values
    one.set_field("u", view)
    other.set_field("u", values)
    for solver in (one, other):
        solver.step()
    np.testing.assert_array_equal(one.get_u(), other.get_u())
    np.testing.assert_array_equal(one.get_p(), other.get_p())


@pytest.mark.parametrize("name", ["sdf", "temperature", "u_previous", 3])
def test_views_of_what_does_not_exist(name):
    with pytest.raises((ValueError, TypeError), match="name"):
        flow.Solver(*SHAPE).field_view(name)
