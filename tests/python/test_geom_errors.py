"""Bad input to peclet.core.geom: the error names the argument and the scene stays as it was."""

import math

import numpy as np
import pytest
from peclet.core import geom

NAN, INF = math.nan, math.inf


@pytest.fixture
def scene():
    scene = geom.SceneBuilder()
    scene.add_leaf("sphere", [1.0])
    scene.add_instance(0)
    return scene


def assert_refused(scene, error, message, call):
    before = [array.tobytes() for array in scene.encode()]
    with pytest.raises(error, match=message):
        call(scene)
    assert [array.tobytes() for array in scene.encode()] == before


LEAF_ERRORS = [
    (ValueError, "ball.*|expected one of.*sphere", ("ball", [1.0]), {}),
    (ValueError, "params", ("sphere", []), {}),
    (ValueError, "params", ("sphere", [1.0, 2.0]), {}),
    (ValueError, "params", ("box", [1.0, 2.0]), {}),
    (ValueError, "params", ("box", list(range(1, 11))), {}),
    (ValueError, "params", ("sphere", [0.0]), {}),
    (ValueError, "params", ("sphere", [-1.0]), {}),
    (ValueError, "params", ("sphere", [NAN]), {}),
    (ValueError, "params", ("sphere", [INF]), {}),
    (ValueError, "params", ("sphere", [[1.0]]), {}),
    (ValueError, "thickness", ("hollow_cylinder", [1.0, 1.0, 1.5]), {}),
    (ValueError, "inner radius", ("hollow_cylinder_shell", [1.0, 1.0, 1.0]), {}),
    (ValueError, "radius", ("cone", [0.0, 0.0, 1.0]), {}),
    (ValueError, "exponent", ("superquadric", [1, 1, 1, 0]), {}),
    (TypeError, "params", ("sphere", ["one"]), {}),
    (TypeError, "params", ("sphere", None), {}),
    (TypeError, "params", ("sphere", [1j]), {}),
    (TypeError, None, (3, [1.0]), {}),
    (ValueError, "translation", ("sphere", [1.0]), {"translation": [1, 2]}),
    (ValueError, "translation", ("sphere", [1.0]), {"translation": [1, 2, NAN]}),
    (ValueError, "translation", ("sphere", [1.0]), {"translation": 1.0}),
    (ValueError, "rotation", ("sphere", [1.0]), {"rotation": [0, 0, 0, 0]}),
    (ValueError, "rotation", ("sphere", [1.0]), {"rotation": [0, 0, 1]}),
    (ValueError, "rotation", ("sphere", [1.0]), {"rotation": [0, 0, 1, INF]}),
    (ValueError, "scale", ("sphere", [1.0]), {"scale": 0.0}),
    (ValueError, "scale", ("sphere", [1.0]), {"scale": -1.0}),
    (ValueError, "scale", ("sphere", [1.0]), {"scale": NAN}),
    (TypeError, None, ("sphere", [1.0]), {"scale": "large"}),
]


@pytest.mark.parametrize(("error", "message", "args", "kwargs"), LEAF_ERRORS)
def test_add_leaf(scene, error, message, args, kwargs):
    assert_refused(scene, error, message, lambda s: s.add_leaf(*args, **kwargs))


@pytest.mark.parametrize("name", ["add_union", "add_intersection", "add_difference"])
def test_operations(scene, name):
    add = lambda *args, **kwargs: lambda s: getattr(s, name)(*args, **kwargs)  # noqa: E731
    assert_refused(scene, ValueError, "a: ", add(1, 0))
    assert_refused(scene, ValueError, "b: ", add(0, 1))
    assert_refused(scene, ValueError, "b: ", add(0, -1))
    assert_refused(scene, ValueError, "a: .*found 1099511627776", add(2**40, 0))
    assert_refused(scene, TypeError, None, add(0.5, 0))
    assert_refused(scene, ValueError, "scale", add(0, 0, scale=0))
    assert_refused(scene, ValueError, "rotation", add(0, 0, rotation=[0, 0, 0, 0]))
    assert_refused(scene, ValueError, "translation", add(0, 0, translation=[NAN, 0, 0]))


def test_reframed_and_instances(scene):
    assert_refused(scene, ValueError, "root", lambda s: s.add_reframed(7))
    assert_refused(scene, ValueError, "scale", lambda s: s.add_reframed(0, scale=0.0))
    for kwargs, message in (
        ({"root": -1}, "root"),
        ({"scale": 0.0}, "scale"),
        ({"lin_vel": [0, NAN, 0]}, "lin_vel"),
        ({"ang_vel": [0, 0]}, "ang_vel"),
        ({"center": [0, NAN, 0]}, "center"),
        ({"center": [0, INF, 0]}, "center"),
        ({"material": -2}, "material"),
    ):
        assert_refused(scene, ValueError, message, lambda s, k=kwargs: s.add_instance(**{"root": 0, **k}))


def test_root_without_nodes():
    with pytest.raises(ValueError, match=r"root: .*none"):
        geom.SceneBuilder().eval_root(0, [[0, 0, 0]])


@pytest.mark.parametrize(
    ("points", "error", "message"),
    [
        (np.zeros(3), ValueError, r"points: expected an array of shape \(\*, 3\), found \(3,\)"),
        (np.zeros((2, 2)), ValueError, "points"),
        (np.zeros((1, 2, 3)), ValueError, "points"),
        ([[0, 0, 0], [0, NAN, 0]], ValueError, r"points\[1, 1\].*finite"),
        ([[0, 0, 0], [0, 0]], TypeError, "points"),
        ("text", TypeError, "points"),
        (None, TypeError, "points"),
        (np.zeros((1, 3), dtype=complex), TypeError, "points.*complex"),
    ],
)
def test_points(scene, points, error, message):
    for call in (scene.eval, lambda p: scene.eval_root(0, p), lambda p: scene.eval_root_grad(0, p)):
        with pytest.raises(error, match=message):
            call(points)


def test_bake(scene):
    good = {"root": 0, "origin": [0, 0, 0], "spacing": [1, 1, 1], "dims": [2, 2, 2]}
    for change, error, message in (
        ({"root": 1}, ValueError, "root"),
        ({"origin": [0, 0, NAN]}, ValueError, "origin"),
        ({"spacing": [1, 0, 1]}, ValueError, "spacing"),
        ({"spacing": [1, -1, 1]}, ValueError, "spacing"),
        ({"dims": [2, 2, 0]}, ValueError, "dims"),
        ({"dims": [2, 2]}, ValueError, "dims"),
        ({"dims": [2, 2, 2.5]}, ValueError, "dims"),
        ({"dims": [2**30, 2**30, 2**30]}, ValueError, "dims"),
        ({"dims": [2**40, 1, 1]}, ValueError, "dims"),
    ):
        with pytest.raises(error, match=message):
            scene.bake(**{**good, **change})


@pytest.mark.parametrize("name", ["body_properties", "principal_frame"])
def test_mass_properties(scene, name):
    good = {"root": 0, "lo": [-2, -2, -2], "hi": [2, 2, 2], "n": 4}
    for change, message in (
        ({"root": 1}, "root"),
        ({"lo": [-0.5, -2, -2]}, "lo, hi: expected a box that contains the whole body"),
        ({"lo": [1.5, 1.5, 1.5]}, "lo, hi"),
        ({"hi": [-3, 2, 2]}, "hi"),
        ({"hi": [2, 2, NAN]}, "hi"),
        ({"n": 0}, "n"),
        ({"n": 100000}, "n"),
        ({"order": 0}, "order"),
        ({"order": 17}, "order"),
        ({"nseg": 0}, "nseg"),
        ({"nseg": 33}, "nseg"),
    ):
        assert_refused(scene, ValueError, message, lambda s, c=change: getattr(s, name)(**{**good, **c}))
    with pytest.raises(ValueError, match="density"):
        scene.body_properties(**good, density=0.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda r: r[0].__setitem__(0, 10), "opcode"),
        (lambda r: r[0].__setitem__(1, 0), "children"),
        (lambda r: r[1].__setitem__(0, -1), "parameters"),
        (lambda r: r[1].__setitem__(1, 5), "parameters"),
        (lambda r: r[1].__setitem__(15, 0), "scale"),
        (lambda r: r[1].__setitem__(14, 0), "rotation"),
        (lambda r: r[2].__setitem__(0, 1), "root"),
        (lambda r: r[3].__setitem__(6, 0), "rotation"),
        (lambda r: r.__setitem__(3, r[3][:16]), "17 or 18"),
        (lambda r: r.__setitem__(0, r[0] + 0.5), "node_ints"),
    ],
)
def test_records(scene, change, message):
    records = list(scene.encode())
    change(records)
    with pytest.raises(ValueError, match=message):
        geom.SceneBuilder.decode(*records)


def test_cyclic_records():
    nodes = np.array([[32, 1, 1], [33, 0, 0]])
    reals = np.zeros((2, 16))
    reals[:, 14:] = 1
    with pytest.raises(ValueError, match="contain"):
        geom.SceneBuilder.decode(nodes, reals, [], [])
