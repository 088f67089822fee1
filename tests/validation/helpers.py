"""What the flow cases share: boxes with spheres, and fields stacked."""

import numpy as np
from peclet import flow

from tests.python.flow_scenes import face_is_fluid, spheres


def box_of_fluid(cells, *, rho=1.0, mu=1.0, dt=1.0, force=(0, 0, 0), scheme=None):
    """A periodic box in cell units; no advection without a scheme."""
    solver = flow.Solver(*((cells,) * 3 if np.isscalar(cells) else cells))
    solver.set_rho(rho)
    solver.set_mu(mu)
    solver.set_dt(dt)
    solver.set_body_force(*force)
    if scheme:
        solver.set_advection_scheme(scheme)
        solver.set_advection(True)
    return solver


def put_spheres(solver, *bodies):
    """Spheres (centre, radius, velocity, angular velocity), repeated with the box; fluid at rest."""
    solver.set_scene(*spheres(*bodies), periodic=True)
    solver.set_solid_from_scene()
    return solver


def velocities(solver):
    """The three components, zero inside bodies, stacked."""
    return np.array([solver.get_u(), solver.get_v(), solver.get_w()])


def fluid_points(solver):
    """Where a velocity component is an unknown."""
    sdf = solver.get_field("sdf")
    return np.array([face_is_fluid(sdf, axis) for axis in range(3)])


def stream(solver, velocity):
    """Fluid moving uniformly."""
    shape = tuple(solver.cells)
    solver.set_state(*(np.full(shape, float(component)) for component in velocity))
