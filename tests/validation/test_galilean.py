"""Uniform motion: nothing happens, whoever moves. And closed walls stay closed."""

import numpy as np
import pytest
from peclet.core import geom

from tests.validation.helpers import box_of_fluid, fluid_points, put_spheres, stream, velocities

CELLS = (16, 14, 18)


@pytest.mark.parametrize("scheme", [None, "sou", "koren", "central"])
def test_bodies_and_stream_move_together(scheme):
    velocity = np.array([0.25, -0.15, 0.1])
    solver = box_of_fluid(CELLS, mu=0.1, dt=1.0, scheme=scheme)
    start = np.array([[13.3, 8.1, 7.8], [5.1, 2.2, 11.4]])
    put_spheres(
        solver, *((center, radius, velocity) for center, radius in zip(start, (3.3, 2.6), strict=True))
    )
    stream(solver, velocity)
    for step in range(1, 11):  # two and a half cells along x, across the edge
        for body, center in enumerate(start + step * velocity):
            solver.set_instance_transform(body, center)
        solver.step()
    fluid = fluid_points(solver)
    for component, mask, speed in zip(velocities(solver), fluid, velocity, strict=True):
        assert np.abs(component[mask] - speed).max() <= 1e-7
    assert np.abs(solver.hydro_force_torque_reaction()).max() <= 1e-7


def test_resting_fluid_stays_at_rest():
    solver = box_of_fluid(CELLS, mu=0.1, scheme="koren")
    put_spheres(solver, ((5.3, 6.1, 7.8), 2.7), ((12.2, 12.9, 4.3), 2.9))
    for _ in range(3):
        solver.step()
    assert not velocities(solver).any()
    assert not solver.hydro_force_torque_reaction().any()


def tank_with_sphere(solver, velocity=(0, 0, 0)):
    """A closed cavity of 11.4 x 9.4 x 13.4 cells inside a solid slab, and a sphere in it."""
    nx, ny, nz = CELLS
    builder = geom.SceneBuilder()
    slab = builder.add_leaf("box", [nx / 2 + 1.5, ny / 2 + 1.5, nz / 2 + 1.5])
    tank = builder.add_difference(slab, builder.add_leaf("box", [5.7, 4.7, 6.7]))
    sphere = builder.add_leaf("sphere", [2.2])
    builder.add_instance(tank, [nx / 2 + 0.3, ny / 2 + 0.3, nz / 2 + 0.3])
    builder.add_instance(sphere, [7.2, 6.9, 8.4])
    node_ints, node_reals, instance_ints, instance_reals = builder.encode()
    instance_reals[18 + 8 : 18 + 11] = velocity
    solver.set_scene(node_ints, node_reals, instance_ints, instance_reals, periodic=True)
    solver.set_solid_from_scene()
    return solver


def plane_fluxes(solver):
    """Volume flux through every plane of faces, all axes."""
    open_fractions = (solver.get_ox(), solver.get_oy(), solver.get_oz())
    others = ((1, 2), (0, 2), (0, 1))
    fluxes = zip(open_fractions, velocities(solver), others, strict=True)
    return np.concatenate([(o * u).sum(axis=axes) for o, u, axes in fluxes])


def test_nothing_flows_through_the_walls_of_a_tank():
    solver = tank_with_sphere(box_of_fluid(CELLS, mu=0.1, dt=0.5, scheme="koren"))
    rng = np.random.default_rng(7)
    solver.set_state(*rng.uniform(-1, 1, (3, *CELLS)))
    for _ in range(3):
        solver.step()
    assert np.abs(velocities(solver)).max() > 1e-2
    # each plane cuts a closed cavity: the sum of up to 150 faces of a field whose divergence is below 1e-8
    assert np.abs(plane_fluxes(solver)).max() <= 1e-6
    assert not velocities(solver)[~fluid_points(solver)].any()


AT_REST = (0, 0, 0)
MOTIONS = {
    "impulsive start": [((7.3, 6.1, 8.8), 3.2, (0.2, -0.1, 0.05), AT_REST)],
    "spinning": [((7.3, 6.1, 8.8), 3.2, AT_REST, (0.02, 0.05, -0.03))],
    "overlapping, moving together": [
        ((6.3, 6.1, 8.8), 3.2, (0.2, 0.1, 0), AT_REST),
        ((9.9, 6.7, 9.1), 2.7, (0.2, 0.1, 0), AT_REST),
    ],
    "moves and spins across the edge": [((15.4, 13.1, 17.2), 3.2, (0.2, 0.1, 0), (0, 0.05, 0))],
}


@pytest.mark.parametrize("bodies", MOTIONS.values(), ids=MOTIONS.keys())
def test_every_open_cell_conserves_volume(bodies):
    solver = put_spheres(box_of_fluid(CELLS, mu=0.1, dt=0.5, scheme="koren"), *bodies)
    centers = [np.array(body[0]) for body in bodies]
    for _ in range(4):
        solver.step()
        # relative to velocity / spacing
        assert solver.max_open_divergence() <= 1e-8 * solver.max_velocity()
        for number, (center, body) in enumerate(zip(centers, bodies, strict=True)):
            center += 0.5 * np.array(body[2])
            solver.set_instance_transform(number, center)


def test_what_overlapping_bodies_displace_is_spread_over_the_box():
    # A sphere that leaves a fixed one changes the volume of both together, at the rate pi a^2 U.n through the
    # circle of radius a where they meet. A closed box has no room for that; every cell takes its share.
    first, second = np.array([6.3, 6.1, 8.8]), np.array([9.9, 6.7, 9.1])
    radii, speed = (3.2, 2.7), np.array([0.2, 0.0, 0.0])
    solver = box_of_fluid(CELLS, mu=0.1, dt=0.5, scheme="koren")
    put_spheres(solver, (first, radii[0], speed), (second, radii[1]))
    solver.step()
    distance = np.linalg.norm(second - first)
    to_circle = (distance**2 + radii[0] ** 2 - radii[1] ** 2) / (2 * distance)
    flux = np.pi * (radii[0] ** 2 - to_circle**2) * speed @ (second - first) / distance
    solid = 4 / 3 * np.pi * (radii[0] ** 3 + radii[1] ** 3)
    # where the two staircases meet, faces belong to one or the other: half of the flux is uncertain
    assert solver.max_open_divergence() <= 1.5 * flux / (np.prod(CELLS) - solid)
