"""How two formations differ: the class, and contact by contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, lru_cache
from itertools import zip_longest

from threadstate.history.labels import ContactLabels
from threadstate.network.formation import Formation, class_text, contact_text, region_text
from threadstate.state.model import StateClass

STAGES = (1, 2, 3)

CACHED = 2**15
"""Size of the cache of differences: many transitions are between the same two formations."""


class ChangeKind(StrEnum):
    """What changes from one formation to another."""

    CLASS = "class"
    GAINED = "gained"
    LOST = "lost"
    BOLT_REGION = "bolt_region"
    NUT_REGION = "nut_region"
    FEATURES = "features"


@dataclass(frozen=True, slots=True)
class ContactDifference:
    """How one contact differs: the ``place``-th (from 0) of its stage, None on a side without it."""

    stage: int
    place: int
    before: ContactLabels | None
    after: ContactLabels | None

    @property
    def kinds(self) -> tuple[ChangeKind, ...]:
        """What changes, in the order of :class:`ChangeKind`."""
        if self.before is None:
            return (ChangeKind.GAINED,)
        if self.after is None:
            return (ChangeKind.LOST,)
        differ = (
            (ChangeKind.BOLT_REGION, self.before.bolt_region != self.after.bolt_region),
            (ChangeKind.NUT_REGION, self.before.nut_region != self.after.nut_region),
            (ChangeKind.FEATURES, self.before.features != self.after.features),
        )
        return tuple(kind for kind, differs in differ if differs)

    @property
    def text(self) -> str:
        """The difference in words; contacts are numbered by stage and place, from 1."""
        return f"contact {self.stage}.{self.place + 1} {', '.join(_words(self.before, self.after))}"


@dataclass(frozen=True)
class FormationDifference:
    """How a formation differs from another one: its class, and the contacts that do, by stage and place."""

    class_before: StateClass | None
    class_after: StateClass | None
    contacts: tuple[ContactDifference, ...]

    @cached_property
    def kinds(self) -> frozenset[ChangeKind]:
        """All that changes."""
        kinds = {kind for contact in self.contacts for kind in contact.kinds}
        return frozenset(kinds | {ChangeKind.CLASS} if self.class_before != self.class_after else kinds)

    @cached_property
    def text(self) -> str:
        """The difference in words; empty if there is none."""
        texts = [contact.text for contact in self.contacts]
        if self.class_before != self.class_after:
            texts.insert(0, f"{class_text(self.class_before)} to {class_text(self.class_after)}")
        return "; ".join(texts)


@lru_cache(maxsize=CACHED)
def difference(before: Formation, after: Formation) -> FormationDifference:
    """How ``after`` differs from ``before``.

    Contacts are compared place by place within their stage. The contacts of an undecided formation are unknown
    and not compared.
    """
    undecided = before.state_class is None or after.state_class is None
    contacts = () if undecided else tuple(_contacts(before.contacts, after.contacts))
    return FormationDifference(before.state_class, after.state_class, contacts)


def _contacts(before: tuple[ContactLabels, ...], after: tuple[ContactLabels, ...]) -> Iterator[ContactDifference]:
    for stage in STAGES:
        pairs = zip_longest(*([c for c in contacts if c.stage == stage] for contacts in (before, after)))
        for place, (one, other) in enumerate(pairs):
            if one != other:
                yield ContactDifference(stage, place, one, other)


def _words(before: ContactLabels | None, after: ContactLabels | None) -> Iterator[str]:
    if before is not None and after is not None:
        if before.bolt_region != after.bolt_region:
            yield f"bolt {region_text(before.bolt_region)} to {region_text(after.bolt_region)}"
        if before.nut_region != after.nut_region:
            yield f"nut {region_text(before.nut_region)} to {region_text(after.nut_region)}"
        if before.features != after.features:
            yield f"{before.features} to {after.features}"
    elif after is not None:
        yield f"gained: {contact_text(after)}"
    elif before is not None:
        yield f"lost: {contact_text(before)}"
