"""The coupled simulation: conservation, stability for light and heavy bodies, contacts, errors."""

import os
import signal

import numpy as np
import pytest
from peclet.core.geom import SceneBuilder
from peclet.coupling import Body, CoupledSimulation, prediction, rotation
from peclet.dem import Simulation
from peclet.flow import Solver

from tests.python.coupling_scenes import CELLS, CENTER, RADIUS, TOUCHING, build

# ----------------------------------------------------------------------------------------------- motion


def test_a_body_as_dense_as_the_fluid_stays_at_rest():
    simulation = build(ratio=1.0)
    simulation.run(3, progress=False)
    assert np.array_equal(simulation.history["position"][-1], [CENTER])
    assert np.abs(simulation.flow.get_v()).max() == 0


def test_force_is_what_the_fluid_lost():
    simulation = build()
    for _ in range(4):
        simulation.step()
        change = simulation.flow.reaction_budget_terms()[0]
        force = simulation.history["force"][-1].sum(axis=0)
        np.testing.assert_allclose(force, -change, atol=1e-10 * max(1e-12, np.abs(change).max()))


def test_falls_straight_and_rises_like_its_mirror_image():
    heavy, light = (build(ratio=2.0, gravity=(0, g, 0)) for g in (-1e-3, 1e-3))
    for simulation in (heavy, light):
        simulation.run(3, progress=False)
    down, up = (simulation.history["velocity"][-1, 0, 1] for simulation in (heavy, light))
    assert down < 0
    # the body is not in the middle of a cell, so up and down differ a little
    assert up == pytest.approx(-down, rel=0.02)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.001, 7.8, 1000.0])
@pytest.mark.parametrize("time_step", [0.25, 4.0])
def test_motion_is_smooth_for_light_and_heavy_bodies(ratio, time_step):
    simulation = build(ratio=ratio, time_step=time_step, gravity=(0, -1e-4, 0))
    simulation.run(12, progress=False)
    velocity = simulation.history["velocity"][:, 0, 1]
    gain = np.diff(velocity) * (1 if ratio < 1 else -1)
    # an unstable exchange of forces changes sign from step to step
    assert (gain > 0).all()
    assert gain.max() < 3 * gain[6:].mean()


@pytest.mark.parametrize("ratio", [0.1, 10.0])
def test_estimated_and_hand_tuned_added_mass_agree_as_the_step_shrinks(ratio):
    difference = []
    for time_step, steps in ((1.0, 8), (0.25, 32)):
        speeds = []
        for added_mass in ("auto", 1.0):
            simulation = build(ratio=ratio, time_step=time_step, added_mass=added_mass)
            simulation.run(steps, progress=False)
            speeds.append(simulation.history["velocity"][-1, 0, 1])
        difference.append(abs(speeds[0] - speeds[1]) / abs(speeds[0]))
    # first order in time: a quarter of the step, about a quarter of the difference
    assert difference[1] < 0.5 * difference[0]
    assert difference[1] < 0.05


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_spin_decays(ratio):
    simulation = build(ratio=ratio, gravity=(0, 0, 0), viscosity=0.1)
    simulation.contacts.set_angular_velocities([[0.0, 0.0, 0.02]])
    simulation.run(15, progress=False)
    spin = simulation.history["angular_velocity"][:, 0, 2]
    # light bodies give most of their angular momentum to the fluid at once and swing in
    assert np.abs(spin[1:]).max() < 0.02
    settled = spin[7:]
    assert (settled > 0).all()
    assert (np.diff(settled) < 0).all()


def test_a_prediction_fades_after_a_jolt_and_ends_at_a_contact():
    motion = prediction.Prediction(np.array([[2.0, 0.0, 0.0]] * 4))
    found = np.array([[1.8, 0.0, 0.0], [0.5, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.8, 0.0, 0.0]])
    motion.advance(found, np.array([False, False, False, True]))
    # smooth, a quarter left, turned round, touched
    np.testing.assert_allclose(motion.predicted[:, 0], [1.8, 0.25, 0.0, 0.0])
    # the velocity given to the fluid has changed by that of the body and by what it is ahead
    np.testing.assert_allclose(motion.felt, found + (motion.lead(1.0) - [1.0, 0.0, 0.0]))
    again = prediction.Prediction(np.zeros((4, 3)))
    again.set_state(motion.state())
    for each in (motion, again):
        each.advance(found, np.zeros(4, dtype=bool))
    np.testing.assert_array_equal(again.felt, motion.felt)


# --------------------------------------------------------------------------------------------- contacts

HEAD_ON = ((0.0, 0.04, 0.0), (0.0, -0.02, 0.0))


@pytest.mark.parametrize("ratio", [0.1, 0.5, 2.0])
def test_a_light_disk_that_turns_takes_the_fluid_along(ratio):
    semi_axes = np.array([5.0, 1.5, 5.0])
    scene = SceneBuilder()
    scene.add_instance(scene.add_leaf("ellipsoid", list(semi_axes)), translation=[9.3, 9.6, 9.2])
    flow = Solver(20, 20, 20)
    flow.set_scene(*scene.encode(), periodic=True)
    flow.set_solid_from_scene()
    contacts = Simulation(1)
    contacts.set_sphere_shape(1.5)
    contacts.set_positions([[9.3, 9.6, 9.2]])
    contacts.set_angular_velocities([[1e-3, 0, 0]])
    volume = 4 / 3 * np.pi * semi_axes.prod()
    moments = ratio * volume / 5 * ((semi_axes**2).sum() - semi_axes**2)
    body = Body(0, ratio * volume, volume, tuple(moments))
    simulation = CoupledSimulation(flow, contacts, [body], time_step=0.1, viscosity=1e-6)
    simulation.run(30, progress=False)
    spin = simulation.history["angular_velocity"][:, 0, 0] / 1e-3
    added = 5.45 * volume  # of this ellipsoid in unbounded ideal fluid [Lamb1932, section 115]
    assert spin[-1] == pytest.approx(moments[0] / (moments[0] + added), rel=0.2)  # three cells thick
    assert np.diff(spin).max() < 1e-4


def collide(**options):
    simulation = build(
        TOUCHING, radius=2.0, ratio=3.0, velocities=HEAD_ON, gravity=(0, 0, 0), time_step=0.5, **options
    )
    simulation.run(40, progress=False)
    return simulation.history


def test_touching_spheres_lose_their_approach_and_no_momentum():
    history = collide()
    impulse = history["contact_impulse"]
    largest = np.abs(impulse).max()
    # before the touch, rounding is all there is
    hit = int(np.argmax(np.abs(impulse).max(axis=(1, 2)) > 1e-9 * largest))
    assert hit > 0, "the spheres never met"
    assert np.abs(impulse.sum(axis=1)).max() < 1e-12 * largest
    line = history["position"][:, 1] - history["position"][:, 0]
    distance = np.linalg.norm(line, axis=1)
    approach = np.einsum("ti,ti->t", history["velocity"][:, 0] - history["velocity"][:, 1], line) / distance
    assert approach[hit - 1] > 0.02
    # the fluid changes velocities once more between the touch and the end of the step
    assert abs(approach[hit]) < 1e-2 * approach[hit - 1]
    # an inelastic impact is not answered by a rebound in the steps after it
    assert np.abs(approach[hit + 1 :]).max() < 1e-5 * approach[hit - 1]
    assert distance.min() > (1 - 1e-3) * 4.0


def test_position_only_contact_leaves_velocities_alone():
    history = collide(iterations=(10, 0))
    assert np.abs(history["contact_impulse"]).max() < 1e-12
    gap = history["position"][:, 1, 1] - history["position"][:, 0, 1] - 4.0
    assert gap.min() > -1e-2 * 4.0


# ------------------------------------------------------------------------------------------------- runs


def test_runs_for_a_time_and_stops_when_told():
    simulation = build()
    simulation.run(time=2.5, progress=False)
    assert (simulation.number_of_steps, simulation.time) == (3, 3.0)
    simulation.run(time=1.0, progress=False)
    assert simulation.number_of_steps == 3
    simulation.run(5, progress=False, callback=lambda s: s.number_of_steps == 4)
    assert simulation.number_of_steps == 4


def test_ctrl_c_ends_a_run_between_steps():
    simulation = build()

    def interrupt(simulation):
        if simulation.number_of_steps == 2:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt, match="after 2 of 5 steps"):
        simulation.run(5, progress=False, callback=interrupt)
    assert signal.getsignal(signal.SIGINT) is before
    assert len(simulation.history["time"]) == 3
    simulation.run(1, progress=False)
    assert simulation.number_of_steps == 3


def test_history_holds_every_step():
    simulation = build()
    simulation.run(70, progress=False, callback=lambda s: s.number_of_steps == 66)
    history = simulation.history
    assert np.array_equal(history["time"], np.arange(67.0))
    assert history["position"].shape == (67, 1, 3)
    assert history["orientation"].shape == (67, 1, 4)
    displacement = np.diff(history["position"][:, 0, 1])
    mean = 0.5 * (history["velocity"][1:, 0, 1] + history["velocity"][:-1, 0, 1])
    # loads are frozen during a step, so that the mean velocity is exact
    np.testing.assert_allclose(displacement, mean, rtol=1e-9, atol=1e-14)


# ----------------------------------------------------------------------------------------------- slices


def test_slice_of_a_stream_that_carries_its_body_is_uniform():
    simulation = build(ratio=1.0, gravity=(0, 0, 0), velocities=[(0.1, 0.05, 0.02)])
    simulation.flow.rebuild_geometry()
    simulation.flow.set_state(*(np.full(CELLS, u) for u in (0.1, 0.05, 0.02)))
    for normal in "xyz":
        plane = simulation.take_slice(normal)
        a, b = (("xyz".index(normal) + n) % 3 for n in (1, 2))
        assert plane.distance.shape == (CELLS[a], CELLS[b])
        assert plane.distance.min() < 0
        np.testing.assert_allclose(plane.velocity_a, (0.1, 0.05, 0.02)[a], rtol=1e-12)
        np.testing.assert_allclose(plane.velocity_b, (0.1, 0.05, 0.02)[b], rtol=1e-12)
        assert np.abs(plane.vorticity).max() < 1e-12


def test_slice_shows_the_vorticity_of_a_spinning_body():
    simulation = build(ratio=1.0, gravity=(0, 0, 0), viscosity=0.01)
    simulation.contacts.set_angular_velocities([[0.0, 0.0, 0.03]])
    simulation.step()
    spin = simulation.history["angular_velocity"][-1, 0, 2]
    plane = simulation.take_slice("z")
    deep = plane.distance < -1.5
    np.testing.assert_allclose(plane.vorticity[deep], 2 * spin, rtol=1e-9)


def test_pictures_have_labels():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    simulation = build()
    simulation.run(2, progress=False)
    motion = simulation.plot("y")
    assert [axis.get_ylabel() for axis in motion.axes] == ["position along y", "velocity along y"]
    for show in ("vorticity", "speed"):
        figure = simulation.plot_slice("z", show=show)
        assert figure.axes[0].get_xlabel() == "x"
        assert figure.axes[1].get_ylabel().startswith(show)
    pyplot.close("all")


# ----------------------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"time_step": 0.0}, "time_step: expected a positive number, found 0.0"),
        ({"time_step": np.nan}, "time_step: expected a finite number"),
        ({"viscosity": -1.0}, "viscosity: expected zero or a positive number"),
        ({"density": 0.0}, "density: expected a positive number"),
        ({"gravity": (0.0, 1.0)}, "gravity: expected a sequence of 3 numbers"),
        ({"substeps": 0}, "substeps: expected an integer of at least 1"),
        ({"added_mass": -1.0}, "added_mass: expected"),
        ({"added_mass": "some"}, "added_mass: expected"),
    ],
)
def test_names_the_argument_that_makes_no_sense(options, message):
    with pytest.raises((ValueError, TypeError), match=message):
        build(**options)


def test_bodies_instances_and_particles_must_match():
    simulation = build()
    flow, contacts = simulation.flow, simulation.contacts
    sphere = Body.sphere(0, radius=RADIUS, density=2.0)
    properties = {"time_step": 1.0, "viscosity": 0.01}
    with pytest.raises(ValueError, match="instances below 1"):
        CoupledSimulation(flow, contacts, [Body.sphere(1, radius=1, density=1)], **properties)
    with pytest.raises(ValueError, match="each with its own instance"):
        CoupledSimulation(flow, contacts, [sphere, sphere], **properties)
    with pytest.raises(ValueError, match="at least one"):
        CoupledSimulation(flow, contacts, [], **properties)
    with pytest.raises(TypeError, match=r"bodies\[0\]: expected a peclet.coupling.Body"):
        CoupledSimulation(flow, contacts, ["sphere"], **properties)
    contacts.set_positions([[1.0, 1.0, 1.0], [9.0, 9.0, 9.0]])
    with pytest.raises(ValueError, match="expected 1 particles, one per body, found 2"):
        CoupledSimulation(flow, contacts, [sphere], **properties)


@pytest.mark.parametrize(("steps", "time"), [(None, None), (1, 1.0)])
def test_run_takes_steps_or_a_time(steps, time):
    with pytest.raises(ValueError, match="either steps or time"):
        build().run(steps, time=time)


@pytest.mark.parametrize(
    "values", [(0, -1.0, 1.0, (1, 1, 1)), (0, 1.0, 0.0, (1, 1, 1)), (0, 1.0, 1.0, (1, 1, 0))]
)
def test_bodies_have_mass_volume_and_inertia(values):
    with pytest.raises(ValueError, match="expected a positive number"):
        Body(*values)


def test_no_body_has_one_moment_beyond_the_sum_of_the_others():
    with pytest.raises(ValueError, match="inertia"):
        Body(0, 1.0, 1.0, (1.0, 1.0, 2.1))
    Body(0, 1.0, 1.0, (1.0, 1.0, 2.0))  # a disk without thickness


def test_solver_and_particles_stay_those_of_the_simulation():
    simulation = build()
    simulation.flow.set_dt(0.5)
    with pytest.raises(RuntimeError, match=r"flow\.dt"):
        simulation.step()
    simulation.flow.set_dt(1.0)
    simulation.contacts.set_positions(np.zeros((2, 3)))
    with pytest.raises(RuntimeError, match="particles"):
        simulation.step()


def test_rotation_to_body_axes_is_undone_by_its_inverse():
    rng = np.random.default_rng(1)
    q = rng.normal(size=(5, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    v = rng.normal(size=(5, 3))
    there = rotation.to_body_axes(q, v)
    np.testing.assert_allclose(rotation.from_body_axes(q, there), v, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(there, axis=1), np.linalg.norm(v, axis=1), rtol=1e-14)
