"""State of the flow and of the contacts, as named arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from peclet.coupling.checkpoint import State, require_shapes

_CONTACTS = {"positions": 3, "velocities": 3, "angular_velocities": 3, "quaternions": 4}


def contact_state(contacts: Any) -> State:
    """Pose and velocity of all particles."""
    return {name: getattr(contacts, f"get_{name}")() for name in _CONTACTS}


def require_valid(flow: Any, flow_part: State, contacts: Any, contact_part: State) -> None:
    """Raise ValueError unless both parts fit the flow and the contacts."""
    require_shapes(flow_part, {name: array.shape for name, array in flow.checkpoint().items()}, "flow")
    count = contacts.num_particles()
    require_shapes(contact_part, {name: (count, n) for name, n in _CONTACTS.items()}, "contacts")
    for name in _CONTACTS:
        if not np.isfinite(contact_part[name]).all():
            raise ValueError(f"contacts/{name}: expected finite numbers, found others")
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
