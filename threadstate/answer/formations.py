"""Formations and their labels as documents."""

from __future__ import annotations

from threadstate.answer.documents import FormationDocument, LabelsDocument
from threadstate.history.labels import ContactLabels
from threadstate.network.formation import Formation


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
