"""How the contacts of two states differ."""

from __future__ import annotations

import math
from itertools import zip_longest

from threadstate.history.labels import contact_labels
from threadstate.history.model import ContactChange
from threadstate.state.model import Contact, ContactState

UNMOVED = 1e-6
"""A contact of the same labels that moves less, as a multiple of its distance from the axis, is the same."""


def contact_changes(before: ContactState | None, after: ContactState | None) -> tuple[ContactChange, ...]:
    """The contacts that differ in a label or in place, by stage; none where one state is undecided (None)."""
    if before is None or after is None:
        return ()
    changes = []
    for stage in (1, 2, 3):
        contacts = ([c for c in state.contacts if c.stage == stage] for state in (before, after))
        for place, (one, other) in enumerate(zip_longest(*contacts)):
            change = _change(stage, place, one, other)
            if change.labels_differ or (one is not None and other is not None and _jumps(one, other)):
                changes.append(change)
    return tuple(changes)


def _change(stage: int, place: int, before: Contact | None, after: Contact | None) -> ContactChange:
    return ContactChange(
        stage,
        place,
        None if before is None else contact_labels(before),
        None if after is None else contact_labels(after),
        None if before is None or after is None else math.dist(before.point, after.point),
    )


def _jumps(before: Contact, after: Contact) -> bool:
    return math.dist(before.point, after.point) > UNMOVED * math.hypot(before.point[0], before.point[1])
