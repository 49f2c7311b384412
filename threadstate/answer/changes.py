"""Changes of contacts as documents."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.answer.documents import ContactChangeDocument, SideDocument
from threadstate.archive.stored import StoredContactChange
from threadstate.history.labels import ContactLabels
from threadstate.network.changes import ContactDifference
from threadstate.state.model import Vector as StateVector


def change_documents(changes: Sequence[StoredContactChange], factor: float) -> list[ContactChangeDocument]:
    """The documents of changes, lengths multiplied by ``factor``."""
    return [_document(change, factor) for change in changes]


def _document(change: StoredContactChange, factor: float) -> ContactChangeDocument:
    difference = ContactDifference(change.stage, change.place, change.before, change.after)
    return ContactChangeDocument(
        stage=change.stage,
        place=change.place,
        kinds=list(difference.kinds),
        before=_side(change.before, change.normal_before),
        after=_side(change.after, change.normal_after),
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
