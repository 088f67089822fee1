"""Contacts of peclet.dem: walls, materials, periodic boxes, beds."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from peclet import dem

from tests.python.dem_scenes import BOX, leaf, spheres

_BED = """
import hashlib
import numpy as np
from peclet import dem
generator = np.random.default_rng(5)
sim = dem.Simulation(500)
sim.set_sphere_shape(0.5)
sim.set_gravity(0, 0, -1)
sim.set_material_params(0.5, 0.2, 0.4)
sim.set_domain(6.0, 6.0, 30.0)
sim.add_plane((0, 0, 0), (0, 0, 1))
sim.set_positions(generator.uniform((0, 0, 1), (6, 6, 12), (500, 3)))
sim.set_scales(generator.uniform(0.5, 1.0, 500))
for _ in range(6):
    sim.step(0.01)
sim.set_hertz_material(0, 1e5, 0.3)
sim.step_hertz(1e-4, 20)
state = np.concatenate([sim.get_positions(), sim.get_velocities(), sim.get_angular_velocities()])
print(hashlib.sha256(state.tobytes()).hexdigest())
"""


def test_tank_holds_a_sphere_in_its_corner():
    sim = spheres([0.3, -0.2, 0.1])
    assert sim.add_analytic_wall(*leaf(BOX, 2, 3, 4), 0, invert=True) == 0
    sim.set_gravity(-3, -4, -12)
    for _ in range(400):
        sim.step(0.01)
    np.testing.assert_allclose(sim.get_positions(), [[-1.5, -2.5, -3.5]], atol=1e-5)
    np.testing.assert_allclose(sim.get_velocities(), np.zeros((1, 3)), atol=1e-9)
    assert sim.wall_sdf_at(0, [[0, 0, 0]]) == [2]


def test_scene_wall_bounces_by_its_own_restitution():
    sim = spheres([0, 0, 3])
    sim.add_analytic_wall(*leaf(BOX, 2, 2, 1), 0, False, restitution=0.5)
    sim.set_velocities([[0, 0, -1]])
    for _ in range(200):
        sim.step(0.01)
    assert sim.get_velocities()[0, 2] == pytest.approx(0.5)
    assert sim.get_positions()[0, 2] == pytest.approx(1.5 + 0.5 * (2 - 1.5))


def test_moving_wall_carries_and_pushes():
    sim = spheres([0, 0, 1.5])
    wall = sim.add_analytic_wall(*leaf(BOX, 50, 50, 1), 0, False, friction=1.0)
    sim.set_gravity(0, 0, -10)
    sim.set_wall_velocity(wall, (0.7, 0, 0))
    for _ in range(200):
        sim.step(0.01)
    assert sim.get_velocities()[0, 0] == pytest.approx(
        0.2
    )  # 2/7 of the belt's speed, rolling backwards on it
    sim.set_wall_velocity(wall, (0, 0, 0.5))
    for k in range(100):
        sim.set_wall_transform(wall, (0, 0, 0.005 * k))
        sim.step(0.01)
    assert sim.get_velocities()[0, 2] == pytest.approx(0.5, rel=1e-6)
    assert sim.get_positions()[0, 2] == pytest.approx(2.0, abs=1e-6)


def test_pair_materials_decide_by_ids():
    sim = spheres([0, 0, 0], [1.1, 0, 0], [0, 5, 0], [1.1, 5, 0])
    sim.set_material_params(0.0)
    sim.set_material_ids([1, 2, 1, 1])
    sim.set_pair_material(2, 1, 1.0, 0.0)
    sim.set_velocities([[1, 0, 0], [0, 0, 0]] * 2)
    for _ in range(20):
        sim.step(0.01)
    np.testing.assert_allclose(sim.get_velocities()[:, 0], [0, 1, 0.5, 0.5], atol=1e-14)


def test_contacts_across_periodic_faces():
    sim = spheres([0.2, 1, 1], [3.5, 1, 1])
    sim.set_domain(4.0, 4.0, 4.0)
    assert sim.max_overlap == pytest.approx(0.3)
    sim.relax()
    np.testing.assert_allclose(sim.get_positions()[:, 0], [0.35, 3.35])


def test_results_do_not_depend_on_where_the_box_is_cut():
    generator = np.random.default_rng(3)
    start, velocity = generator.uniform(0, 6, (150, 3)), generator.normal(size=(150, 3))

    def run(shift):
        sim = spheres(*((start + shift) % 6), radius=0.4)
        sim.set_domain((6, 6, 6), periodic=(True, True, True))
        sim.set_velocities(velocity)
        for _ in range(3):
            sim.step(0.01)
        return (sim.get_positions() - shift) % 6

    difference = run(0.0) - run(2.5)
    assert np.abs((difference + 3) % 6 - 3).max() < 1e-9


def test_bed_in_a_tank_settles_without_overlap_and_weighs_what_it_weighs():
    generator = np.random.default_rng(2)
    sites = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), -1).reshape(-1, 3) * 1.1 + 0.6
    sim = spheres(*(sites + generator.uniform(-0.05, 0.05, sites.shape)))
    sim.set_gravity(0, 0, -10)
    sim.set_material_params(0.3, 0.0, 0.5)
    sim.add_analytic_wall(*leaf(BOX, 1.8, 1.8, 20), 0, True, 0.3, 0.5)
    sim.set_wall_transform(0, (1.8, 1.8, 20))
    weight = []
    for _ in range(500):
        sim.step(0.005)
        contacts = sim.diagnostics.contacts()
        weight.append(contacts["impulse"][contacts["bodies"][:, 1] < 0].sum(axis=0)[2] / 0.005)
    assert sim.max_overlap < 1e-4
    assert sim.get_positions().min() > 0.5 - 1e-4
    assert sim.diagnostics.kinetic_energy() < 1.0  # of some 300 that it had above the floor
    assert np.mean(weight[-100:]) == pytest.approx(27 * 10, rel=0.03)


@pytest.mark.parametrize("six_numbers", [True, False])
def test_planes_in_both_forms(six_numbers):
    sim = spheres([0, 0, 0.4])
    if six_numbers:
        sim.add_plane(0.0, 0.0, 0.0, 0.0, 0.0, 2.0)
    else:
        sim.add_plane((5, 5, 0), normal=(0, 0, 0.5))
    assert sim.max_overlap == pytest.approx(0.1)
    sim.relax()
    assert sim.get_positions()[0, 2] == pytest.approx(0.5)


def test_results_are_bitwise_the_same_for_any_number_of_threads():
    folder = str(pathlib.Path(dem.__file__).parents[2])

    def run(threads):
        environment = os.environ | {"OMP_NUM_THREADS": str(threads), "PYTHONPATH": folder}
        return subprocess.run(
            [sys.executable, "-c", _BED], env=environment, check=True, capture_output=True, text=True
        ).stdout

    assert run(1) == run(2)
