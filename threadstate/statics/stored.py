"""The statics that a library stores of its states: under the default load, a push of 1 N along -z at the bolt's origin.

Their names are those of the columns, of the fields in documents and of the order of states.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from operator import attrgetter
from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.state.document import StateDocument, state_document
from threadstate.state.model import ContactState

MEANINGS = {
    "support_margin": "distance of the default load from the boundary of what the contacts balance without friction, "
    "of the load's norm; negative where they do not",
    "mu_hold": "least friction at which the contacts can balance the default load",
    "mu_wedge": "least friction at which contact forces can balance each other without a load",
}
"""What each is, in words."""

_NONE = "null where no friction is known to do it"


@dataclass(frozen=True, slots=True)
class StoredStatics:
    """The numbers of a state under the default load (forces, section 3); a friction is None where none is known."""

    support_margin: float
    mu_hold: float | None
    mu_wedge: float | None


class StoredStaticsDocument(TypedDict):
    """The statics of a state under a push of 1 N along -z through the bolt's origin."""

    support_margin: Annotated[float, Field(description=MEANINGS["support_margin"])]
    mu_hold: Annotated[float | None, Field(description=f"{MEANINGS['mu_hold']}; {_NONE}")]
    mu_wedge: Annotated[float | None, Field(description=f"{MEANINGS['mu_wedge']}; {_NONE}")]


class LibraryStateDocument(StateDocument):
    """A contact state of a library, with its statics; null where a contact has no certain normal."""

    statics: StoredStaticsDocument | None


NAMES = tuple(field.name for field in fields(StoredStatics))
"""In the order in which they are stored."""

_numbers_of = attrgetter(*NAMES)


def cells(statics: StoredStatics | None) -> tuple[float | None, ...]:
    """The cells of the columns; all None where a contact has no certain normal."""
    numbers: tuple[float | None, ...] = (None,) * len(NAMES) if statics is None else _numbers_of(statics)
    return numbers


def from_cells(support_margin: float | None, mu_hold: float | None, mu_wedge: float | None) -> StoredStatics | None:
    """The reverse of :func:`cells`."""
    return None if support_margin is None else StoredStatics(support_margin, mu_hold, mu_wedge)


def library_state_document(
    state: ContactState, statics: StoredStatics | None, length_factor: float = 1.0
) -> LibraryStateDocument:
    """The document of a library's state, every length multiplied by ``length_factor``."""
    numbers: StoredStaticsDocument | None = None
    if statics is not None:
        numbers = {"support_margin": statics.support_margin, "mu_hold": statics.mu_hold, "mu_wedge": statics.mu_wedge}
    return {**state_document(state, length_factor), "statics": numbers}
