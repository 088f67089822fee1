"""Runs of the coupled simulation that go on from a file or from a state."""

import builtins

import numpy as np
import pytest
from peclet.coupling import checkpoint

from tests.python.coupling_scenes import TOUCHING, build
from tests.same import assert_same


@pytest.mark.parametrize("suffix", ["npz", "h5"])
def test_goes_on_from_a_file_bit_by_bit(tmp_path, suffix):
    if suffix == "h5":
        pytest.importorskip("h5py")
    whole, first, second = build(), build(), build()
    whole.run(6, progress=False)
    first.run(3, progress=False)
    first.save(tmp_path / f"run.{suffix}")
    second.restart(tmp_path / f"run.{suffix}")
    second.run(3, progress=False)
    assert second.number_of_steps == 6
    for name, array in whole.history.items():
        assert_same(second.history[name], array, name)
    for name, array in whole.state().items():
        assert_same(second.state()[name], array, name)


def lying_on_each_other():
    """One sphere on a floor, another one that rolls down its side, with friction."""
    simulation = build(
        ((7.3, 3.0, 5.8), (8.6, 8.85, 5.8)), gravity=(0, -1e-2, 0), ratio=3.0, viscosity=0.1, time_step=0.5
    )
    simulation.contacts.add_plane((0, 0, 0), (0, 1, 0))
    simulation.contacts.set_material_params(0.0, 0.0, 0.5)
    return simulation


def test_goes_on_bit_by_bit_while_bodies_touch():
    whole, second = lying_on_each_other(), lying_on_each_other()
    whole.run(5, progress=False)
    state = whole.state()
    assert np.abs(state["contacts/carried_forces"][:, 1:4]).max() > 0
    second.set_state(state)
    for simulation in (whole, second):
        simulation.run(3, progress=False)
    for name, array in whole.state().items():
        assert_same(second.state()[name], array, name)


def test_refuses_contacts_of_particles_that_are_not_there():
    simulation = lying_on_each_other()
    simulation.run(3, progress=False)
    state = simulation.state()
    state["contacts/touching"] = state["contacts/touching"] + np.array([2, 0, 0], dtype=np.int32)
    with pytest.raises(ValueError, match="contacts/touching: expected first bodies from 0 to below 2"):
        simulation.set_state(state)
    for name in ("contacts/touching", "history/time"):
        with pytest.raises(ValueError, match=f"{name}.* shape"):
            simulation.set_state(simulation.state() | {name: np.array(1)})
    with pytest.raises(ValueError, match="contacts: expected first particles from 0 to below 2, found"):
        simulation.contacts.set_carried_forces([[2, 0, 0]], np.zeros((1, 7)))


def test_says_which_extra_is_missing(tmp_path, monkeypatch):
    original = builtins.__import__

    def without_h5py(name, *args, **kwargs):
        if name == "h5py":
            raise ImportError(name)
        return original(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without_h5py)
    with pytest.raises(ImportError, match=r"peclet-resolved\[io\]"):
        build().save(tmp_path / "run.h5")
    assert list(tmp_path.iterdir()) == []


def test_refuses_the_state_of_another_run_and_stays_as_it_was():
    simulation, other = build(), build(TOUCHING, radius=2.0)
    simulation.run(2, progress=False)
    before = simulation.state()
    with pytest.raises(ValueError, match=r"expected .* found"):
        simulation.set_state(other.state())
    broken = simulation.state()
    broken["flow/u"] = broken["flow/u"] * np.nan
    with pytest.raises(ValueError, match="finite numbers in flow/u"):
        simulation.set_state(broken)
    for name, array in simulation.state().items():
        assert np.array_equal(array, before[name]), name


@pytest.mark.parametrize("name", ["run.txt", "run"])
def test_refuses_unknown_kinds_of_files(tmp_path, name):
    with pytest.raises(ValueError, match=r"path: expected .*\.npz or \.h5"):
        checkpoint.write(tmp_path / name, {})
    with pytest.raises(FileNotFoundError, match="path: expected a file written by save"):
        checkpoint.read(tmp_path / "missing.npz")
