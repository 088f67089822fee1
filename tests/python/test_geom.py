"""Contract of peclet.core.geom: conventions, shapes and types of results."""

import math
import subprocess
import sys
import threading

import numpy as np
import pytest
from peclet.core import geom

HALF_THIRTY = math.radians(15)
TILT = [0.1, -0.4, 0.2, 0.7]

LEAVES = {
    "sphere": [1.5],
    "hollow_cylinder": [1.2, 1.6, 0.5],
    "box": [1.1, 0.6, 0.8],
    "hollow_cylinder_shell": [1.2, 0.9, 1.0],
    "capsule": [0.4, 0.9],
    "torus": [1.0, 0.3],
    "cone": [1.1, 0.4, 0.7],
    "ellipsoid": [1.3, 0.5, 0.8],
    "superquadric": [1.3, 0.6, 0.9, 3.0],
}


@pytest.fixture
def scene():
    return geom.SceneBuilder()


@pytest.fixture
def points():
    return np.random.default_rng(1).uniform(-3, 3, (200, 3))


@pytest.mark.parametrize("order", [("peclet.geom", "peclet.core.geom"), ("peclet.core.geom", "peclet.geom")])
def test_both_names_are_one_module_in_either_order(order):
    code = (
        f"import {order[0]}\nimport {order[1]}\n"
        "from peclet import geom as a\nfrom peclet.core import geom as b\nimport sys\n"
        "assert a is b is sys.modules['peclet.geom'] is sys.modules['peclet.core.geom']\n"
        "assert sys.modules['peclet'].geom is a and sys.modules['peclet.core'].geom is a\n"
    )
    subprocess.run([sys.executable, "-c", f"import sys\nsys.path[:0] = {sys.path!r}\n{code}"], check=True)


def test_build_toolchain_names_the_compiler():
    assert isinstance(geom.build_toolchain, str)
    assert "Kokkos" in geom.build_toolchain


def test_nodes_and_instances_count_from_zero(scene):
    assert (scene.num_nodes(), scene.num_instances()) == (0, 0)
    assert scene.add_leaf("sphere", [1.0]) == 0
    assert scene.add_leaf("box", [1, 2, 3], translation=[1, 0, 0]) == 1
    assert scene.add_union(0, 1) == 2
    assert scene.add_intersection(0, 1) == 3
    assert scene.add_difference(0, 1) == 4
    assert scene.add_reframed(4, translation=[0, 1, 0]) == 5
    assert scene.add_instance(5) == 0
    assert scene.add_instance(2, material=4) == 1
    assert (scene.num_nodes(), scene.num_instances()) == (6, 2)
    assert repr(scene) == "SceneBuilder(num_nodes=6, num_instances=2)"


@pytest.mark.parametrize(
    ("kind", "inside", "on_surface"),
    [
        ("sphere", [0, 0, 0], [0, 1.5, 0]),
        ("hollow_cylinder", [0, 0.7, 1.0], [0, 0.8, 1.0]),
        ("box", [1.0, 0.5, 0.7], [1.1, 0.1, 0.2]),
        ("hollow_cylinder_shell", [0, 1.0, 0.4], [0, 1.0, 0.5]),
        ("capsule", [0, 1.2, 0], [0, 1.3, 0]),
        ("torus", [0, 0.2, 1.0], [0, 0.3, 1.0]),
        ("cone", [1.0, -0.69, 0], [0.2, 0.7, 0.2]),
        ("ellipsoid", [1.2, 0, 0], [0, 0, 0.8]),
        ("superquadric", [1.2, 0, 0], [0, 0.6, 0]),
    ],
)
def test_leaves_lie_along_their_axes(scene, kind, inside, on_surface):
    root = scene.add_leaf(kind, LEAVES[kind])
    values = scene.eval_root(root, [inside, on_surface, [9, 9, 9]])
    assert values[0] < 0
    assert values[1] == pytest.approx(0, abs=1e-14)
    assert values[2] > 0


@pytest.mark.parametrize("kind", [kind for kind in LEAVES if kind != "superquadric"])
def test_distances_are_exact(scene, points, kind):
    root = scene.add_leaf(kind, LEAVES[kind], [0.3, -0.2, 0.5], TILT, 1.7)
    values, normals = scene.eval_root_grad(root, points)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1, abs=1e-12)
    assert scene.eval_root(root, points - values[:, None] * normals) == pytest.approx(0, abs=1e-12)


def test_sphere_at_a_cell_centre_samples_exactly(scene):
    scene.add_instance(scene.add_leaf("sphere", [4.0]), translation=[8, 8, 8])
    assert scene.eval([[8, 8, 8], [4, 8, 8], [12, 8, 8], [8, 8, 17]]).tolist() == [-4, 0, 0, 5]


def test_quarter_turn_about_z_maps_x_to_y(scene):
    root = scene.add_leaf("box", [3, 1, 1], rotation=[0, 0, 1, 1])
    assert scene.eval_root(root, [[0, 2.5, 0], [2.5, 0, 0]]) == pytest.approx([-0.5, 1.5])


def test_positive_angle_turns_x_towards_y(scene):
    root = scene.add_leaf("box", [2, 0.1, 0.1], rotation=[0, 0, math.sin(HALF_THIRTY), math.cos(HALF_THIRTY)])
    direction = [math.cos(2 * HALF_THIRTY), math.sin(2 * HALF_THIRTY), 0]
    assert scene.eval_root(root, [direction]) == pytest.approx(-0.1)


def test_quaternions_are_normalised(scene, points):
    one = scene.add_leaf("box", [3, 1, 2], rotation=TILT)
    two = scene.add_leaf("box", [3, 1, 2], rotation=2.5 * np.array(TILT))
    assert scene.eval_root(one, points) == pytest.approx(scene.eval_root(two, points), abs=1e-14)


def test_operations_are_minimum_and_maximum(scene, points):
    a, b = scene.add_leaf("box", [1, 2, 1]), scene.add_leaf("sphere", [1.5], [0.5, 0, 0])
    f, g = scene.eval_root(a, points), scene.eval_root(b, points)
    assert np.array_equal(scene.eval_root(scene.add_union(a, b), points), np.minimum(f, g))
    assert np.array_equal(scene.eval_root(scene.add_intersection(a, b), points), np.maximum(f, g))
    assert np.array_equal(scene.eval_root(scene.add_difference(a, b), points), np.maximum(f, -g))


def test_transform_of_an_operation_moves_both_children(scene, points):
    a, b = scene.add_leaf("box", [1, 2, 1]), scene.add_leaf("sphere", [1.5], [0.5, 0, 0])
    moved = scene.add_difference(a, b, translation=[1, 2, 3], scale=2.0)
    plain = scene.add_difference(a, b)
    assert scene.eval_root(moved, points) == pytest.approx(
        2 * scene.eval_root(plain, (points - [1, 2, 3]) / 2)
    )


def test_reframing_adds_a_further_transform(scene, points):
    root = scene.add_leaf("cone", LEAVES["cone"], [0.5, 0, 0], TILT, 0.5)
    moved = scene.add_reframed(root, [1, 2, 3], [0, 0, 1, 1], 2.0)
    # the quarter turn back maps (x, y) to (y, -x)
    local = (points - [1, 2, 3]) / 2
    local = np.stack([local[:, 1], -local[:, 0], local[:, 2]], axis=1)
    assert scene.eval_root(moved, points) == pytest.approx(2 * scene.eval_root(root, local), abs=1e-13)


def test_world_is_the_minimum_over_instances(scene, points):
    ball, cube = scene.add_leaf("sphere", [1.0]), scene.add_leaf("box", [0.5, 0.5, 0.5])
    scene.add_instance(ball, translation=[1, 0, 0], scale=0.5)
    scene.add_instance(cube, translation=[-1, 0, 0])
    small, far = scene.add_reframed(ball, [1, 0, 0], scale=0.5), scene.add_reframed(cube, [-1, 0, 0])
    expected = np.minimum(scene.eval_root(small, points), scene.eval_root(far, points))
    assert scene.eval(points) == pytest.approx(expected, abs=1e-14)


def test_an_empty_world_is_far_from_solid(scene):
    assert (scene.eval([[0, 0, 0]]) > 1e8).all()


def test_results_have_the_documented_types(scene, points):
    root = scene.add_leaf("sphere", [1.0])
    values = scene.eval_root(root, points)
    assert (values.shape, values.dtype) == ((200,), np.float64)
    values, slopes = scene.eval_root_grad(root, points)
    assert (slopes.shape, slopes.dtype) == ((200, 3), np.float64)
    assert slopes.flags.c_contiguous
    assert scene.eval_root(root, np.empty((0, 3))).shape == (0,)
    assert scene.eval(np.empty((0, 3))).shape == (0,)


def test_inputs_may_have_any_layout_and_type(scene, points):
    root = scene.add_leaf("box", [1, 2, 1])
    expected = scene.eval_root(root, points)
    wide = np.zeros((200, 6))
    wide[:, ::2] = points
    for same in (
        np.asfortranarray(points),
        wide[:, ::2],
        points.tolist(),
        points.astype(">f8"),
        points[::-1][::-1],
    ):
        assert np.array_equal(scene.eval_root(root, same), expected)
    assert scene.eval_root(root, points.astype(np.float32)) == pytest.approx(expected, abs=1e-6)
    assert scene.eval_root(root, np.array([[2, 0, 0]])) == pytest.approx(1.0)
    read_only = points.copy()
    read_only.flags.writeable = False
    assert np.array_equal(scene.eval_root(root, read_only), expected)


def test_bake_has_x_fastest(scene):
    root = scene.add_leaf("ellipsoid", LEAVES["ellipsoid"])
    origin, spacing, dims = np.array([-1, 0.5, 0]), np.array([0.5, 0.25, 1]), (5, 4, 3)
    flat = scene.bake(root, origin, spacing, dims)
    assert (flat.shape, flat.dtype) == ((60,), np.float32)
    grid = flat.reshape(dims, order="F")
    for index in ((0, 0, 0), (4, 0, 0), (0, 3, 0), (2, 1, 2)):
        assert grid[index] == pytest.approx(scene.eval_root(root, [origin + spacing * index])[0], abs=1e-6)


def test_results_outlive_the_scene():
    scene = geom.SceneBuilder()
    values = scene.eval_root(scene.add_leaf("sphere", [2.0]), [[0, 0, 0]])
    records = scene.encode()
    del scene
    assert values[0] == -2
    assert records[1][0] == 2


def test_encode_has_the_documented_layout(scene):
    a = scene.add_leaf("sphere", [1.5], [1, 2, 3])
    b = scene.add_leaf("cone", [2, 1, 0.5], rotation=[0, 0, 0, 2], scale=2)
    scene.add_difference(a, b)
    scene.add_instance(2, [7, 8, 9], lin_vel=[1, 2, 3], ang_vel=[4, 5, 6], material=3)
    scene.add_instance(0, center=[1, 1, 2])
    node_ints, node_reals, inst_ints, inst_reals = scene.encode()
    for array, dtype, size in (
        (node_ints, np.int32, 9),
        (node_reals, np.float64, 48),
        (inst_ints, np.int32, 4),
        (inst_reals, np.float64, 36),
    ):
        assert (array.dtype, array.shape) == (dtype, (size,))
        assert array.flags.c_contiguous
    assert node_ints.reshape(3, 3).tolist() == [[1, -1, -1], [7, -1, -1], [34, 0, 1]]
    nodes = node_reals.reshape(3, 16)
    assert nodes[0].tolist() == [1.5, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 0, 0, 0, 1, 1]
    assert nodes[1].tolist() == [2, 1, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2]
    assert nodes[2, :8].tolist() == [1, 0, 0, 0, 0, 0, 0, 0]
    assert inst_ints.tolist() == [2, 3, 0, -1]
    first, second = inst_reals.reshape(2, 18)
    assert first[:14].tolist() == [7, 8, 9, 0, 0, 0, 1, 1, 1, 2, 3, 4, 5, 6]
    assert np.isnan(first[14:17]).all()
    assert first[17] == 0
    assert second[14:].tolist() == [1, 1, 2, 1]


def test_an_empty_scene_encodes_to_empty_arrays(scene):
    assert [array.shape for array in scene.encode()] == [(0,)] * 4


def test_decode_undoes_encode(scene, points):
    root = scene.add_union(scene.add_leaf("torus", [1, 0.3], rotation=TILT), scene.add_leaf("sphere", [0.4]))
    scene.add_instance(root, [1, 0, 0])
    again = geom.SceneBuilder.decode(*scene.encode())
    assert np.array_equal(again.eval(points), scene.eval(points))
    shorter = list(scene.encode())
    shorter[3] = shorter[3].reshape(1, 18)[:, :17]
    assert np.array_equal(geom.SceneBuilder.decode(*shorter).eval(points), scene.eval(points))


def test_bounds_enclose_the_solid(scene):
    low, high = scene.bounds(scene.add_leaf("box", [3, 1, 2], [1, 0, 0], [0, 0, 1, 1]))
    assert low == pytest.approx([0, -3, -2])
    assert high == pytest.approx([2, 3, 2])


def test_mass_properties_of_a_sphere(scene):
    root = scene.add_leaf("sphere", [1.5], [1, 2, 3])
    body = scene.body_properties(root, [-1, 0, 1], [3, 4, 5], density=2.0)
    volume = 4 / 3 * math.pi * 1.5**3
    assert set(body) == {"volume", "mass", "com", "inertia_tensor", "principal", "rotation", "quat"}
    assert body["volume"] == pytest.approx(volume, rel=1e-12)
    assert body["mass"] == pytest.approx(2 * volume, rel=1e-12)
    assert body["com"] == pytest.approx([1, 2, 3], abs=1e-12)
    assert body["inertia_tensor"] == pytest.approx(
        0.4 * 2 * volume * 1.5**2 * np.eye(3), rel=1e-12, abs=1e-12
    )
    assert body["quat"].tolist() == [0, 0, 0, 1]


def test_principal_moments_ascend_along_their_axes(scene):
    root = scene.add_leaf("ellipsoid", [1.0, 3.0, 2.0], [1, 2, 3], TILT)
    body = scene.body_properties(root, [-4] * 3, [8] * 3, n=8)
    mass = 4 / 3 * math.pi * 6
    assert body["principal"] == pytest.approx(mass / 5 * np.array([5.0, 10.0, 13.0]), rel=1e-7)
    axes = body["rotation"]
    assert axes.T @ body["inertia_tensor"] @ axes == pytest.approx(np.diag(body["principal"]), abs=1e-8)
    assert np.linalg.det(axes) == pytest.approx(1)


def test_principal_frame_centres_and_aligns(scene):
    root = scene.add_leaf("ellipsoid", [1.0, 3.0, 2.0], [1, 2, 3], TILT)
    framed = scene.principal_frame(root, [-4] * 3, [8] * 3, n=8)
    assert framed == root + 1
    # smallest moment along x: the longest semi-axis lies there
    tips = np.diag([3.0, 2.0, 1.0])
    assert scene.eval_root(framed, np.concatenate([tips, -tips])) == pytest.approx(0, abs=1e-7)


def test_threads_may_change_the_scene_while_others_evaluate(scene, points):
    root = scene.add_leaf("ellipsoid", LEAVES["ellipsoid"])
    expected = scene.eval_root(root, points)

    def grow():
        for _ in range(300):
            scene.add_leaf("sphere", [1.0])

    thread = threading.Thread(target=grow)
    thread.start()
    while thread.is_alive():
        assert np.array_equal(scene.eval_root(root, points), expected)
    thread.join()
