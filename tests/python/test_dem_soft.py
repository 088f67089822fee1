"""Elastic contacts of peclet.dem: calls, what is kept between substeps, walls, periodic boxes."""

import warnings

import numpy as np
import pytest
from peclet import dem

from tests.python.dem_scenes import BOX, leaf, spheres

YOUNG, POISSON, DT = 1e6, 0.3, 2e-4


def soft_spheres(*positions, **arguments):
    sim = spheres(*positions, **arguments)
    sim.set_hertz_material(0, YOUNG, POISSON)
    return sim


def heap(shift=0.0):
    """Overlapping spheres of different sizes in a periodic box, with friction."""
    generator = np.random.default_rng(3)
    sites = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    positions = sites + generator.uniform(-0.05, 0.05, sites.shape)
    sim = soft_spheres(*((positions + shift) % 4))
    sim.set_domain((4, 4, 4), periodic=(True, True, True))
    sim.set_material_params(0.5, friction=0.3, rolling_friction=0.05)
    sim.set_scales(generator.uniform(0.9, 1.05, len(sites)))
    sim.set_velocities(generator.normal(size=sites.shape))
    return sim


def state(sim):
    return np.hstack([sim.get_positions(), sim.get_velocities(), sim.get_angular_velocities()])


def test_both_generations_step_alike():
    sims = [heap() for _ in range(4)]
    sims[0].step_hertz(DT, 20)
    sims[1].step_hertz(dt=DT, substeps=20, skin_frac=0.3)
    sims[2].set_dt(DT)
    sims[2].step_hertz(20)
    sims[3].set_dt(DT)
    for _ in range(20):
        sims[3].step_hertz()
    for sim in sims:
        assert sim.time == pytest.approx(20 * DT)
        np.testing.assert_allclose(state(sim), state(sims[0]), rtol=0, atol=1e-9)


def test_free_flight_is_exact():
    sim = soft_spheres([0, 0, 5])
    sim.set_gravity(0, 0, -10)
    sim.step_hertz(1e-4, 1000)
    np.testing.assert_allclose(sim.get_positions()[0], [0, 0, 5 - 0.5 * 10 * 0.01], rtol=1e-13)
    np.testing.assert_allclose(sim.get_velocities()[0], [0, 0, -1], rtol=1e-12)


def test_skin_of_the_neighbour_list_does_not_matter():
    one, other = heap(), heap()
    one.step_hertz(DT, 150, 0.02)
    other.step_hertz(DT, 150, 1.5)
    np.testing.assert_allclose(state(one), state(other), rtol=0, atol=1e-9)


def test_results_do_not_depend_on_where_the_box_is_cut():
    one, other = heap(), heap(1.7)
    for sim in (one, other):
        sim.step_hertz(DT, 150)
    difference = other.get_positions() - one.get_positions() - 1.7
    assert np.abs((difference + 2) % 4 - 2).max() < 1e-9
    np.testing.assert_allclose(other.get_velocities(), one.get_velocities(), atol=1e-7)
    assert (one.get_positions() >= 0).all()
    assert (one.get_positions() < 4).all()


def test_springs_outlive_the_neighbour_list():
    """A block that friction holds on a slope does not move when the list is made anew in each substep."""
    sim = soft_spheres([0, 0, 0.5])
    sim.set_material_params(0.3, friction=0.6)
    sim.set_gravity(4, 0, -9)
    sim.set_inv_inertia([[0, 0, 0]])
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.step_hertz(DT, 20000)
    before = sim.get_positions()
    for _ in range(200):
        sim.set_pair_material(0, 0, 0.3, 0.6)
        sim.step_hertz(DT, 1)
    np.testing.assert_allclose(sim.get_positions(), before, rtol=0, atol=1e-12)


def test_pair_in_contact_may_change_its_order():
    """The larger sphere names the pair; friction goes on where the smaller one grows past it."""
    sim = soft_spheres([0, 0, 0], [0, 0, 0.98])
    sim.set_material_params(0.3, friction=10.0)
    sim.set_inv_mass([0, 1])
    sim.set_inv_inertia(np.zeros((2, 3)))
    sim.set_external_forces([[0, 0, 0], [100, 0, -1000]])
    sim.set_scales([1.0, 1.0 - 1e-9])
    sim.step_hertz(DT, 20000)
    before = sim.get_positions()
    sim.set_scales([1.0 - 1e-9, 1.0])
    sim.step_hertz(DT, 200)
    np.testing.assert_allclose(sim.get_positions(), before, rtol=0, atol=1e-6)
    assert np.abs(sim.get_velocities()).max() < 1e-4


def test_tank_holds_a_sphere_in_its_corner():
    sim = soft_spheres([0.3, -0.2, 0.1])
    sim.set_hertz_material(0, 1e7, POISSON)
    sim.add_analytic_wall(*leaf(BOX, 2, 3, 4), 0, True, 0.2, 0.1)
    sim.set_gravity(-3, -4, -12)
    sim.step_hertz(DT, 30000)
    np.testing.assert_allclose(sim.get_positions(), [[-1.5, -2.5, -3.5]], atol=2e-4)
    contacts = sim.diagnostics.contacts()
    np.testing.assert_allclose(contacts["impulse"].sum(axis=0) / DT, [3, 4, 12], rtol=1e-6)
    assert len(contacts["gap"]) == 3


def test_moving_wall_carries():
    sim = soft_spheres([0, 0, 1.5])
    wall = sim.add_analytic_wall(*leaf(BOX, 50, 50, 1), 0, False, friction=1.0)
    sim.set_gravity(0, 0, -10)
    sim.set_inv_inertia([[0, 0, 0]])
    sim.set_wall_velocity(wall, (0.7, 0, 0))
    sim.step_hertz(DT, 5000)
    assert sim.get_velocities()[0, 0] == pytest.approx(0.7, rel=1e-6)


def test_wall_may_be_pushed_into_a_sphere():
    sim = soft_spheres([0, 0, 1.6])
    wall = sim.add_analytic_wall(*leaf(BOX, 5, 5, 1), 0, False, restitution=1.0)
    sim.set_wall_velocity(wall, (0, 0, 0.5))
    dt = 0.5 * DT
    for n in range(6000):
        sim.set_wall_transform(wall, (0, 0, 0.5 * dt * (n + 0.5)))
        sim.step_hertz(dt)
    assert sim.get_velocities()[0, 2] == pytest.approx(1.0, rel=1e-3)


def test_materials_by_id_and_softer_bodies_sink_deeper():
    depths = []
    for young in (1e5, 1e6):
        sim = soft_spheres([0, 0, 0.5])
        sim.set_hertz_material(3, young, POISSON)
        sim.set_material_ids([3])
        sim.set_pair_material(3, 0, 0.1, 0.0)
        sim.set_gravity(0, 0, -10)
        sim.add_plane((0, 0, 0), (0, 0, 1))
        sim.step_hertz(DT, 20000)
        depths.append(0.5 - sim.get_positions()[0, 2])
    compliance = np.array([1 / 1e5 + 1 / YOUNG, 2 / YOUNG])
    assert depths[0] / depths[1] == pytest.approx((compliance[0] / compliance[1]) ** (2 / 3), rel=1e-6)


def test_long_substeps_are_refused_or_warned_of():
    sim = soft_spheres([0, 0, 0], [2, 0, 0])
    sim.set_velocities([[1, 0, 0], [-1, 0, 0]])
    times = sim.hertz_times()
    assert times.rayleigh > 0
    assert times.impact > 0
    before = state(sim)
    with pytest.raises(ValueError, match="dt: expected at most the Rayleigh time"):
        sim.step_hertz(1.01 * times.rayleigh)
    np.testing.assert_array_equal(state(sim), before)
    with pytest.warns(RuntimeWarning, match="resolves contacts badly"):
        sim.step_hertz(0.9 * times.rayleigh)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.step_hertz(0.05 * times.rayleigh)


def test_rigid_and_elastic_steps_may_take_turns():
    sim = soft_spheres([0, 0, 0.5])
    sim.set_gravity(0, 0, -10)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.step_hertz(DT, 5000)
    for _ in range(100):
        sim.step(1e-3)
    assert sim.get_positions()[0, 2] == pytest.approx(0.5, abs=1e-5)
    sim.step_hertz(DT, 5000)
    assert sim.diagnostics.contacts()["impulse"].sum() / DT == pytest.approx(10, rel=1e-3)
    assert sim.diagnostics.coloring_conflicts() == (0, 0)


def test_soft_contacts_of_particles_beyond_the_capacity():
    sim = soft_spheres([0, 0, 0])
    sim.step_hertz(DT, 10)
    sim.set_positions([[0.99 * n, 0, 0] for n in range(200)])
    sim.step_hertz(DT, 10)
    speeds = sim.get_velocities()[:, 0]
    assert speeds[0] < 0 < speeds[-1]
    np.testing.assert_allclose(speeds, -speeds[::-1], atol=1e-9)


def test_no_particles_step_softly():
    sim = dem.Simulation(1)
    sim.set_sphere_shape(0.5)
    sim.step_hertz(0.1, 3)
    assert sim.time == pytest.approx(0.3)
    assert sim.hertz_times() == (np.inf, np.inf)


def test_failing_substep_leaves_the_state_before_it():
    sim = soft_spheres([0, 0, 0], [0.9, 0, 0])
    sim.set_inv_mass([10, 10])
    sim.set_external_forces([[1e308, 0, 0], [1e308, 0, 0]])
    before = state(sim)
    with pytest.raises(RuntimeError, match="finite"):
        sim.step_hertz(0.1 * sim.hertz_times().rayleigh, 5)
    np.testing.assert_array_equal(state(sim), before)
    assert sim.time == 0


def test_growing_particles():
    sim = spheres([0, 0, 0], [10, 0, 0])
    sim.set_growth_params(0.5)
    assert sim.get_growth_factor() == sim.growth_factor == 0.01
    for _ in range(3):
        sim.step(0.1)
    np.testing.assert_allclose(sim.get_scales(), 0.01 * np.exp(0.15))
    sim.set_growth_params(0.5, 0.99)
    sim.step(0.1)
    np.testing.assert_allclose(sim.get_scales(), 1.0)
    assert (sim.growth_factor, sim.growth_rate, sim.get_growth_rate()) == (1.0, 0.5, 0.5)
    np.testing.assert_allclose(sim.get_masses(), 1.0)
    sim.set_global_scale(3.0)
    assert sim.global_scale == sim.global_scale() == 3.0
    sim.set_positions([[0, 0, 0], [2.9, 0, 0]])
    assert sim.max_overlap == pytest.approx(0.1)


def test_calls_of_scripts_that_choose_a_solver_are_accepted():
    sim = spheres([0, 0, 0])
    sim.set_stabilization(True)
    assert sim.stabilization == "onesided"
    sim.set_stabilization_mode("off")
    assert sim.stabilization == "off"
    sim.set_velocity_use_gs(False)
    assert sim.diagnostics.velocity_solver == "jacobi"
    sim.diagnostics.set_velocity_solver("gs")
