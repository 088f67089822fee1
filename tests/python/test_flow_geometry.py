"""Scenes on the solver: sampling, images, transforms, motion, and when they take effect."""

import itertools
import time

import numpy as np
import pytest
from peclet import flow
from peclet.core.geom import SceneBuilder

from tests.python.flow_scenes import FIELDS, assert_same_flow, box_with, face_is_fluid, spheres
from tests.python.views import needs_readable_views

N = 16


def sphere_distance(center, radius, shape=(N, N, N), periodic=True):
    """Exact distance at the cell centres (i, j, k) of a box, nearest image."""
    squares = 0
    for axis, (c, n) in enumerate(zip(center, shape, strict=True)):
        r = np.arange(n) - c
        if periodic:
            r = (r + n / 2) % n - n / 2
        squares = squares + np.expand_dims(r**2, tuple({0, 1, 2} - {axis}))
    return np.sqrt(squares) - radius


def stepped(*bodies, steps=1, dt=1.0, size=N):
    solver = flow.Solver(size, size, size)
    solver.set_dt(dt)
    solver.set_body_force(1e-3, 2e-4, 0)
    box_with(solver, *bodies)
    for _ in range(steps):
        solver.step()
    return solver


def test_distance_and_owner_of_two_spheres():
    centers, radii = ((5.1, 8.2, 8.3), (12.3, 6.2, 9.4)), (2.6, 3.3)
    solver = box_with(flow.Solver(N, N, N), *zip(centers, radii, strict=True))
    distances = np.array([sphere_distance(c, r) for c, r in zip(centers, radii, strict=True)])
    np.testing.assert_allclose(solver.get_field("sdf"), distances.min(axis=0), atol=1e-12)
    np.testing.assert_array_equal(solver.get_cut_owner(), distances.argmin(axis=0))


@pytest.mark.parametrize("periodic", [True, False])
def test_images_appear_only_when_asked_for(periodic):
    solver = flow.Solver(N, N, N)
    solver.set_scene(*spheres(((0, 8, 8), 3.0)), periodic=periodic)
    solver.set_solid_from_scene()
    expected = sphere_distance((0, 8, 8), 3.0, periodic=periodic)
    np.testing.assert_allclose(solver.get_field("sdf"), expected, atol=1e-12)
    assert (solver.get_field("sdf")[N - 1, 8, 8] < 0) == periodic
    assert solver.periodic_image_overlap_cells() == 0


def test_cell_centres_are_at_whole_numbers():
    sdf = box_with(flow.Solver(N, N, N), ((8, 8, 8), 4.0)).get_field("sdf")
    assert (sdf[8, 8, 8], sdf[4, 8, 8], sdf[12, 8, 8], sdf[8, 8, 14]) == (-4, 0, 0, 2)


def test_a_translation_outside_the_box_wraps():
    solver = stepped(((8, 8, 8), 2.5))
    solver.set_instance_transform(0, (19.5, -3.0, 8.0))
    solver.rebuild_geometry()
    np.testing.assert_allclose(solver.get_field("sdf"), sphere_distance((3.5, 13, 8), 2.5), atol=1e-12)


def test_far_translations_are_harmless():
    solver = stepped(((8, 8, 8), 2.5))
    for far in (1e5, -1e9, 1e15, -1e300):
        solver.set_instance_transform(0, (far, far, far))
        solver.step()
        assert np.isfinite(solver.get_u()).all()


def test_records_of_any_type_and_shape_mean_the_same():
    bodies = ((5.25, 8.5, 8.25), 2.5), ((11, 7.5, 9), 3.25)
    node_ints, node_reals, instance_ints, instance_reals = spheres(*bodies)
    expected = box_with(flow.Solver(N, N, N), *bodies).get_field("sdf")
    with_pin_column = np.column_stack([instance_reals.reshape(2, 17), [0, 0]])
    with_pin_column[:, 14:17] = np.nan
    variants = [
        (
            node_ints.reshape(-1, 3),
            node_reals.reshape(-1, 16),
            instance_ints.reshape(-1, 2),
            instance_reals.reshape(-1, 17),
        ),
        (
            node_ints.astype(np.int64),
            node_reals.astype(np.float32),
            instance_ints.astype(float),
            instance_reals.tolist(),
        ),
        (np.repeat(node_ints, 2)[::2], node_reals, instance_ints, np.asfortranarray(with_pin_column)),
    ]
    for records in variants:
        solver = flow.Solver(N, N, N)
        solver.set_scene(*records, periodic=True)
        solver.set_solid_from_scene()
        np.testing.assert_array_equal(solver.get_field("sdf"), expected)


def test_set_solid_from_scene_puts_the_fluid_at_rest_and_rebuild_does_not():
    solver = stepped(((8.3, 8.1, 7.8), 3.0), steps=2)
    before = solver.get_u()
    solver.rebuild_geometry()
    np.testing.assert_array_equal(solver.get_u(), before)
    solver.set_solid_from_scene()
    for name in ("u", "v", "w", "p"):
        assert (solver.get_field(name) == 0).all()


def test_a_transform_takes_effect_with_the_rebuild():
    solver = stepped(((8.3, 8.1, 7.8), 3.0))
    before = solver.get_field("sdf")
    solver.set_instance_transform(0, (9.1, 8.1, 7.8))
    np.testing.assert_array_equal(solver.get_field("sdf"), before)
    solver.rebuild_geometry()
    np.testing.assert_allclose(solver.get_field("sdf"), sphere_distance((9.1, 8.1, 7.8), 3.0), atol=1e-12)


def test_step_without_rebuild_equals_an_explicit_rebuild():
    with_rebuild, without = (stepped(((8.3, 8.1, 7.8), 3.0), ((2.2, 2.4, 2.1), 1.8)) for _ in range(2))
    for n in range(3):
        for solver in (with_rebuild, without):
            solver.set_instance_transform(1, (2.2 + 0.3 * n, 2.4, 2.1), (0, 0, 0.1 * n, 1))
            solver.set_instance_motion(1, (0.3, 0, 0), (0, 0, 0.1))
        with_rebuild.rebuild_geometry()
        with_rebuild.step()
        without.step()
        assert_same_flow(with_rebuild, without)


def test_a_new_motion_without_refresh_equals_an_explicit_one():
    with_refresh, without = (stepped(((8.3, 8.1, 7.8), 3.0, (0.05, 0, 0))) for _ in range(2))
    for solver in (with_refresh, without):
        solver.set_instance_motion(0, (0.1, 0, 0), (0, 0.02, 0))
    with_refresh.refresh_wall_velocity()
    for solver in (with_refresh, without):
        solver.step()
    assert_same_flow(with_refresh, without)


def test_zero_motion_is_the_static_solver_to_the_last_bit():
    static, told = (stepped(((8.3, 8.1, 7.8), 3.0)) for _ in range(2))
    told.set_instance_motion(0, (0, 0, 0), (0, 0, 0))
    assert not told.has_moving_instance()
    for solver in (static, told):
        solver.step()
    assert_same_flow(static, told)


def test_centre_of_rotation_follows_until_it_is_pinned():
    solver = stepped(((8, 8, 8), 3.0), ((3, 3, 3), 1.5))
    solver.set_instance_motion(0, ang_vel=(0, 0, 0.1))
    assert solver.has_moving_instance()
    assert not solver.instance_center_pinned(0)
    solver.set_instance_transform(0, (9, 8, 7))
    solver.rebuild_geometry()
    assert solver.instance_center(0) == [9, 8, 7]
    solver.set_instance_motion(0, center=(1, 2, 3))
    solver.set_instance_motion(0, (0.1, 0, 0))  # stays pinned
    solver.set_instance_transform(0, (10, 8, 7))
    solver.rebuild_geometry()
    assert solver.instance_center(0) == [1, 2, 3]
    assert solver.diagnostics.instance_center_pinned(0)
    assert not solver.diagnostics.instance_center_pinned(1)


def test_the_number_of_bodies_may_change():
    solver = stepped(((8, 8, 8), 3.0))
    solver.set_scene(*spheres(((4, 4, 4), 2.0), ((11, 11, 11), 2.5)), periodic=True)
    solver.rebuild_geometry()
    solver.step()
    assert solver.hydro_force_torque_reaction().shape == (2, 2, 3)
    expected = np.minimum(sphere_distance((4, 4, 4), 2), sphere_distance((11, 11, 11), 2.5))
    np.testing.assert_allclose(solver.get_field("sdf"), expected, atol=1e-12)


def test_a_scene_without_instances_is_all_fluid():
    solver = flow.Solver(8, 8, 8)
    solver.set_scene(*spheres())
    solver.set_solid_from_scene()
    solver.set_dt(1)
    solver.set_body_force(0, 0, 1)
    solver.step()
    np.testing.assert_allclose(solver.get_w(), 1)
    assert solver.has_scene()
    assert solver.hydro_force_torque_reaction().shape == (2, 0, 3)


def test_bodies_that_cover_everything_leave_nothing_to_move():
    solver = stepped(((8, 8, 8), 40.0))
    for name in "uvw":
        assert (solver.get_field(name) == 0).all()
    assert solver.fluid_momentum_cells() == [0, 0, 0]
    assert np.isfinite(solver.hydro_force_torque_reaction()).all()


def test_sampled_distance_gives_the_flow_of_the_scene():
    center, radius = (8.3, 8.1, 7.8), 3.0
    sampled = flow.Solver(N, N, N)
    sampled.set_solid(np.ascontiguousarray(sphere_distance(center, radius)))
    np.testing.assert_array_equal(sampled.get_field("sdf"), sphere_distance(center, radius))
    assert (sampled.get_cut_owner() == -2).all()
    sampled.set_dt(1.0)
    sampled.set_body_force(1e-3, 2e-4, 0)
    for _ in range(3):
        sampled.step()
    expected = stepped((center, radius), steps=3)
    for axis, name in enumerate("uvw"):
        fluid = face_is_fluid(sampled.get_field("sdf"), axis)
        assert (sampled.get_field(name)[~fluid] == 0).all()
    # the samples are interpolated linearly between the centres
    assert sampled.get_u().mean() == pytest.approx(expected.get_u().mean(), rel=0.01)


def test_faces_that_a_body_uncovers_take_its_velocity():
    solver = flow.Solver(N, N, N)
    solver.set_dt(1.0)
    box_with(solver, ((8.3, 8.1, 7.8), 4.0, (0.1, 0, 0)))
    solver.step()
    covered = [~face_is_fluid(solver.get_field("sdf"), axis) for axis in range(3)]
    solver.set_instance_transform(0, (9.3, 8.1, 7.8))
    solver.rebuild_geometry()
    sdf = solver.get_field("sdf")
    for axis, (name, speed) in enumerate((("u", 0.1), ("v", 0), ("w", 0))):
        fresh = covered[axis] & face_is_fluid(sdf, axis)
        assert fresh.any()
        np.testing.assert_allclose(solver.get_field(name)[fresh], speed, atol=1e-15)


def tank(cavity, slab):
    """Records of a box of half extent slab, with a cavity, around (8.3, 8.3, 8.3)."""
    node_ints = [3, -1, -1, 3, -1, -1, 34, 0, 1]
    pose = [0, 0, 0, 0, 0, 0, 1, 1]
    node_reals = [[*[half] * 3, *[0] * 5, *pose] for half in (slab, cavity)] + [[1, *[0] * 7, *pose]]
    return node_ints, node_reals, [2, -1], [8.3, 8.3, 8.3, 0, 0, 0, 1, 1, *[0.0] * 9]


@pytest.mark.parametrize("slab", [9.0, 10.5])
def test_a_tank_a_bit_wider_than_the_box_keeps_its_cavity(slab):
    solver = flow.Solver(N, N, N)
    solver.set_scene(*tank(5, slab), periodic=True)
    solver.set_solid_from_scene()
    assert solver.periodic_image_overlap_cells() == 0
    assert (solver.get_field("sdf") > 0).sum() == 10**3


@pytest.mark.parametrize(("slab", "fluid"), [(13.5, 125), (16.0, 0)])
def test_a_tank_whose_images_fill_its_cavity_is_noticed(slab, fluid):
    solver = flow.Solver(N, N, N)
    solver.set_scene(*tank(5, slab), periodic=True)
    solver.set_solid_from_scene()
    assert solver.periodic_image_overlap_cells() == 1000 - fluid
    assert (solver.get_field("sdf") > 0).sum() == fluid


def test_a_body_across_the_edge_overlaps_nothing():
    for size in (8, 16, 32):
        solver = box_with(flow.Solver(size, size, size), ((0, size / 2, size - 1), 2.3))
        assert solver.periodic_image_overlap_cells() == 0


def test_a_body_across_the_edge_is_the_same_body():
    """Moving everything by whole cells moves the flow with it."""
    inside = stepped(((7.2, 8.1, 7.8), 3.3, (0.1, 0, 0)))
    across = stepped(((15.2, 8.1, 15.8), 3.3, (0.1, 0, 0)))
    for name in FIELDS:
        moved = np.roll(inside.get_field(name), (8, 0, 8), axis=(0, 1, 2))
        np.testing.assert_allclose(across.get_field(name), moved, atol=1e-6, err_msg=name)
    np.testing.assert_allclose(
        across.hydro_force_torque_reaction(), inside.hydro_force_torque_reaction(), rtol=1e-5, atol=1e-5
    )


def test_a_narrow_gap_across_the_edge_is_the_same_gap():
    states = []
    for shift in (0, 8):
        solver = flow.Solver(N, N, N)
        solver.set_dt(0.2)
        solver.set_mu(0.05)
        solver.set_pressure_tolerance(1e-10)
        solver.set_velocity_residual_tolerance(1e-10)
        box_with(
            solver,
            ((4.0 + shift, 6.5, 6.5), 2.0, (0.1, 0.1, 0)),
            ((8.5 + shift, 6.75, 6.5), 2.0, (0, -0.1, 0)),
        )
        solver.step()
        states.append([np.roll(solver.get_field(name), -shift, axis=0) for name in "uvw"])
    np.testing.assert_allclose(states[0], states[1], atol=1e-10)


@needs_readable_views
def test_a_body_half_a_period_from_its_centre_of_rotation_stays_rigid():
    solver = flow.Solver(N, N, N)
    box_with(solver, ((3.0, 8.0, 8.0), 2.5))
    solver.set_instance_motion(0, (0, 0, 0), (0, 0, 0.02), (11.2, 8.0, 8.0))
    solver.step()
    inside = solver.diagnostics.field_view("v")[1:6, 8, 8]
    nearest_image = np.arange(1, 6)[1:4] - (11.2 - N)
    np.testing.assert_allclose(inside[1:4], 0.02 * nearest_image, atol=1e-12)


@pytest.mark.parametrize("left", [(), (((4.1, 9.2, 8.3), 2.4),)], ids=["nothing", "a body at rest"])
def test_a_moving_body_that_is_taken_away_leaves_no_trace(left):
    used, fresh = flow.Solver(N, N, N), flow.Solver(N, N, N)
    box_with(used, ((8.2, 8.0, 8.0), 2.5, (0.1, 0, 0)))
    used.step()
    for solver in (used, fresh):
        solver.set_body_force(1e-3, 0, 0)
        box_with(solver, *left)
        for _ in range(2):
            solver.step()
    for name in FIELDS:
        np.testing.assert_array_equal(used.get_field(name), fresh.get_field(name))


def test_a_body_that_enters_through_a_side_leaves_no_trace_behind():
    """The region searched for cells near the body grows from one rebuild to the next."""

    def solver_with_body_at(z):
        scene = SceneBuilder()
        scene.add_instance(scene.add_leaf("ellipsoid", [5.0, 2.0, 3.0]), translation=[8, 8, z])
        solver = flow.Solver(20, 16, 32)
        for side in ("-x", "+x", "-y", "+y", "-z", "+z"):
            solver.set_domain_bc(side, "wall")
        solver.set_scene(*scene.encode())
        solver.set_solid_from_scene()
        solver.set_instance_motion(0, (0, 0, 1e-3))
        solver.rebuild_geometry()
        return solver

    used = solver_with_body_at(0)
    for z in (14, 24):
        used.set_instance_transform(0, (8, 8, z))
        used.rebuild_geometry()
        fresh = solver_with_body_at(z)
        for axis in "xyz":
            found, expected = (getattr(solver, f"get_o{axis}")() for solver in (used, fresh))
            np.testing.assert_allclose(found, expected, atol=1e-4)


def test_turning_the_axes_turns_the_flow():
    """Cyclic exchange of x, y and z, with a different size along each."""
    shape, center, force = (12, 16, 20), (5.3, 7.1, 9.8), (1e-3, 2e-3, -1e-3)
    results = []
    for turn in range(3):
        order = np.roll(np.arange(3), turn)
        solver = flow.Solver(*(shape[n] for n in order))
        solver.set_dt(2.0)
        solver.set_body_force([force[n] for n in order])
        box_with(solver, (tuple(center[n] for n in order), 3.3))
        for _ in range(2):
            solver.step()
        back = np.argsort(order)
        velocity = [solver.get_field("uvw"[back[n]]).transpose(back) for n in range(3)]
        results.append((velocity, solver.hydro_force_torque_reaction()[:, 0][:, back]))
    for (velocity, load), (other_velocity, other_load) in itertools.pairwise(results):
        np.testing.assert_allclose(velocity, other_velocity, atol=1e-8)
        np.testing.assert_allclose(load, other_load, rtol=1e-5, atol=1e-6)


def test_the_parts_of_a_step_add_up_to_its_time():
    solver = flow.Solver(16, 14, 18)
    box_with(solver, ((5.3, 6.1, 7.8), 2.7, (0.1, 0, 0)))
    solver.step()
    begin = time.perf_counter()
    solver.step()
    whole = time.perf_counter() - begin
    parts = solver.last_step_timers()
    assert set(parts) == {"geometry", "momentum", "viscous", "pressure", "loads", "rest"}
    assert parts["geometry"] == 0  # nothing moved
    assert min(parts.values()) >= 0
    assert sum(parts.values()) <= whole
    solver.set_instance_transform(0, [5.4, 6.1, 7.8])
    solver.rebuild_geometry()
    solver.step()
    assert solver.last_step_timers()["geometry"] > 0
