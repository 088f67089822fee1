"""The calls of peclet.dem in both generations: forms, shapes, dtypes, lifetimes."""

import gc
import threading

import numpy as np
import pytest
from peclet import dem

from tests.python.dem_scenes import BOX, leaf, spheres
from tests.python.views import needs_readable_views


def test_state_starts_at_its_defaults_and_grows_beyond_the_capacity():
    sim = dem.Simulation(2)
    sim.set_sphere_shape(2.0)
    sim.set_positions(np.arange(15, dtype=np.float32).reshape(5, 3))
    assert sim.num_particles == 5
    assert sim.num_particles() == 5
    assert sim.capacity >= 5
    np.testing.assert_array_equal(sim.get_positions(), np.arange(15).reshape(5, 3))
    np.testing.assert_array_equal(sim.get_velocities(), np.zeros((5, 3)))
    np.testing.assert_array_equal(sim.get_angular_velocities(), np.zeros((5, 3)))
    np.testing.assert_array_equal(sim.get_quaternions(), np.tile([0, 0, 0, 1], (5, 1)))
    np.testing.assert_array_equal(sim.get_scales(), np.ones(5))
    np.testing.assert_array_equal(sim.get_masses(), np.ones(5))
    np.testing.assert_array_equal(sim.get_inv_inertia(), np.full((5, 3), 2.5 / 4))


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_inputs_may_have_any_dtype_and_order(dtype, order):
    rows = np.asarray(np.arange(12).reshape(4, 3), dtype=dtype, order=order)
    sim = spheres(*rows)
    sim.set_velocities(rows[::-1])
    np.testing.assert_array_equal(sim.get_positions(), rows)
    np.testing.assert_array_equal(sim.get_velocities(), rows[::-1])
    assert sim.get_positions().dtype == np.float64


def test_fourth_column_is_the_inverse_mass():
    sim = spheres([0, 0, 0, 0.5], [5, 0, 0, 0])
    np.testing.assert_array_equal(sim.get_masses(), [2, np.inf])
    sim.set_gravity(0, 0, -10)
    sim.step(0.1)
    np.testing.assert_allclose(sim.get_positions(), [[0, 0, -0.05], [5, 0, 0]], atol=1e-15)


@needs_readable_views
def test_getters_return_copies_and_views_the_memory():
    sim = spheres([1, 2, 3])
    sim.get_positions()[0] = 9
    assert sim.get_positions()[0, 0] == 1
    sim.get_positions_view()[0] = 9
    sim.get_velocities_view()[0, 1] = 2
    sim.get_external_forces_view()[0, 2] = 4
    sim.get_inv_mass_view()[0] = 0.5
    sim.step(1.0)
    np.testing.assert_allclose(sim.get_positions(), [[9, 11, 10]])


@needs_readable_views
def test_views_outlive_the_simulation():
    view = spheres([1, 2, 3]).get_positions_view()
    gc.collect()
    np.testing.assert_array_equal(view, [[1, 2, 3]])


@needs_readable_views
def test_what_views_wrote_is_checked_by_the_next_step():
    sim = spheres([1, 2, 3])
    sim.get_velocities_view()[0, 1] = np.nan
    with pytest.raises(RuntimeError, match="velocities"):
        sim.step(0.1)
    assert sim.time == 0


def test_setting_positions_forgets_motion_but_keeps_loads_of_as_many_particles():
    sim = spheres([0, 0, 0])
    sim.set_external_forces([[1, 0, 0]])
    sim.set_velocities([[5, 0, 0]])
    sim.set_positions([[0, 0, 0]])
    sim.step(1.0)
    assert sim.get_velocities()[0, 0] == 1


def test_loads_act_until_cleared():
    sim = spheres([0, 0, 0])
    sim.set_inv_mass([0.5])
    sim.set_inv_inertia([[2, 3, 4]])
    sim.set_external_forces([[1, 0, 0]])
    sim.set_external_torques([[0, 0, 1]])
    sim.step(0.1)
    assert sim.get_positions()[0, 0] == pytest.approx(0.0025, abs=1e-17)
    assert sim.get_angular_velocities()[0, 2] == pytest.approx(0.4, abs=1e-15)
    sim.clear_external_forces()
    sim.clear_external_torques()
    sim.step(0.1)
    assert sim.get_velocities()[0, 0] == pytest.approx(0.05, abs=1e-16)
    assert sim.get_angular_velocities()[0, 2] == pytest.approx(0.4, abs=1e-15)


def test_inertia_follows_mass_and_radius_until_it_is_set():
    sim = spheres([0, 0, 0], radius=2.0)
    sim.set_scales([0.5])
    sim.set_inv_mass([0.25])
    np.testing.assert_allclose(sim.get_inv_inertia(), [[0.625] * 3])
    sim.set_inv_inertia([[1, 2, 3]])
    sim.set_inv_mass([1])
    np.testing.assert_array_equal(sim.get_inv_inertia(), [[1, 2, 3]])


def test_gravity_takes_three_numbers_or_a_sequence():
    sim = dem.Simulation(1)
    sim.set_gravity(0, -1, 2.5)
    assert sim.gravity == (0, -1, 2.5)
    sim.set_gravity(np.array([3, 4, 5], dtype=np.float32))
    assert sim.gravity == (3, 4, 5)


def test_domain_takes_all_forms():
    sim = dem.Simulation(1)
    assert sim.extent == (0, 0, 0)
    sim.set_domain(4.0, 5.0, 6.0)
    assert (sim.extent, sim.origin, sim.periodic) == ((4, 5, 6), (0, 0, 0), (True, True, False))
    sim.set_domain(4.0, 5.0, 6.0, False, pz=True)
    assert sim.periodic == (False, True, True)
    sim.set_domain((1, 2, 3), (2, 4, 6))
    assert (sim.origin, sim.extent, sim.periodic) == ((1, 2, 3), (1, 2, 3), (False, True, True))
    assert sim.get_domain_min() == (1, 2, 3)
    assert sim.get_domain_max() == (2, 4, 6)
    sim.set_domain((7, 8, 9))
    assert (sim.origin, sim.extent, sim.periodic) == ((0, 0, 0), (7, 8, 9), (True, True, False))
    sim.set_domain(extent=(7, 8, 9), origin=(1, 1, 1), periodic=(False, False, True))
    assert (sim.origin, sim.periodic) == ((1, 1, 1), (False, False, True))
    sim.enable_periodicity(True, False, False)
    assert sim.periodic == (True, False, False)


def test_step_takes_a_length_or_a_count():
    sim = spheres([0, 0, 0])
    sim.set_gravity(1, 0, 0)
    sim.step(0.5)
    assert sim.time == 0.5
    sim.step(1)
    assert sim.time == 1.5
    sim.set_dt(0.25)
    assert sim.dt == 0.25
    sim.step()
    sim.step(2)
    assert sim.time == 2.25
    sim.step(0.5)
    assert sim.time == 2.75
    assert sim.get_velocities()[0, 0] == pytest.approx(2.75)


def test_step_zero_and_relax_only_remove_overlap():
    for relax in (lambda s: s.step(0), lambda s: s.step(0.0), lambda s: s.step(), lambda s: s.relax(1)):
        sim = spheres([0, 0, 0], [0.6, 0, 0])
        sim.set_inv_mass([1, 3])
        sim.set_velocities([[1, 0, 0], [-1, 0, 0]])
        relax(sim)
        np.testing.assert_allclose(sim.get_positions()[:, 0], [-0.1, 0.9], atol=1e-15)
        np.testing.assert_array_equal(sim.get_velocities()[:, 0], [1, -1])
        assert sim.time == 0


def test_position_only_contact_leaves_velocities_alone():
    sim = spheres([0, 0, 0], [1.1, 0, 0])
    sim.set_solver_iterations(10, 0)
    sim.set_velocities([[1, 0, 0], [-1, 0, 0]])
    for _ in range(20):
        sim.step(0.01)
    np.testing.assert_array_equal(sim.get_velocities()[:, 0], [1, -1])
    assert np.diff(sim.get_positions()[:, 0])[0] == pytest.approx(1, abs=1e-4)
    resting = spheres([0, 0, 0.5])
    resting.set_solver_iterations(10, 0)
    resting.set_gravity(0, 0, -10)
    resting.add_plane((0, 0, 0), (0, 0, 1))
    for _ in range(210):
        resting.step(0.01)
    assert resting.get_velocities()[0, 2] == pytest.approx(-21)
    assert resting.get_positions()[0, 2] == pytest.approx(0.5, abs=1e-4)


def test_contact_numbers_read_as_values_and_as_calls():
    sim = spheres([0, 0, 0], [0.9, 0, 0], [3, 0, 0])
    assert sim.num_contacts == sim.num_contacts() == sim.get_num_contacts() == sim.num_manifolds == 1
    assert sim.max_overlap == pytest.approx(0.1)
    assert sim.max_overlap() == sim.get_max_overlap() == sim.compute_overlaps() == sim.max_overlap
    assert sim.num_shapes == 1
    assert isinstance(sim.num_contacts, int)
    assert isinstance(sim.max_overlap, float)


@pytest.mark.parametrize("form", ["initialize_shape", "initialize", "code"])
def test_spheres_by_every_name(form):
    sim = dem.Simulation(1)
    if form == "code":
        sim.initialize(1, 0.5)
    else:
        getattr(sim, form)("sphere", 0.5)
    sim.set_positions([[0, 0, 0]])
    np.testing.assert_array_equal(sim.get_inv_inertia(), [[10, 10, 10]])


def test_no_particles_are_particles_too():
    sim = spheres()
    sim.set_positions(np.zeros((0, 3)))
    sim.step(0.1)
    assert (sim.num_particles, sim.num_contacts, sim.max_overlap) == (0, 0, 0.0)
    assert sim.get_positions().shape == (0, 3)


def test_steps_release_the_interpreter():
    sim = spheres(*(1.01 * np.stack(np.meshgrid(*[np.arange(20)] * 3), -1).reshape(-1, 3)))
    finished = threading.Event()

    def work():
        for _ in range(5):
            sim.step(0.01)
        finished.set()

    worker = threading.Thread(target=work)
    worker.start()
    beats = 0
    while not finished.wait(1e-4):
        beats += 1
    worker.join()
    assert beats > 0


def test_module_constants():
    assert dem.execution_space in ("OpenMP", "Serial", "Cuda")
    dem.finalize()
    dem.finalize()
    assert "1 particles" in repr(spheres([0, 0, 0]))


def test_diagnostics_of_energy_momentum_and_contacts():
    sim = spheres([0, 0, 0.5], [3, 0, 1])
    sim.set_inv_mass([0.5, 0.25])
    sim.set_velocities([[1, 0, 0], [0, 2, 0]])
    sim.set_angular_velocities([[0, 0, 3], [0, 0, 0]])
    inertia = 0.4 * 2 * 0.25
    assert sim.diagnostics.kinetic_energy() == pytest.approx(1 + 8 + 0.5 * inertia * 9)
    np.testing.assert_allclose(sim.diagnostics.linear_momentum(), [2, 8, 0])
    np.testing.assert_allclose(sim.diagnostics.angular_momentum(), [-8, 1, 24 + 3 * inertia])
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.step(0.01)
    contacts = sim.diagnostics.contacts()
    np.testing.assert_array_equal(contacts["bodies"], [[0, -1]])
    np.testing.assert_array_equal(contacts["normal"], [[0, 0, 1]])
    assert sim.debug_coloring_conflicts() == sim.diagnostics.coloring_conflicts() == (0, 1)
    assert set(sim.get_profiling_info()) == {"search_seconds", "velocity_seconds", "position_seconds"}
    assert sim.diagnostics.solver_report()["force_sweeps"] >= 1
    np.testing.assert_array_equal(
        sim.diagnostics.wall_sdf_at(sim.add_analytic_wall(*leaf(BOX, 1, 1, 1), 0, False), [[0, 0, 3]]), [2]
    )
