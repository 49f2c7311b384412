"""Labels: everything of a state that is not a number."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, StateClass
from threadstate.thread.regions import Region


@dataclass(frozen=True, slots=True)
class ContactLabels:
    """What touches what at one contact, and the stage of its onset."""

    stage: int
    bolt_region: Region
    nut_region: Region
    features: FeaturePair


@dataclass(frozen=True, slots=True)
class Labels:
    """The labels of a state: class, flags, and those of its contacts in the state's order.

    Of an undecided pose nothing is known: ``state_class`` is None, and there are no flags and no contacts.
    """

    state_class: StateClass | None
    flags: tuple[Flag, ...]
    contacts: tuple[ContactLabels, ...]

    @property
    def decided(self) -> bool:
        """Whether the solver is certain of the state."""
        return self.state_class is not None


UNDECIDED = Labels(None, (), ())
"""The labels of an undecided pose."""


def labels_of(state: ContactState | None) -> Labels:
    """The labels of a state; None stands for an undecided pose."""
    if state is None:
        return UNDECIDED
    return Labels(state.state_class, state.flags, tuple(contact_labels(contact) for contact in state.contacts))


def contact_labels(contact: Contact) -> ContactLabels:
    """The labels of a contact."""
    return ContactLabels(contact.stage, contact.bolt_region, contact.nut_region, contact.features)
