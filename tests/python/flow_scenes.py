"""Small scenes, packed by hand as scripts do it."""

import numpy as np

from tests.same import assert_same

AT_REST = (0.0, 0.0, 0.0)
FIELDS = ("u", "v", "w", "p", "sdf")


def spheres(*bodies, pinned=None):
    """Records of spheres (centre, radius, velocity = 0, angular velocity = 0), with 17 columns."""
    nodes, instances = [], []
    for center, radius, *motion in bodies:
        linear, angular = (*motion, AT_REST, AT_REST)[:2]
        nodes.append([radius, *[0.0] * 7, 0, 0, 0, 0, 0, 0, 1, 1])
        instances.append([*center, 0, 0, 0, 1, 1, *linear, *angular, 0, 0, 0])
    count = len(bodies)
    node_ints = np.array([[1, -1, -1]] * count, dtype=np.int32)
    instance_ints = np.array([[n, -1] for n in range(count)], dtype=np.int32)
    return node_ints.ravel(), np.array(nodes).ravel(), instance_ints.ravel(), np.array(instances).ravel()


def face_is_fluid(sdf, axis):
    """A face counts as fluid where the mean distance of its two cells is not negative."""
    return sdf + np.roll(sdf, 1, axis=axis) >= 0


def box_with(solver, *bodies):
    """Put these spheres into a periodic scene and build the geometry."""
    solver.set_scene(*spheres(*bodies), periodic=True)
    solver.set_solid_from_scene()
    return solver


def assert_same_flow(one, other):
    """Fields and loads are the same."""
    for name in FIELDS:
        assert_same(one.get_field(name), other.get_field(name), name)
    assert_same(one.hydro_force_torque_reaction(), other.hydro_force_torque_reaction())


def state(solver):
    """Everything that an error must leave as it was."""
    settings = (
        solver.density,
        solver.viscosity,
        solver.dt,
        tuple(solver.body_force),
        solver.advection_scheme,
        solver.velocity_residual_tolerance(),
        solver.pressure_tolerance(),
        solver.has_scene(),
        solver.num_scene_instances(),
        solver.time,
    )
    fields = [solver.get_field(name) for name in solver.field_names()]
    fields += [solver.get_ox(), solver.get_oy(), solver.get_oz(), solver.get_cut_owner()]
    return settings, [field.tobytes(order="F") for field in fields]
