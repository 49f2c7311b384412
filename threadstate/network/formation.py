"""Contact formations: what touches what, and how the state is classified; the nodes of the network."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache, cached_property

from threadstate.history.labels import ContactLabels, Labels
from threadstate.state.model import StateClass
from threadstate.thread.regions import Region

KEY_DIGITS = 10

_ENDS = {"pos": "positive", "neg": "negative"}
_CLASS_TEXTS = {
    StateClass.UNSTABLE_TWO_POINT: "unstable two-point",
    StateClass.QUASI_STABLE_TWO_POINT: "quasi-stable two-point",
    StateClass.STABLE_THREE_POINT: "stable three-point",
    None: "undecided",
}


@dataclass(frozen=True)
class Formation:
    """A class and the labels of the contacts, in the state's order.

    ``state_class`` is None for poses that the solver does not decide; those have no contacts.
    """

    state_class: StateClass | None
    contacts: tuple[ContactLabels, ...]

    @cached_property
    def canonical(self) -> str:
        """The formation in names alone: equal formations, and no others, share it, in every library."""
        names = [self.state_class.value if self.state_class else "undecided"]
        names += [f"{c.stage}:{c.bolt_region}:{c.nut_region}:{c.features}" for c in self.contacts]
        return "|".join(names)

    @cached_property
    def key(self) -> str:
        """The first ten hexadecimal digits of the SHA-256 of :attr:`canonical`."""
        return hashlib.sha256(self.canonical.encode()).hexdigest()[:KEY_DIGITS]

    @cached_property
    def text(self) -> str:
        """The formation in words: the class, then of every contact its stage, the bolt's region and the nut's."""
        contacts = "; ".join(f"{c.stage} {contact_text(c)}" for c in self.contacts)
        return f"{class_text(self.state_class)}: {contacts}" if contacts else class_text(self.state_class)

    def __hash__(self) -> int:
        return hash(self.canonical)


def formation_of(labels: Labels) -> Formation:
    """The formation of a state's labels: all of them but the flags."""
    return Formation(labels.state_class, labels.contacts)


def class_text(state_class: StateClass | None) -> str:
    """A class in words; None is undecided."""
    return _CLASS_TEXTS[state_class]


@cache
def contact_text(contact: ContactLabels) -> str:
    """A contact in words, the bolt's region first."""
    return f"{region_text(contact.bolt_region)} on {region_text(contact.nut_region)} ({contact.features})"


@cache
def region_text(region: Region) -> str:
    """A region in words, as ``positive root fillet`` for ``root_fillet_pos``."""
    *names, last = region.value.split("_")
    return " ".join([_ENDS[last], *names] if last in _ENDS else [*names, last])
