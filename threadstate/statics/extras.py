"""Numbers of a loaded state that are computed on request: reaction, range of forces, contact modes."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import StrEnum

from threadstate.errors import UnknownNameError
from threadstate.state.model import ContactState, Vector
from threadstate.statics.modes import ContactMode, modes_are_enumerated, modes_of
from threadstate.statics.ranges import ForcesRange, forces_range_of
from threadstate.statics.reaction import Reaction, reaction_in
from threadstate.statics.scene import scene_of
from threadstate.statics.solve import Statics
from threadstate.thread.pair import Pair


class Extra(StrEnum):
    """What can be requested."""

    REACTION = "reaction"
    FORCES_RANGE = "forces_range"
    MODES = "modes"


@dataclass(frozen=True, slots=True)
class Extras:
    """What was requested; None what was not.

    ``modes`` are None as well where they are not enumerated, on a patch. ``origin`` is the bolt's: twists are about it.
    """

    requested: frozenset[Extra]
    origin: Vector
    reaction: Reaction | None
    forces_range: ForcesRange | None
    modes: tuple[ContactMode, ...] | None


def requested_extras(names: str) -> frozenset[Extra]:
    """The extras of names that are separated by commas.

    Raises:
        UnknownNameError: a name is none of them.
    """
    given = [name.strip() for name in names.split(",")]
    for name in given:
        if name not in list(Extra):
            raise UnknownNameError("include", name, ", ".join(Extra))
    return frozenset(map(Extra, given))


def extras_of(pair: Pair, state: ContactState, statics: Statics, requested: Collection[Extra]) -> Extras:
    """What is requested of a state whose statics under a load are known.

    Raises:
        UnresolvedPoseError: a contact has no certain normal.
    """
    scene = scene_of(pair, state, statics.load)
    held = statics.mu >= statics.hold.upper
    has_modes = Extra.MODES in requested and modes_are_enumerated(state)
    return Extras(
        requested=frozenset(requested),
        origin=scene.contacts.origin,
        reaction=reaction_in(scene, statics.mu, held=held) if Extra.REACTION in requested else None,
        forces_range=forces_range_of(scene, statics.mu, held=held) if Extra.FORCES_RANGE in requested else None,
        modes=modes_of(scene, statics.mu) if has_modes else None,
    )
