"""Sides of the box: what is accepted, what is refused, and what each condition does to the flow."""

import warnings

import numpy as np
import pytest
from peclet import flow
from peclet.core import geom

NAMES = "xyz"


def closed_box(cells=(8, 10, 6), **parameters):
    solver = flow.Solver(cells, extent=(0.8, 1.1, 0.7))
    for face in range(6):
        solver.set_domain_bc(face, "wall")
    solver.set_mu(parameters.get("mu", 0.1))
    solver.set_dt(parameters.get("dt", 0.05))
    return solver


def channel(axis, sign, across, cells=(20, 8), speed=1.0):
    """A channel along an axis: walls across one other axis, periodic along the third."""
    n, extent = [5, 5, 5], [0.4, 0.4, 0.4]
    n[axis], n[across] = cells
    extent[axis], extent[across] = 3.0, 1.0
    solver = flow.Solver(n, extent=extent)
    velocity = [0.0, 0.0, 0.0]
    velocity[axis] = sign * speed
    low, high = ("-", "+") if sign > 0 else ("+", "-")
    solver.set_domain_bc(low + NAMES[axis], "inflow", velocity)
    solver.set_domain_bc(high + NAMES[axis], "outflow")
    solver.set_domain_bc("-" + NAMES[across], "wall")
    solver.set_domain_bc("+" + NAMES[across], "wall")
    solver.set_mu(0.2)
    solver.set_dt(0.03)
    solver.set_advection(True)
    return solver


def component(solver, axis):
    return (solver.get_u, solver.get_v, solver.get_w)[axis]()


def test_both_generations_of_the_call_mean_the_same():
    solver = flow.Solver(4, 4, 4)
    solver.set_domain_bc("-y", "wall", [1, 0, 2])
    old = solver.domain_bc["-y"]
    solver.set_domain_bc(2, 1, 1.0, 0.0, 2.0)
    assert solver.domain_bc["-y"] == old == ("wall", (1.0, 0.0, 2.0))
    solver.set_domain_bc(2, 1, vx=1.0, vz=2.0)
    assert solver.domain_bc["-y"] == old
    solver.set_domain_bc(5, 4)
    assert solver.domain_bc["+z"].type == "slip"
    assert {side.type for face, side in solver.domain_bc.items() if face not in ("-y", "+z")} == {"periodic"}


@pytest.mark.parametrize(
    ("error", "name", "arguments"),
    [
        (ValueError, "face", ("x", "wall")),
        (ValueError, "face", (6, "wall")),
        (ValueError, "face", (-1, "wall")),
        (TypeError, "face", (None, "wall")),
        (ValueError, "type", (0, "door")),
        (ValueError, "type", (0, 5)),
        (TypeError, "type", (0, 1.5)),
        (ValueError, "velocity", ("-x", "wall", [1, 0, 0])),
        (ValueError, "velocity", ("-x", "inflow", [1, np.nan, 0])),
        (ValueError, "velocity", ("-x", "inflow", [1, 0])),
        (ValueError, "vy", ("-x", "inflow", 1, np.inf, 0)),
        (TypeError, "set_domain_bc", ("-x", "inflow", 1, 0, 0, 0)),
    ],
)
def test_bad_arguments_are_named_and_change_nothing(error, name, arguments):
    solver = flow.Solver(4, 4, 4)
    solver.set_domain_bc("-x", "inflow", [1, 2, 3])
    before = solver.domain_bc
    with pytest.raises(error, match=name):
        solver.set_domain_bc(*arguments)
    assert solver.domain_bc == before


@pytest.mark.parametrize("shape", [(6, 3), (6, 8), (8, 6, 3), (6, 8, 2)])
def test_a_profile_of_the_wrong_shape_is_refused(shape):
    solver = flow.Solver(4, 6, 8)
    with pytest.raises(ValueError, match=r"profile.*6.*8.*3"):
        solver.set_domain_bc_profile("-x", np.zeros(shape))
    bad = np.zeros((6, 8, 3))
    bad[2, 3, 1] = np.nan
    with pytest.raises(ValueError, match="profile"):
        solver.set_domain_bc_profile("-x", bad)
    assert solver.domain_bc["-x"].type == "periodic"


def test_half_a_periodic_pair_is_refused_and_can_be_completed():
    solver = flow.Solver(4, 4, 4)
    solver.set_dt(0.1)
    solver.set_domain_bc("-x", "wall")
    with pytest.raises(RuntimeError, match=r"-x and \+x periodic"):
        solver.step()
    solver.set_domain_bc("+x", "wall")
    solver.step()


def test_inflow_without_a_way_out_is_refused():
    solver = closed_box()
    solver.set_domain_bc("-x", "inflow", [1, 0, 0])
    with pytest.raises(RuntimeError, match="net inflow"):
        solver.step()
    solver.set_domain_bc("+x", "inflow", [1, 0, 0])
    solver.step()
    assert solver.max_open_divergence() < 1e-7  # velocity over spacing is 10


def test_a_closed_box_under_gravity_stays_at_rest():
    solver = closed_box()
    solver.set_body_force(0.3, -1.0, 0.2)
    for _ in range(5):
        solver.step()
    for axis in range(3):
        assert np.abs(component(solver, axis)).max() < 1e-11
    p = solver.get_p()
    gradients = [np.diff(p, axis=a).mean() / solver.spacing[a] for a in range(3)]
    assert gradients == pytest.approx([0.3, -1.0, 0.2], rel=1e-6)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1, -1])
def test_all_orientations_of_a_channel_agree(axis, sign):
    across = (axis + 1) % 3
    solver, model = channel(axis, sign, across), channel(0, 1, 1)
    for _ in range(8):
        solver.step()
        model.step()
    assert solver.max_open_divergence() < 1e-8
    p, expected = solver.get_p(), model.get_p()
    p = np.moveaxis(p, (axis, across), (0, 1))
    if sign < 0:
        p = p[::-1]
    # the pressure solve stops at 1e-6 of the divergence
    assert np.abs(p - expected).max() < 1e-4 * np.abs(expected).max()


def test_mass_leaves_through_the_outflow():
    solver = channel(0, 1, 1)
    for _ in range(60):
        solver.step()
    flux = solver.get_u().mean(axis=(1, 2))
    assert flux == pytest.approx(np.ones_like(flux), abs=1e-9)


def test_pressure_at_the_outflow_is_zero():
    solver = channel(0, 1, 1)
    for _ in range(200):
        solver.step()
    x = solver.cell_centers()[0]
    p = solver.get_p().mean(axis=(1, 2))
    end = np.polyval(np.polyfit(x[-4:], p[-4:], 1), 3.0)
    assert abs(end) < 0.02 * abs(p[-1])


def test_two_outflows_share_a_symmetric_flow():
    solver = flow.Solver((20, 9, 4), extent=(2.0, 0.9, 0.4))
    solver.set_domain_bc("-x", "outflow")
    solver.set_domain_bc("+x", "outflow")
    solver.set_domain_bc("-y", "wall")
    solver.set_domain_bc_profile("+y", np.broadcast_to(np.array([0.0, -1.0, 0.0]), (20, 4, 3)))
    solver.set_mu(0.05)
    solver.set_dt(0.02)
    solver.set_advection(True)
    for _ in range(40):
        solver.step()
    v = solver.get_v()
    assert np.abs(v - v[::-1]).max() < 1e-8
    p = solver.get_p()
    assert np.abs(p - p[::-1]).max() < 1e-6 * np.abs(p).max()
    assert solver.max_open_divergence() < 1e-7


def test_a_slip_side_is_a_plane_of_symmetry():
    # half of a channel with a sphere on its axis, and the whole one
    def run(half):
        ny = 8 if half else 16
        solver = flow.Solver((16, ny, 8), extent=(1.6, 0.1 * ny, 0.8))
        solver.set_domain_bc("-y", "slip" if half else "wall")
        solver.set_domain_bc("+y", "wall")
        builder = geom.SceneBuilder()
        sphere = builder.add_leaf("sphere", [0.23])
        builder.add_instance(sphere, translation=[0.81, 0.0 if half else 0.8, 0.43])
        solver.set_scene(*builder.encode(), periodic=True)
        solver.set_solid_from_scene()
        solver.set_body_force(1.0, 0.0, 0.0)
        solver.set_mu(0.05)
        solver.set_dt(0.02)
        solver.set_advection(True)
        solver.set_pressure_tolerance(1e-9)
        for _ in range(10):
            solver.step()
        return solver

    half, whole = run(True), run(False)
    assert np.abs(half.get_u() - whole.get_u()[:, 8:]).max() < 1e-6
    assert np.abs(half.get_v()[:, 1:] - whole.get_v()[:, 9:]).max() < 1e-6
    force = half.hydro_force_torque_reaction()[0, 0]
    assert 2 * force[0] == pytest.approx(whole.hydro_force_torque_reaction()[0, 0, 0], rel=1e-6)


def test_a_body_and_a_stream_through_open_sides_move_together():
    solver = flow.Solver((16, 12, 10), extent=(1.6, 1.2, 1.0))
    velocity = [0.3, 0.0, 0.0]
    solver.set_domain_bc("-x", "inflow", velocity)
    solver.set_domain_bc("+x", "outflow")
    for face in ("-y", "+y", "-z", "+z"):
        solver.set_domain_bc(face, "slip")
    builder = geom.SceneBuilder()
    sphere = builder.add_leaf("sphere", [0.27])
    builder.add_instance(sphere, translation=[0.6, 0.61, 0.52], lin_vel=velocity)
    solver.set_scene(*builder.encode())
    solver.set_solid_from_scene()
    solver.set_state(np.full((16, 12, 10), 0.3), *np.zeros((2, 16, 12, 10)))
    solver.set_mu(0.02)
    solver.set_dt(0.1)
    solver.set_advection(True)
    for n in range(1, 8):
        solver.set_instance_transform(0, [0.6 + 0.03 * n, 0.61, 0.52])
        solver.rebuild_geometry()
        solver.step()
        u = solver.get_u()
        assert np.abs(u[u != 0] - 0.3).max() < 1e-9
        assert np.abs(solver.hydro_force_torque_reaction()).max() < 1e-8


@pytest.mark.parametrize("towards", [1, -1])
@pytest.mark.parametrize("side", ["outflow", "wall", "slip"])
def test_a_body_leaves_through_a_side_without_squeezing_the_fluid(side, towards):
    solver = flow.Solver(12, 12, 12)
    ends = ("-x", "+x")[::towards]
    solver.set_domain_bc(ends[0], "wall" if side == "outflow" else "outflow")
    solver.set_domain_bc(ends[1], side)
    for face in ("-y", "+y"):
        solver.set_domain_bc(face, "slip")
    solver.set_mu(0.5)
    solver.set_dt(0.25)
    place, speed = np.array([5.5 + 2.7 * towards, 5.4, 5.3]), 0.4 * towards
    scene = geom.SceneBuilder()
    scene.add_instance(scene.add_leaf("sphere", [2.6]), place, lin_vel=[speed, 0, 0])
    solver.set_scene(*scene.encode())
    solver.set_solid_from_scene()
    while abs(place[0] - 5.5) < 9:
        place[0] += 0.25 * speed
        solver.set_instance_transform(0, place)
        solver.step()
        assert max(np.abs(solver.get_field(name)).max() for name in "uvw") < 2.5 * 0.4
    assert np.abs(solver.hydro_force_torque_reaction()).max() == 0  # it is gone


def test_changing_a_velocity_keeps_the_flow_and_changing_a_type_keeps_it_too():
    solver = closed_box()
    solver.set_domain_bc("+y", "wall", [1, 0, 0])
    for _ in range(10):
        solver.step()
    before = solver.get_u()
    solver.set_domain_bc("+y", "wall", [2, 0, 0])
    assert np.array_equal(solver.get_u(), before)
    solver.step()
    assert solver.get_u()[:, -1].max() > 1.2 * before[:, -1].max()
    solver.set_domain_bc("+y", "slip")
    solver.step()
    assert np.abs(solver.get_u()).max() > 0.5 * np.abs(before).max()


def test_flow_that_turns_back_at_an_outflow_stays_bounded():
    # a vortex carried through the outflow makes fluid flow back there
    solver = flow.Solver((24, 16, 1), extent=(1.5, 1.0, 1.0 / 16))
    solver.set_domain_bc("-x", "inflow", [0.3, 0, 0])
    solver.set_domain_bc("+x", "outflow")
    solver.set_domain_bc("-y", "slip")
    solver.set_domain_bc("+y", "slip")
    x, y, _ = (c - 0.5 for c in np.meshgrid(*solver.cell_centers(), indexing="ij"))
    decay = 40 * np.exp(-((x - 0.5) ** 2 + y**2) / 0.02)
    solver.set_state(0.3 - decay * y, decay * (x - 0.5), np.zeros(x.shape))
    solver.set_mu(1e-3)
    solver.set_dt(0.006)
    solver.set_advection(True)
    solver.set_advection_scheme("koren")
    largest = []
    backflow = False
    for _ in range(520):
        solver.step()
        largest.append(np.abs(solver.get_v()).max())
        backflow = backflow or solver.get_u()[-1].min() < 0
    assert backflow
    assert max(largest[5:]) < 1.05 * largest[5]
    assert largest[-1] < 0.1 * largest[0]


def test_adaptive_steps_meet_their_target():
    solver = closed_box(mu=0.01)
    solver.set_domain_bc("+y", "wall", [1, 0, 0])
    solver.set_advection(True)
    assert solver.step_adaptive(dt_max=0.02) == 0.02
    for scheme, target, met in (("koren", 0.3, 0.3), ("koren", 5.0, 0.4), ("sou", 5.0, 0.2)):
        solver.set_advection_scheme(scheme)
        for _ in range(20):
            assert solver.step_adaptive(cfl_target=target) == solver.dt
        assert solver.courant_number == pytest.approx(met, rel=0.1)
    for name, value in (("cfl_target", 0.0), ("cfl_target", np.nan), ("dt_max", -1.0)):
        with pytest.raises(ValueError, match=name):
            solver.step_adaptive(**{name: value})


def test_a_step_for_bodies_about_to_move_is_short():
    solver = flow.Solver((12, 12, 12), extent=(0.6, 1.2, 1.2))
    solver.set_dt(100.0)
    scene = geom.SceneBuilder()
    ball = scene.add_leaf("sphere", [0.2])
    scene.add_instance(ball, [0.3, 0.6, 0.6], lin_vel=[0.4, 0, 0], ang_vel=[0, 0, 0.5])
    solver.set_scene(*scene.encode(), periodic=True)
    solver.set_solid_from_scene()
    rate = (0.4 + 0.5 * 0.2) / 0.05 + 0.5 * 0.2 / 0.1  # at a corner of the bounds
    assert solver.step_adaptive() == pytest.approx(0.4 / rate)


def test_a_large_courant_number_warns():
    solver = closed_box(mu=0.05, dt=0.01)
    solver.set_advection(True)
    solver.set_velocity(0, np.sin(np.arange(480)).reshape(8, 10, 6))
    solver.step()
    solver.set_dt(5.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")  # as in a script: the same text once
        for _ in range(3):
            solver.step()
            assert solver.courant_number > 0.5
    assert len(caught) == 1
    assert "Courant number" in str(caught[0].message)


def test_implicit_advection_has_no_courant_limit_but_that_of_scalars():
    solver = closed_box(mu=0.05, dt=0.01)
    solver.set_domain_bc("+y", "wall", [1, 0, 0])
    assert solver.implicit_advection is False
    solver.set_advection(True)
    solver.set_implicit_advection(True)
    assert solver.implicit_advection is True
    assert "implicit sou" in repr(solver)
    for target, met in ((None, 4.0), (9.0, 9.0)):
        for _ in range(20):
            solver.step_adaptive(target) if target else solver.step_adaptive()
        assert solver.courant_number == pytest.approx(met, rel=0.1)
    solver.add_scalar("c", 0.1)
    with pytest.warns(RuntimeWarning, match="Courant"):
        solver.step()
    solver.set_implicit_advection(False)
    with pytest.warns(RuntimeWarning, match="Courant"):
        solver.step()


@pytest.mark.parametrize("value", ["yes", 2, None, np.nan])
def test_implicit_advection_is_a_flag(value):
    solver = closed_box()
    with pytest.raises((TypeError, ValueError), match="on"):
        solver.set_implicit_advection(value)
    assert solver.implicit_advection is False


@pytest.mark.parametrize("dt", [1.0, 100.0, 1e4])
@pytest.mark.parametrize(
    ("x_low", "x_high", "y_low", "y_high"),
    [("slip",) * 4, ("wall",) * 4, ("wall", "outflow", "slip", "slip"), ("outflow",) * 4],
    ids=["slip", "wall", "two outflows", "five outflows"],
)
def test_creeping_flow_through_outflows_decays_at_any_time_step(x_low, x_high, y_low, y_high, dt):
    # diffusion number nu dt / h^2 = dt; velocities of random sign flow in and out
    solver = flow.Solver((12, 12, 12), extent=(12, 12, 12))
    solver.set_mu(1.0)
    solver.set_dt(dt)
    for face, kind in zip(("-x", "+x", "-y", "+y"), (x_low, x_high, y_low, y_high), strict=True):
        solver.set_domain_bc(face, kind)
    solver.set_domain_bc("-z", "wall")
    solver.set_domain_bc("+z", "outflow")
    solver.set_state(*np.random.default_rng(1).standard_normal((3, 12, 12, 12)))
    largest = []
    for _ in range(40):
        solver.step()
        largest.append(solver.max_velocity())
    assert largest[19] < 0.1
    assert largest[39] < 0.8 * largest[19]
