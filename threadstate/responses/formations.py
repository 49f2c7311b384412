"""Formations and changes of contacts as response models."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.history.labels import ContactLabels
from threadstate.network.changes import ContactDifference
from threadstate.network.formation import Formation
from threadstate.responses.documents import ContactChangeDocument, FormationDocument, LabelsDocument, SideDocument
from threadstate.state.model import Vector as StateVector
from threadstate.stored_histories.model import StoredContactChange


def labels_document(labels: ContactLabels) -> LabelsDocument:
    """The document of a contact's labels."""
    return LabelsDocument(
        stage=labels.stage, bolt_region=labels.bolt_region, nut_region=labels.nut_region, features=labels.features
    )


def formation_document(formation: Formation) -> FormationDocument:
    """The document of a formation."""
    return FormationDocument(
        key=formation.key,
        state_class=formation.state_class,
        contacts=[labels_document(contact) for contact in formation.contacts],
        text=formation.text,
    )


def change_documents(changes: Sequence[StoredContactChange], factor: float) -> list[ContactChangeDocument]:
    """The documents of changes, lengths multiplied by ``factor``."""
    return [_change_document(change, factor) for change in changes]


def _change_document(change: StoredContactChange, factor: float) -> ContactChangeDocument:
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
