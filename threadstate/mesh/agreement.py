"""Whether two tessellations give the same state of a pose.

Where meshes are too coarse for a pose (contacts nearer to each other, in place or in order, than the meshes are to the
surfaces) a state is wrong without any indication; but then another tessellation, with other errors, gives another one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import LARGEST_CHORD
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag

COARSENING = 4.0
"""How many times as coarse the other tessellation is; as fine where that is out of range."""
COMPARED_FLAGS = (Flag.FLUSH, Flag.NO_SECOND, Flag.NO_THIRD)
"""The flags that have to agree; not that of a tie, of contacts at one step, which other meshes separate."""


def other_tessellation(options: MeshOptions) -> MeshOptions:
    """The options with another tessellation, whose answer has to agree."""
    tessellation = options.tessellation
    coarser = COARSENING * tessellation.chord_height
    chord = coarser if coarser <= LARGEST_CHORD else tessellation.chord_height / COARSENING
    return replace(options, tessellation=replace(tessellation, chord_height=chord))


def disagreement(one: ContactState, other: ContactState, near: float) -> str | None:
    """How the states of two tessellations disagree, in words; None where they agree.

    They agree where each contact of either has one of the same stage and features in the other, no farther than
    ``near`` (in the pair's unit) from it, and both come to lie flush or neither. A patch's extreme points need not.
    """
    for flag in COMPARED_FLAGS:
        if (flag in one.flags) != (flag in other.flags):
            return f"two tessellations disagree: one alone is flagged {flag.value}"
    for here, there in ((one, other), (other, one)):
        for contact in _points(here):
            if not any(_same(contact, candidate, near) for candidate in _points(there)):
                return f"two tessellations disagree about the contact of stage {contact.stage}"
    return None


def _points(state: ContactState) -> Iterable[Contact]:
    return (contact for contact in state.contacts if contact.features is not FeaturePair.FLUSH)


def _same(one: Contact, other: Contact, near: float) -> bool:
    return one.stage == other.stage and one.features == other.features and math.dist(one.point, other.point) <= near
