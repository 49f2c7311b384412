"""Changes of contacts as documents."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.answer.documents import ContactChangeDocument, SideDocument
from threadstate.archive.stored import StoredContactChange, stored_changes
from threadstate.history.differences import contact_changes
from threadstate.history.labels import ContactLabels
from threadstate.network.changes import ContactDifference
from threadstate.state.model import ContactState
from threadstate.state.model import Vector as StateVector


def change_documents(
    changes: Sequence[StoredContactChange], factor: float, *, reverse: bool = False
) -> list[ContactChangeDocument]:
    """The documents of changes, lengths multiplied by ``factor``; with ``reverse`` the other way round."""
    return [_document(change, factor, reverse=reverse) for change in changes]


def changes_between(before: ContactState, after: ContactState, factor: float) -> list[ContactChangeDocument]:
    """The documents of how the contacts of two states differ."""
    return change_documents(stored_changes(contact_changes(before, after), before, after), factor)


def _document(change: StoredContactChange, factor: float, *, reverse: bool) -> ContactChangeDocument:
    sides = ((change.before, change.normal_before), (change.after, change.normal_after))
    before, after = reversed(sides) if reverse else sides
    difference = ContactDifference(change.stage, change.place, before[0], after[0])
    return ContactChangeDocument(
        stage=change.stage,
        place=change.place,
        kinds=list(difference.kinds),
        before=_side(*before),
        after=_side(*after),
        moved=None if change.moved is None else change.moved * factor,
    )


def _side(labels: ContactLabels | None, normal: StateVector | None) -> SideDocument | None:
    if labels is None or normal is None:
        return None
    return SideDocument(
        stage=labels.stage,
        bolt_region=labels.bolt_region,
        nut_region=labels.nut_region,
        features=labels.features,
        normal=normal,
    )
