"""The audit of many boxes: what was found, by form, stage, size and class."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

from studies.certificate.audit import Outcome, audit
from studies.certificate.bounds import COMPILED, IN_MIDDLE, OVER_BOX, Kernels, claims
from studies.certificate.cases import Box, random_boxes, search_boxes

CLASSES = (
    "all outside",
    "excluded",
    "one on an edge",
    "one on the thread",
    "one on the plane",
    "peak on an edge",
    "peak on the thread",
    "peak on the plane",
    "undecided",
)
QUANTITIES = OVER_BOX + IN_MIDDLE


@dataclass(frozen=True, slots=True)
class Case:
    """A box in words, with a number."""

    size: float
    text: str


@dataclass(slots=True)
class Found:
    """What an audit found; two of them add up. ``used`` is of each quantity the most of a range that a point uses."""

    boxes: Counter[tuple[str, str]] = field(default_factory=Counter)
    outcomes: Counter[tuple[str, str]] = field(default_factory=Counter)
    used: dict[str, Case] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def add(self, other: Found) -> None:
        """Add what was found in other boxes."""
        self.boxes.update(other.boxes)
        self.outcomes.update(other.outcomes)
        self.faults += other.faults
        for name, case in other.used.items():
            if name not in self.used or case.size > self.used[name].size:
                self.used[name] = case


def in_words(one: Box) -> str:
    """A box in words that say how to make it again."""
    motion = " ".join(repr(float(number)) for number in one.search.motion)
    return (
        f"{one.search.form}, {one.search.stage}, theta {one.theta!r} +- {one.half!r}, "
        f"tau {one.start!r} to {one.end!r}, motion {motion}"
    )


def audit_boxes(boxes: list[Box], kernels: Kernels = COMPILED) -> Found:
    """Audit boxes one by one."""
    found = Found()
    for one in boxes:
        claimed = claims(one, kernels)
        audited = audit(one, claimed)
        decade = math.floor(math.log10(one.half))
        for kind, value in (
            ("form", one.search.form),
            ("stage", one.search.stage),
            ("half-width", f"1e{decade} to 1e{decade + 1} rad"),
            ("class", CLASSES[claimed.box_class]),
            ("made", "by a search" if one.visited else "at random"),
        ):
            found.boxes[kind, value] += 1
        for name, outcome in audited.open.items():
            found.outcomes[name, outcome.value] += 1
            found.faults.append(f"{name} {outcome.value}: {in_words(one)}")
        for name, size in zip(QUANTITIES, audited.used, strict=True):
            if name not in found.used or size > found.used[name].size:
                found.used[name] = Case(size, f"{one.search.form}, {one.search.stage}, half-width {one.half:.1e}")
    return found


def audit_some(number: int, count: int) -> Found:
    """Audit so many boxes, half of them at random, half from searches; the same for the same number."""
    return audit_boxes([*random_boxes(number, count - count // 2), *search_boxes(number, count // 2)])


def failures(found: Found) -> int:
    """How many claims are contradicted."""
    return sum(count for (_, outcome), count in found.outcomes.items() if outcome == Outcome.FAILS)
