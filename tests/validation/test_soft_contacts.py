"""Elastic contacts against closed forms: Hertz impact, restitution, rest, friction and rolling, to 1e-3."""

import numpy as np
import pytest
from peclet import dem

G = 9.81
RADIUS, YOUNG, POISSON = 0.5, 1e7, 0.3
STIFFNESS = YOUNG / (2 * (1 - POISSON**2))  # E* of two such bodies
TOLERANCE = 1e-3
ALUMINA = {"youngs": 380e9, "poisson": 0.23}  # Chung & Ooi, test 4: 5 mm spheres, e = 0.98, mu = 0.092


def sphere_on_plane(*, gravity=(0, 0, -G), velocity=(0, 0, 0), spin=(0, 0, 0), **material):
    """A sphere of unit mass on the plane z = 0, as deep in it as its weight presses it."""
    overlap = (3 * abs(gravity[2]) / (4 * STIFFNESS * np.sqrt(RADIUS))) ** (2 / 3)
    sim = dem.Simulation(1)
    sim.set_sphere_shape(RADIUS)
    sim.set_hertz_material(0, YOUNG, POISSON)
    sim.set_material_params(**{"restitution_normal": 0.5} | material)
    sim.set_gravity(gravity)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.set_positions([[0, 0, RADIUS - overlap]])
    sim.set_velocities([velocity])
    sim.set_angular_velocities([spin])
    return sim


def run(sim, duration, dt=2e-4):
    substeps = round(duration / dt)
    sim.step_hertz(duration / substeps, substeps)
    return sim


@pytest.mark.parametrize("masses", [(1.0, 1.0), (1.0, 3.0)])
def test_elastic_impact_takes_the_time_and_the_depth_of_hertz(masses):
    radii = np.array([0.5, 0.8])
    mass = 1 / np.sum(1 / np.array(masses))
    radius, speed = 1 / np.sum(1 / radii), 0.3
    duration = 2.86827 * (mass**2 / (radius * STIFFNESS**2 * speed)) ** 0.2
    depth = (15 * mass * speed**2 / (16 * np.sqrt(radius) * STIFFNESS)) ** 0.4
    sim = dem.Simulation(2)
    sim.set_sphere_shape(1.0)
    sim.set_hertz_material(0, YOUNG, POISSON)
    sim.set_material_params(1.0)
    sim.set_positions([[0, 0, 0], [radii.sum(), 0, 0]])
    sim.set_scales(radii)
    sim.set_inv_mass(1 / np.array(masses))
    sim.set_velocities([[speed, 0, 0], [0, 0, 0]])
    overlaps = [0.0]
    while overlaps[-1] > 0 or len(overlaps) == 1:
        sim.step_hertz(duration / 2000)
        overlaps.append(float(radii.sum() - np.diff(sim.get_positions()[:, 0])[0]))
    assert (len(overlaps) - 1) / 2000 == pytest.approx(1, abs=TOLERANCE)
    assert max(overlaps) == pytest.approx(depth, rel=TOLERANCE)
    before, after = np.array([speed, 0]), sim.get_velocities()[:, 0]
    assert masses @ after == pytest.approx(masses @ before, rel=1e-12)
    assert after[1] - after[0] == pytest.approx(speed, rel=1e-6)


@pytest.mark.parametrize("speed", [0.01, 1.0])
@pytest.mark.parametrize("restitution", [0.05, 0.2, 0.5, 0.9])
def test_restitution_is_as_given_at_any_speed(restitution, speed):
    sim = dem.Simulation(2)
    sim.set_sphere_shape(RADIUS)
    sim.set_hertz_material(0, YOUNG, POISSON)
    sim.set_material_params(restitution)
    sim.set_positions([[0, 0, 0], [0, 2 * RADIUS, 0]])
    sim.set_velocities([[0, speed, 0], [0, 0, 0]])
    dt = sim.hertz_times().impact / 400
    sim.step_hertz(dt, 1)
    while len(sim.diagnostics.contacts()["gap"]):
        sim.step_hertz(dt, 10)
    assert np.diff(sim.get_velocities()[:, 1])[0] == pytest.approx(restitution * speed, rel=TOLERANCE)


def test_sphere_on_a_wall_rests_at_the_overlap_that_carries_it():
    sim = sphere_on_plane()
    depth = RADIUS - sim.get_positions()[0, 2]
    sim.set_positions([[0, 0, RADIUS]])
    run(sim, 1.0)
    assert RADIUS - sim.get_positions()[0, 2] == pytest.approx(depth, rel=1e-6)


def test_sliding_sphere_starts_to_roll():
    friction, speed = 0.3, 2.0
    time = 2 * speed / (7 * friction * G)
    sim = run(sphere_on_plane(velocity=(speed, 0, 0), friction=friction), time)
    assert sim.get_positions()[0, 0] == pytest.approx(12 * speed**2 / (49 * friction * G), rel=TOLERANCE)
    assert sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * speed, rel=TOLERANCE)
    run(sim, time)
    assert sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * speed, rel=TOLERANCE)
    assert sim.get_angular_velocities()[0, 1] * RADIUS == pytest.approx(5 / 7 * speed, rel=TOLERANCE)


@pytest.mark.parametrize(("angle", "friction"), [(0.3, 0.5), (0.8, 0.1)])
def test_sphere_on_an_incline_rolls_or_slides(angle, friction):
    gravity = (G * np.sin(angle), 0, -G * np.cos(angle))
    sim = run(sphere_on_plane(gravity=gravity, friction=friction), 1.0)
    speed, spin = sim.get_velocities()[0, 0], sim.get_angular_velocities()[0, 1]
    if np.tan(angle) <= 3.5 * friction:
        assert speed == pytest.approx(5 / 7 * G * np.sin(angle), rel=TOLERANCE)
        assert spin * RADIUS == pytest.approx(speed, rel=TOLERANCE)
    else:
        assert speed == pytest.approx(G * (np.sin(angle) - friction * np.cos(angle)), rel=TOLERANCE)
        assert spin == pytest.approx(5 * friction * G * np.cos(angle) / (2 * RADIUS), rel=TOLERANCE)


@pytest.mark.parametrize("holds", ["infinite inertia", "rolling friction"])
def test_what_cannot_roll_sticks_to_an_incline_without_creeping(holds):
    gravity = (G * np.sin(0.3), 0, -G * np.cos(0.3))
    rolling = 0.4 if holds == "rolling friction" else 0.0
    sim = sphere_on_plane(gravity=gravity, friction=0.5, rolling_friction=rolling)
    if holds == "infinite inertia":
        sim.set_inv_inertia([[0, 0, 0]])
    run(sim, 2.0)
    before = sim.get_positions()
    run(sim, 2.0)
    np.testing.assert_allclose(sim.get_positions(), before, rtol=0, atol=1e-12)
    assert abs(before[0, 0]) < 1e-3 * RADIUS


def test_block_slides_down_a_steep_incline():
    gravity = (G * np.sin(0.6), 0, -G * np.cos(0.6))
    sim = sphere_on_plane(gravity=gravity, friction=0.2)
    sim.set_inv_inertia([[0, 0, 0]])
    run(sim, 1.0)
    expected = G * (np.sin(0.6) - 0.2 * np.cos(0.6))
    assert sim.get_velocities()[0, 0] == pytest.approx(expected, rel=TOLERANCE)


def test_rolling_friction_slows_a_rolling_sphere():
    """Moment mu_r R m g on a sphere that rolls: a = 5/7 mu_r g."""
    sim = sphere_on_plane(velocity=(1, 0, 0), spin=(0, 1 / RADIUS, 0), friction=0.5, rolling_friction=0.05)
    run(sim, 1.0)
    assert 1 - sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * 0.05 * G, rel=TOLERANCE)


@pytest.mark.parametrize("angle", [45, 60, 80])
def test_oblique_impact_slides(angle):
    """psi2 = psi1 - 7/2 mu (1 + e), at speeds so low that spheres stay spheres."""
    restitution, friction, radius, speed = 0.98, 0.092, 2.5e-3, 0.01
    approach, tangential = speed * np.cos(np.radians(angle)), speed * np.sin(np.radians(angle))
    sim = dem.Simulation(1)
    sim.set_sphere_shape(radius)
    sim.set_hertz_material(0, **ALUMINA)
    sim.set_material_params(restitution, friction=friction)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.set_positions([[0, 0, radius]])
    sim.set_inv_mass([1 / (4000 * 4 / 3 * np.pi * radius**3)])
    sim.set_velocities([[tangential, 0, -approach]])
    dt = min(sim.hertz_times().impact / 400, 0.3 * sim.hertz_times().rayleigh)
    sim.step_hertz(dt, 1)
    while len(sim.diagnostics.contacts()["gap"]):
        sim.step_hertz(dt, 10)
    velocity, spin = sim.get_velocities()[0], sim.get_angular_velocities()[0]
    assert velocity[2] == pytest.approx(restitution * approach, rel=TOLERANCE)
    departure = (velocity[0] - radius * spin[1]) / approach
    expected = tangential / approach - 3.5 * friction * (1 + restitution)
    assert departure == pytest.approx(expected, abs=TOLERANCE)


def test_many_contacts_keep_momentum_and_angular_momentum():
    rng = np.random.default_rng(4)
    count = 40
    sim = dem.Simulation(count)
    sim.set_sphere_shape(RADIUS)
    sim.set_hertz_material(0, YOUNG, POISSON)
    sim.set_material_params(0.7, friction=0.4, rolling_friction=0.1)
    sim.set_positions(rng.uniform(0, 3.2, (count, 3)))
    sim.set_scales(rng.uniform(0.5, 1.0, count))
    sim.set_inv_mass(rng.uniform(0.5, 2.0, count))
    sim.set_angular_velocities(rng.normal(size=(count, 3)))
    linear, angular = sim.diagnostics.linear_momentum(), sim.diagnostics.angular_momentum()
    sim.step_hertz(2e-4, 300)
    assert np.abs(sim.get_velocities()).max() > 10  # the heap flies apart
    scale = np.abs(sim.get_velocities()).sum()
    np.testing.assert_allclose(sim.diagnostics.linear_momentum(), linear, atol=1e-13 * scale)
    np.testing.assert_allclose(sim.diagnostics.angular_momentum(), angular, atol=1e-12 * scale)


def test_wall_under_a_stack_carries_its_weight():
    count = 5
    sim = dem.Simulation(count)
    sim.set_sphere_shape(RADIUS)
    sim.set_hertz_material(0, YOUNG, POISSON)
    sim.set_material_params(0.1)
    sim.set_gravity(0, 0, -G)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.set_positions([[0, 0, RADIUS + 2 * RADIUS * k] for k in range(count)])
    run(sim, 4.0)
    contacts = sim.diagnostics.contacts()
    on_wall = contacts["impulse"][contacts["bodies"][:, 1] < 0].sum(axis=0) / 2e-4
    np.testing.assert_allclose(on_wall, [0, 0, count * G], rtol=TOLERANCE, atol=1e-12)
