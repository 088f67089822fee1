"""What must not change the result: grid parity, the edge of the box, units of force, number of threads."""

import os
import subprocess
import sys

import numpy as np
import pytest

from tests.same import assert_same
from tests.validation.helpers import box_of_fluid, put_spheres, stream, velocities


def force_in_box(cells, center):
    solver = box_of_fluid(cells, mu=0.5, dt=4.0, force=(1e-3, 0, 0))
    put_spheres(solver, (center, 3.4))
    for _ in range(12):
        solver.step()
    return solver.hydro_force_torque_reaction()[0, 0], velocities(solver).mean(axis=(1, 2, 3))


def test_odd_and_prime_sizes_give_the_same_physics():
    # Adding one cell in 16 to the length changes the result by a few per cent, smoothly.
    lengths = (16, 17, 18, 19)
    means = np.array([force_in_box((n, 13, 14), (7.7, 6.2, 6.9))[1][0] for n in lengths])
    assert (np.diff(means) > 0).all()  # more room, less drag per volume
    second_difference = np.abs(np.diff(means, 2))
    assert second_difference.max() <= 0.1 * np.abs(np.diff(means)).max()


def test_place_in_the_periodic_box_does_not_matter():
    force, mean = force_in_box((16, 13, 15), (7.7, 6.2, 6.9))
    for shift in ((8, 0, 0), (5, -6, 9), (16, 13, -15)):
        moved_force, moved_mean = force_in_box((16, 13, 15), np.add((7.7, 6.2, 6.9), shift))
        # the solvers stop at their tolerances along other paths
        np.testing.assert_allclose(moved_force, force, atol=1e-6 * np.abs(force).max())
        np.testing.assert_allclose(moved_mean, mean, atol=1e-6 * np.abs(mean).max())


@pytest.mark.parametrize("scheme", [None, "koren"])
def test_crossing_the_edge_is_mirror_symmetric(scheme):
    forces = []
    for x, direction in ((15.2, 1), (15.8, -1)):  # mirror images in the plane x = 15.5
        solver = box_of_fluid((16, 14, 18), mu=0.1, dt=1.0, scheme=scheme)
        put_spheres(solver, ((x, 8.1, 7.8), 3.3, (0.1 * direction, 0.05, 0), (0, 0, 0.02 * direction)))
        for _ in range(2):
            solver.step()
        force, torque = solver.hydro_force_torque_reaction()[:, 0]
        forces.append(
            [
                direction * force[0],
                force[1],
                force[2],
                torque[0],
                direction * torque[1],
                direction * torque[2],
            ]
        )
    np.testing.assert_allclose(forces[0], forces[1], atol=1e-6 * np.abs(forces[0]).max())


@pytest.mark.parametrize("scheme", [None, "sou", "koren", "central"])
def test_units_of_mass_scale_loads_only(scheme):
    results = []
    for factor in (1, 2):
        solver = box_of_fluid(
            (12, 14, 10), rho=factor, mu=0.1 * factor, force=(1e-2 * factor, 0, 0), scheme=scheme
        )
        put_spheres(solver, ((5.3, 6.1, 4.8), 3.0, (0.05, 0, 0), (0, 0.02, 0)))
        stream(solver, (0.05, 0.1, 0))
        for _ in range(3):
            solver.step()
        results.append((velocities(solver), solver.hydro_force_torque_reaction() / factor))
    assert_same(results[1][0], results[0][0])
    assert_same(results[1][1], results[0][1])


RUN = """
import sys
import numpy as np
from tests.validation.helpers import box_of_fluid, put_spheres, stream, velocities
solver = box_of_fluid((24, 18, 20), mu=0.1, dt=0.5, force=(1e-2, 0, 0), scheme="koren")
bodies = ((7.3, 6.1, 9.8), 3.4, (0.2, 0.1, 0), (0, 0, 0.05)), ((18.2, 12.9, 4.3), 3.9)
put_spheres(solver, *bodies)
for step in range(4):
    solver.set_instance_transform(0, np.add(bodies[0][0], 0.5 * (step + 1) * np.array(bodies[0][2])))
    solver.step()
loads = solver.hydro_force_torque_reaction()
np.save(sys.argv[1], np.concatenate([velocities(solver).ravel(), loads.ravel()]))
"""


def result_with_threads(threads, file):
    environment = os.environ | {
        "OMP_NUM_THREADS": str(threads),
        "OMP_WAIT_POLICY": "passive",  # threads that spin would starve a busy machine
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
    }
    subprocess.run([sys.executable, "-c", RUN, str(file)], env=environment, check=True, timeout=300)
    return np.load(file)


def test_threads_change_rounding_only(tmp_path):
    one = result_with_threads(1, tmp_path / "one.npy")
    two = result_with_threads(2, tmp_path / "two.npy")
    again = result_with_threads(2, tmp_path / "again.npy")
    assert_same(two, again)
    np.testing.assert_allclose(two, one, rtol=0, atol=1e-10 * np.abs(one).max())
