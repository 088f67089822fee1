"""Names of release 0.5, in which the compatible script is written, for later releases of the reference."""


def use_older_names() -> None:
    """Give the installed modules the older names where they lack them; ours know both.

    The harness has given them peclet.core.geom before.
    """
    from peclet import dem, flow

    if hasattr(flow.Solver, "set_velocity_solver_params"):
        return

    class Solver(flow.Solver):
        def __getattr__(self, name):
            return getattr(self.diagnostics, name)

        def set_advection_scheme(self, scheme):
            super().set_advection_scheme(("sou", "koren")[scheme])

        def set_body_force(self, *force):
            super().set_body_force(force)

    class Simulation(dem.Simulation):
        def set_gravity(self, *gravity):
            super().set_gravity(gravity)

        def set_sphere_shape(self, radius):
            self.initialize_shape("sphere", radius)

        def step(self, time_step):
            self.set_dt(time_step)
            super().step(1)

    flow.Solver, dem.Simulation = Solver, Simulation
