"""Two settling spheres, written against the calls of the reference 0.5.1 and nothing else.

Packed arrays for the instances, integers for the advection scheme, dem.step(dt), a virtual mass by hand.
Cell units; the tank is a solid in a periodic box because the reference gives no forces beside domain walls.

python tests/validation/compatible_script.py [steps] [cells per diameter: 6, 8 or 12]
"""

import sys

import numpy as np
from peclet import dem, flow
from peclet.core import geom

KI_I, KI_R = 2, 17  # columns of the instance records
OFF = 0.3  # keeps surfaces off the points of the lattice

# d/h = 6: tank of 36 x 144 x 36 cells, spheres of radius 3.
D = int(sys.argv[2]) if __name__ == "__main__" and len(sys.argv) > 2 else 6
NX, NY, NZ = {6: (48, 160, 48), 8: (64, 208, 64), 12: (88, 304, 88)}[D]
TANK = (6 * D, 24 * D, 6 * D)
R = D / 2
DT = 3.75
NU = 2.26714e-3 * D / 6  # 0.01 cm2/s
G = 1.08073e-3 * 6 / D  # 981 cm/s2
RHO_S = 1.14
SUBSTEPS = 10

V = 4.0 / 3.0 * np.pi * R**3
MASS = RHO_S * V
MA = 2.0 * V  # virtual mass
INERTIA = 0.4 * MASS * R * R

CX, CY, CZ = NX / 2 + OFF, NY / 2 + OFF, NZ / 2 + OFF
FLOOR = CY - TANK[1] / 2


def start_positions():
    """Leader below, follower above and a little to the side."""
    h = 1.0 / (6 * D)  # cm per cell
    return np.array(
        [[CX, FLOOR + 3.16 / h, CZ], [CX + 0.005 * 2 * R, FLOOR + 3.5 / h, CZ]],
        dtype=np.float32,
    )


def make_solver(positions):
    """The fluid, the tank (instance 0) and the spheres (1 and 2)."""
    sb = geom.SceneBuilder()
    slab = sb.add_leaf("box", [NX / 2 + 1.0, NY / 2 + 1.0, NZ / 2 + 1.0])
    cavity = sb.add_leaf("box", [TANK[0] / 2, TANK[1] / 2, TANK[2] / 2])
    tank = sb.add_difference(slab, cavity)
    ball = sb.add_leaf("sphere", [R])
    ni, nr, _, _ = sb.encode()

    n = 3
    ii = np.zeros((n, KI_I), dtype=np.int32)
    ir = np.zeros((n, KI_R), dtype=np.float64)
    ii[0] = (tank, -1)
    ii[1:] = (ball, -1)
    ir[0, 0:3] = (CX, CY, CZ)
    ir[1:, 0:3] = positions
    ir[:, 6] = 1.0  # quaternion w
    ir[:, 7] = 1.0  # scale

    s = flow.Solver(NX, NY, NZ)
    s.set_rho(1.0)
    s.set_mu(NU)
    s.set_dt(DT)
    s.set_advection(True)
    s.set_advection_scheme(1)
    s.set_velocity_solver_params(60)
    s.set_pressure_solver_params(200)
    s.set_pressure_multigrid(True, 4)
    s.set_body_force(0.0, 0.0, 0.0)
    s.set_scene(ni, nr, ii.ravel(), ir.ravel(), True)
    s.set_solid_from_scene(True)
    assert s.periodic_image_overlap_cells() == 0
    return s


def make_particles(positions):
    """Two spheres that carry the virtual mass as well."""
    sim = dem.Simulation(8)
    sim.set_gravity(0.0, 0.0, 0.0)
    sim.set_sphere_shape(R)
    sim.set_positions(positions)
    sim.set_inv_mass(np.full(2, 1.0 / (MASS + MA), dtype=np.float32))
    sim.set_inv_inertia(np.full((2, 3), 1.0 / INERTIA, dtype=np.float32))
    return sim


def run(steps, report=None):
    """The coupled loop; returns the last state and the two solvers."""
    positions = start_positions()
    s = make_solver(positions)
    sim = make_particles(positions)
    weight = np.array([0.0, -(RHO_S - 1.0) * V * G, 0.0])
    a_prev = np.zeros((2, 3))
    force = np.zeros((2, 3))
    for step in range(steps):
        x, q = sim.get_positions(), sim.get_quaternions()
        v, w = sim.get_velocities(), sim.get_angular_velocities()
        for b in range(2):
            s.set_instance_transform(1 + b, x[b].tolist(), q[b].tolist())
            s.set_instance_motion(1 + b, v[b].tolist(), w[b].tolist())
        s.rebuild_geometry()
        s.step()
        ft = s.hydro_force_torque_reaction()
        force, torque = ft[0, 1:], ft[1, 1:]
        total = force + weight + MA * a_prev
        sim.set_external_forces(total.astype(np.float32))
        sim.set_external_torques(torque.astype(np.float32))
        for _ in range(SUBSTEPS):
            sim.step(DT / SUBSTEPS)
        a_prev = (sim.get_velocities() - v) / DT
        if report is not None:
            report(step, sim, s, force)
    return {"flow": s, "particles": sim, "start": positions, "force": force}


if __name__ == "__main__":
    run(
        int(sys.argv[1]) if len(sys.argv) > 1 else 980,
        lambda step, sim, s, force: print(
            step, *sim.get_positions()[:, 1], *sim.get_velocities()[:, 1], s.last_pressure_iterations()
        ),
    )
