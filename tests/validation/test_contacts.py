"""Contacts against closed forms: bounces, collisions, friction and rolling, each to 1e-3."""

import numpy as np
import pytest
from peclet import dem

G = 9.81
RADIUS = 0.5
TOLERANCE = 1e-3


def sphere_on_plane(height, *, velocity=(0, 0, 0), spin=(0, 0, 0), gravity=(0, 0, -G), **material):
    """One sphere above the plane z = 0, its lowest point at height."""
    sim = dem.Simulation(1)
    sim.set_sphere_shape(RADIUS)
    sim.set_gravity(gravity)
    sim.set_material_params(**{"restitution_normal": 0.0} | material)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.set_positions([[0, 0, RADIUS + height]])
    sim.set_velocities([velocity])
    sim.set_angular_velocities([spin])
    return sim


def run(sim, duration, dt=1e-3):
    steps = round(duration / dt)
    for _ in range(steps):
        sim.step(duration / steps)
    return sim


def apexes(sim, duration, dt):
    """Heights of the lowest point of the sphere where it turns."""
    found, rising = [], False
    for _ in range(round(duration / dt)):
        sim.step(dt)
        z, v = sim.get_positions()[0, 2], sim.get_velocities()[0, 2]
        if rising and v <= 0:
            found.append(z - RADIUS + v * v / (2 * G))
        rising = v > 0
    return np.array(found)


@pytest.mark.parametrize("dt", [1e-3, 7e-3])
@pytest.mark.parametrize("restitution", [0.5, 0.8, 1.0])
def test_bouncing_ball_loses_the_square_of_the_restitution(restitution, dt):
    found = apexes(sphere_on_plane(1.0, restitution_normal=restitution), 2.2, dt)[:3]
    bounces = np.arange(1, len(found) + 1)
    assert len(found) >= 2
    np.testing.assert_allclose(found, restitution ** (2 * bounces), rtol=TOLERANCE)


def test_bouncing_ball_comes_to_rest_on_the_plane():
    restitution = 0.5
    sim = sphere_on_plane(1.0, restitution_normal=restitution)
    total = np.sqrt(2 / G) * (1 + restitution) / (1 - restitution)
    run(sim, 1.01 * total)
    assert abs(sim.get_velocities()[0, 2]) < 1e-9
    assert sim.get_positions()[0, 2] == pytest.approx(RADIUS, abs=1e-4)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("masses", [(1.0, 1.0), (1.0, 4.0)])
def test_head_on_collision(restitution, masses):
    masses = np.array(masses)
    sim = dem.Simulation(2)
    sim.set_sphere_shape(RADIUS)
    sim.set_material_params(restitution)
    sim.set_positions([[-1, 0, 0], [1.1, 0, 0]])
    sim.set_inv_mass(1 / masses)
    before = np.array([1.0, -0.7])
    sim.set_velocities([[before[0], 0, 0], [before[1], 0, 0]])
    run(sim, 1.5, 7e-3)
    after = sim.get_velocities()[:, 0]
    assert masses @ after == pytest.approx(masses @ before, abs=1e-14)
    reduced = masses.prod() / masses.sum()
    loss = 0.5 * masses @ (before**2 - after**2)
    assert loss == pytest.approx(0.5 * reduced * (1 - restitution**2) * 1.7**2, rel=TOLERANCE, abs=1e-12)
    assert after[1] - after[0] == pytest.approx(restitution * 1.7, rel=TOLERANCE, abs=1e-12)
    assert sim.max_overlap == pytest.approx(0, abs=1e-12)


def test_spheres_pushed_together_share_their_speed_and_do_not_overlap():
    sim = dem.Simulation(2)
    sim.set_sphere_shape(RADIUS)
    sim.set_positions([[300.0, 300, 300], [301.5, 300, 300]])
    sim.set_inv_mass([1, 0.5])
    sim.set_external_forces([[2, 0, 0], [-1, 0, 0]])
    largest = 0.0
    for _ in range(300):
        sim.step(0.01)
        largest = max(largest, sim.max_overlap)
    after = sim.get_velocities()[:, 0]
    assert after[0] == pytest.approx(after[1], abs=1e-12)
    assert after @ [1, 2] == pytest.approx(3.0 * 1.0, rel=1e-12)  # the net force 1 for 3 time units
    assert largest < 1e-3 * 2 * RADIUS


def test_sliding_sphere_starts_to_roll():
    friction, speed = 0.3, 2.0
    time = 2 * speed / (7 * friction * G)
    distance = 12 * speed**2 / (49 * friction * G)
    sim = sphere_on_plane(0.0, velocity=(speed, 0, 0), friction=friction)
    run(sim, time, time / 200)
    assert sim.get_positions()[0, 0] == pytest.approx(distance, rel=TOLERANCE)
    assert sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * speed, rel=TOLERANCE)
    run(sim, time)
    assert sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * speed, rel=1e-9)
    assert sim.get_angular_velocities()[0, 1] * RADIUS == pytest.approx(5 / 7 * speed, rel=1e-9)
    assert sim.get_positions()[0, 0] == pytest.approx(distance + 5 / 7 * speed * time, rel=TOLERANCE)


def test_back_spin_reverses_the_sphere():
    speed, back_spin = 1.0, 8.0
    sim = sphere_on_plane(0.0, velocity=(speed, 0, 0), spin=(0, -back_spin, 0), friction=0.2)
    run(sim, 2.0)
    assert sim.get_velocities()[0, 0] == pytest.approx(
        (5 * speed - 2 * RADIUS * back_spin) / 7, rel=TOLERANCE
    )


@pytest.mark.parametrize(("angle", "friction"), [(0.3, 0.5), (0.8, 0.1)])
def test_sphere_on_an_incline_rolls_or_slides(angle, friction):
    gravity = (G * np.sin(angle), 0, -G * np.cos(angle))
    sim = run(sphere_on_plane(0.0, gravity=gravity, friction=friction), 1.0)
    speed, spin = sim.get_velocities()[0, 0], sim.get_angular_velocities()[0, 1]
    if np.tan(angle) <= 3.5 * friction:
        assert speed == pytest.approx(5 / 7 * G * np.sin(angle), rel=TOLERANCE)
        assert spin * RADIUS == pytest.approx(speed, rel=TOLERANCE)
    else:
        assert speed == pytest.approx(G * (np.sin(angle) - friction * np.cos(angle)), rel=TOLERANCE)
        assert spin == pytest.approx(5 * friction * G * np.cos(angle) / (2 * RADIUS), rel=TOLERANCE)
    assert sim.get_positions()[0, 2] == pytest.approx(RADIUS, abs=1e-12)


def test_disc_starts_to_roll():
    """I = m r^2 / 2: 2/3 of the speed is left, after v0 / (3 mu g) and 5 v0^2 / (18 mu g)."""
    friction, speed = 0.3, 2.0
    time = speed / (3 * friction * G)
    sim = sphere_on_plane(0.0, velocity=(speed, 0, 0), friction=friction)
    sim.set_inv_inertia([[2 / RADIUS**2] * 3])
    run(sim, time, time / 200)
    assert sim.get_velocities()[0, 0] == pytest.approx(2 / 3 * speed, rel=TOLERANCE)
    assert sim.get_positions()[0, 0] == pytest.approx(5 * speed**2 / (18 * friction * G), rel=TOLERANCE)


@pytest.mark.parametrize("friction", [0.2, 0.8])
def test_block_on_an_incline_sticks_or_slides(friction):
    angle = 0.6
    sim = sphere_on_plane(0.0, gravity=(G * np.sin(angle), 0, -G * np.cos(angle)), friction=friction)
    sim.set_inv_inertia([[0, 0, 0]])
    run(sim, 1.0)
    expected = max(0.0, G * (np.sin(angle) - friction * np.cos(angle)))
    assert sim.get_velocities()[0, 0] == pytest.approx(expected, rel=TOLERANCE, abs=1e-9)


def test_rolling_friction_slows_a_rolling_sphere():
    """Moment mu_r R m g on a sphere that rolls: a = 5/7 mu_r g, until it stands."""
    sim = sphere_on_plane(
        0.0, velocity=(1, 0, 0), spin=(0, 1 / RADIUS, 0), friction=0.5, rolling_friction=0.05
    )
    run(sim, 1.0)
    assert 1 - sim.get_velocities()[0, 0] == pytest.approx(5 / 7 * 0.05 * G, rel=TOLERANCE)
    run(sim, 3.0)
    np.testing.assert_allclose(sim.get_velocities(), 0, atol=1e-9)
    assert sim.get_positions()[0, 0] == pytest.approx(1 / (2 * 5 / 7 * 0.05 * G), rel=TOLERANCE)


@pytest.mark.parametrize("angle", [0.3, 0.5])
def test_rolling_friction_holds_a_sphere_on_a_gentle_incline(angle):
    """It stands while tan(angle) <= mu_r; then a = 5/7 g (sin - mu_r cos)."""
    rolling = 0.4
    gravity = (G * np.sin(angle), 0, -G * np.cos(angle))
    sim = run(sphere_on_plane(0.0, gravity=gravity, friction=1.0, rolling_friction=rolling), 1.0)
    expected = max(0.0, 5 / 7 * G * (np.sin(angle) - rolling * np.cos(angle)))
    assert sim.get_velocities()[0, 0] == pytest.approx(expected, rel=TOLERANCE, abs=1e-6)


@pytest.mark.parametrize("approach_ratio", [0.1, 0.3, 0.45, 0.5, 1.0, 3.0])
def test_oblique_impact_slides_or_sticks(approach_ratio):
    restitution, friction, beta = 0.9, 0.1, 0.4
    sim = sphere_on_plane(
        0.1,
        velocity=(approach_ratio, 0, -1),
        gravity=(0, 0, 0),
        restitution_normal=restitution,
        restitution_tangent=beta,
        friction=friction,
    )
    run(sim, 0.2, 0.013)
    velocity, spin = sim.get_velocities()[0], sim.get_angular_velocities()[0]
    slips = approach_ratio > 3.5 * friction * (1 + restitution) / (1 + beta)
    expected = approach_ratio - 3.5 * friction * (1 + restitution) if slips else -beta * approach_ratio
    assert velocity[0] - RADIUS * spin[1] == pytest.approx(expected, abs=TOLERANCE)
    assert velocity[2] == pytest.approx(restitution, rel=TOLERANCE)


def test_wall_under_a_stack_carries_its_weight():
    count = 10
    sim = dem.Simulation(count)
    sim.set_sphere_shape(RADIUS)
    sim.set_gravity(0, 0, -G)
    sim.add_plane((0, 0, 0), (0, 0, 1))
    sim.set_positions([[0, 0, RADIUS + k] for k in range(count)])
    run(sim, 1.0, 5e-3)
    contacts = sim.diagnostics.contacts()
    on_wall = contacts["impulse"][contacts["bodies"][:, 1] < 0].sum(axis=0) / 5e-3
    np.testing.assert_allclose(on_wall, [0, 0, count * G], rtol=TOLERANCE, atol=1e-12)


def test_newton_cradle_passes_the_speed_on():
    sim = dem.Simulation(6)
    sim.set_sphere_shape(RADIUS)
    sim.set_material_params(1.0)
    sim.set_positions([[-3, 0, 0]] + [[k, 0, 0] for k in range(5)])
    sim.set_velocities([[1, 0, 0]] + [[0, 0, 0]] * 5)
    run(sim, 4.0, 0.01)
    np.testing.assert_allclose(sim.get_velocities()[:, 0], [0, 0, 0, 0, 0, 1], atol=1e-12)
    assert sim.get_positions()[5, 0] == pytest.approx(4 + 2, abs=1e-9)


def test_impact_with_friction_keeps_angular_momentum():
    sim = dem.Simulation(2)
    sim.set_sphere_shape(RADIUS)
    sim.set_material_params(0.4, 0.3, 0.5, 0.1)
    sim.set_positions([[0, 0, 0], [1.3, 0.4, -0.2]])
    sim.set_scales([1.0, 1.4])
    sim.set_inv_mass([1.0, 0.3])
    sim.set_velocities([[2, 0.5, 0], [-1, 0, 0.3]])
    sim.set_angular_velocities([[1, 2, 3], [0, 0, 4]])
    momentum, spin = sim.diagnostics.linear_momentum(), sim.diagnostics.angular_momentum()
    run(sim, 0.5, 0.01)
    assert not np.allclose(sim.get_velocities()[0], [2, 0.5, 0])
    np.testing.assert_allclose(sim.diagnostics.linear_momentum(), momentum, atol=1e-13)
    np.testing.assert_allclose(sim.diagnostics.angular_momentum(), spin, atol=1e-13)


def test_sphere_slides_off_a_sphere_where_the_force_between_them_vanishes():
    """Without friction it leaves where the cosine of the polar angle is 2/3 of that of the start."""
    sim = dem.Simulation(2)
    sim.set_sphere_shape(RADIUS)
    sim.set_gravity(0, 0, -1)
    start = 0.1
    sim.set_positions([[0, 0, 0, 0], [np.sin(start), 0, np.cos(start), 1]])
    sim.step(1e-3)
    while sim.diagnostics.contacts()["impulse"].any():
        sim.step(1e-3)
    leaving = sim.get_positions()[1, 2] / np.linalg.norm(sim.get_positions()[1])
    assert leaving == pytest.approx(2 / 3 * np.cos(start), abs=3e-3)  # it moves 1e-3 in a step
    energy = 0.5 * np.sum(sim.get_velocities()[1] ** 2) + sim.get_positions()[1, 2]
    assert energy == pytest.approx(np.cos(start), abs=1e-6)
