"""Stokes drag of a simple cubic array of spheres: force budget and order; the page has the drags."""

import numpy as np
import pytest
from peclet import flow
from peclet.core.geom import SceneBuilder

from examples.validation.arrays import drag_at_rest, make_array
from examples.validation.comparisons import SHIFTS, exact_drag
from examples.validation.results import orders


@pytest.mark.parametrize("shift", SHIFTS[::3])
def test_force_is_what_drives_the_fluid(shift):
    # the points of the fluid fill 0.6 % more or less of the cell, and the force is that on its volume
    _, force = drag_at_rest(16, 0.125, shift)
    assert force == pytest.approx(1, abs=1e-4)


@pytest.mark.slow
def test_drag_converges_with_second_order():
    # Shifted positions average out how the lattice of points cuts the sphere.
    exact = exact_drag(0.125)
    errors = [
        np.sqrt(np.mean([(drag_at_rest(cells, 0.125, shift)[0] / exact - 1) ** 2 for shift in SHIFTS]))
        for cells in (6, 12, 24)
    ]
    assert orders(errors).mean() >= 1.8


def test_pressure_in_cut_cells_settles_with_the_rest():
    # 11 steps leave 2.2e-4 of the mean velocity; where the pressure of a cell moves by its open part, 1.5e-3
    solver = make_array(16, 0.125, 7.5 + np.array((0.3, 0.1, -0.2)), 1000.0, 1.0)
    solver.set_body_force(1e-3, 0, 0)
    means = []
    for _ in range(60):
        solver.step()
        means.append(solver.get_u().mean())
    assert means[10] == pytest.approx(means[-1], rel=3e-4)


@pytest.mark.parametrize(
    ("spacing", "count", "radii", "largest"),
    [((1, 2, 0.5), 25, (2.0, 5.0), 1e-2), ((1, 1, 1), 200, (0.6, 1.2), 2e-4)],
    ids=["overlapping, oblong cells", "a cell wide"],
)
def test_long_steps_through_packings_settle(spacing, count, radii, largest):
    # with the pressure of a cell moved by more than its open part allows, both oscillate for ever
    random = np.random.default_rng(3)
    extent = 20 * np.array(spacing)
    solver, scene = flow.Solver((20, 20, 20), extent=extent), SceneBuilder()
    for _ in range(count):
        sphere = scene.add_leaf("sphere", [random.uniform(*radii)])
        scene.add_instance(sphere, translation=list(random.random(3) * extent))
    solver.set_scene(*scene.encode(), periodic=True)
    solver.set_solid_from_scene()
    solver.set_mu(1.0)
    solver.set_dt(1000 * min(spacing) ** 2)
    solver.set_body_force(1e-3, 3e-4, 0)
    for _ in range(40):
        before = np.stack([solver.get_u(), solver.get_v(), solver.get_w()])
        solver.step()
    after = np.stack([solver.get_u(), solver.get_v(), solver.get_w()])
    assert np.abs(after - before).max() <= largest * np.abs(after).max()
