"""State of the flow and of the contacts, as named arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from peclet.coupling.checkpoint import State, require_shapes

_CONTACTS = {"positions": 3, "velocities": 3, "angular_velocities": 3, "quaternions": 4}


def contact_state(contacts: Any) -> State:
    """Pose and velocity of all particles, and the forces that contacts carry on."""
    touching, carried = contacts.get_carried_forces()
    motion = {name: getattr(contacts, f"get_{name}")() for name in _CONTACTS}
    return motion | {"touching": touching, "carried_forces": carried}


def require_valid(flow: Any, flow_part: State, contacts: Any, contact_part: State) -> None:
    """Raise ValueError unless both parts fit the flow and the contacts."""
    require_shapes(flow_part, {name: array.shape for name, array in flow.checkpoint().items()}, "flow")
    count = contacts.num_particles()
    touching = contact_part.get("touching", np.zeros(0))
    rows = touching.size // 3
    shapes = {name: (count, n) for name, n in _CONTACTS.items()}
    shapes |= {"touching": (rows, 3), "carried_forces": (rows, 7)}
    require_shapes(contact_part, shapes, "contacts")
    if touching.dtype.kind not in "iu" or not ((touching[:, 0] >= 0) & (touching[:, 0] < count)).all():
        raise ValueError(f"contacts/touching: expected first bodies from 0 to below {count}, found others")
    if not contact_part["quaternions"].any(axis=-1).all():
        raise ValueError("contacts/quaternions: expected rotations, found zero")


def restore(flow: Any, flow_part: State, contacts: Any, contact_part: State) -> None:
    """Take over what require_valid() accepted. Masses and inertias of the particles go back to defaults."""
    flow.restore(flow_part)
    scales = contacts.get_scales()
    contacts.set_positions(contact_part["positions"])
    contacts.set_scales(scales)
    for name in ("velocities", "angular_velocities", "quaternions"):
        getattr(contacts, f"set_{name}")(contact_part[name])
    contacts.set_carried_forces(contact_part["touching"], contact_part["carried_forces"])
