"""Where something happens to the answers along phase: found by a sweep of whole degrees, then halved to the last digit.

Each event is a place where methods may fail: a contact vanishes, appears or is replaced, a label changes, or a
class flips.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise

from oracle.state_turns import first_tangent
from studies.methods import Case, Method, between, same_input
from studies.stability.change import SolvedCase, leading_contacts, pivot_lever
from threadstate.state.model import ContactState, FeaturePair, Flag

FEATURE_WIDTH_DEG = 1e-7
"""Feature changes are approached no nearer: there the exact method takes up to 20 s for a pose, and then refuses."""
FAR_INCH = 5e-3
"""Contact points of neighbouring degrees that are farther apart are not one contact that moves."""
SAME_HEIGHT_INCH = 1e-7
SAME_TURN_DEG = 1e-5


class EventKind(StrEnum):
    """What happens; the value is the name of the hard place."""

    TIE = "ties of first contacts"
    JUMP = "first contact lost (jump)"
    LATER_TIE = "ties of later contacts"
    DOUBLE_ROOT = "later contact appears or vanishes (double root)"
    FLUSH = "flush or not (coplanar)"
    GRAZING = "grazing contact"
    REGION = "region boundaries"
    FEATURE = "feature changes"
    BALANCED = "balanced axes"
    TANGENT_X = "tangent along +-x"
    TANGENT_Y = "tangent along +-y"
    PIVOT = "pivot offset at its threshold"
    DROP = "drop equals embedment (rolling axis)"


@dataclass(frozen=True, slots=True)
class Event:
    """An event and the case just before it."""

    kind: EventKind
    case: Case


Likeness = Callable[[ContactState], bool]
"""Whether a state is like the one before the event."""


@dataclass(frozen=True, slots=True)
class _Bracket:
    """Two cases between which something happens; ``kind`` is None for a jump, whose kind follows from its ends."""

    kind: EventKind | None
    is_like: Likeness
    low: Case
    high: Case

    @property
    def width_deg(self) -> float:
        return self.high.pose_deg[2] - self.low.pose_deg[2]


def events_along(method: Method, line: list[Case]) -> list[Event]:
    """The events between neighbours of a line of cases of growing phase, in its order.

    Halving ends at the last digit, where the method refuses, and at ``FEATURE_WIDTH_DEG`` for feature changes.
    """
    states = [answer if isinstance(answer, ContactState) else None for answer in method.answers(line)]
    open_brackets: list[tuple[int, _Bracket]] = []
    for (case, state), (next_case, next_state) in pairwise(zip(line, states, strict=True)):
        if state is not None and next_state is not None:
            for kind, is_like in _differences(case, state, next_state):
                open_brackets.append((len(open_brackets), _Bracket(kind, is_like, case, next_case)))
    closed: dict[int, _Bracket] = {}
    while open_brackets:
        middles = [between(bracket.low, bracket.high) for _, bracket in open_brackets]
        answers = method.answers(middles)
        still_open = []
        for (number, bracket), middle, answer in zip(open_brackets, middles, answers, strict=True):
            at_end = same_input(middle, bracket.low) or same_input(middle, bracket.high)
            if at_end or not isinstance(answer, ContactState):
                closed[number] = bracket
                continue
            like = bracket.is_like(answer)
            nearer = replace(bracket, low=middle) if like else replace(bracket, high=middle)
            if bracket.kind is EventKind.FEATURE and nearer.width_deg < FEATURE_WIDTH_DEG:
                closed[number] = nearer
            else:
                still_open.append((number, nearer))
        open_brackets = still_open
    brackets = [closed[number] for number in sorted(closed)]
    ends = method.answers([case for bracket in brackets for case in (bracket.low, bracket.high)])
    found = []
    for bracket, before, after in zip(brackets, ends[::2], ends[1::2], strict=True):
        if isinstance(before, ContactState) and isinstance(after, ContactState):
            kind = bracket.kind or _jump_kind(SolvedCase(bracket.low, before), SolvedCase(bracket.high, after))
            found.append(Event(kind, bracket.low))
            if Flag.GRAZING in before.flags:
                found.append(Event(EventKind.GRAZING, bracket.low))
    return found


def _differences(case: Case, a: ContactState, b: ContactState) -> list[tuple[EventKind | None, Likeness]]:
    """What tells two neighbouring states apart; ``kind`` is None for a jump, whose kind follows from its ends."""
    one, other = leading_contacts(a), leading_contacts(b)
    for stage in (1, 2, 3):
        if stage == 3 and _moment_side(case, a) != _moment_side(case, b):
            return [(EventKind.BALANCED, _reads(_moment_side, case, _moment_side(case, a)))]
        if (stage in one) != (stage in other):
            return [(EventKind.FLUSH if Flag.FLUSH in (*a.flags, *b.flags) else None, _has_stage(stage, stage in one))]
        if stage in one and math.dist(one[stage].point, other[stage].point) > FAR_INCH:
            return [(None, _is_nearer(stage, one[stage].point, other[stage].point))]
    found: list[tuple[EventKind | None, Likeness]] = []
    for kind, read in _LABELS:
        label = read(case, a)
        if label != read(case, b):
            found.append((kind, _reads(read, case, label)))
    return found


def _has_stage(stage: int, present: bool) -> Likeness:
    return lambda state: (stage in leading_contacts(state)) == present


def _is_nearer(stage: int, here: tuple[float, float, float], there: tuple[float, float, float]) -> Likeness:
    def is_like(state: ContactState) -> bool:
        contact = leading_contacts(state).get(stage)
        return contact is not None and math.dist(contact.point, here) < math.dist(contact.point, there)

    return is_like


def _reads(read: Callable[[Case, ContactState], object], case: Case, label: object) -> Likeness:
    return lambda state: read(case, state) == label


def _jump_kind(before: SolvedCase, after: SolvedCase) -> EventKind:
    a, b = before.state, after.state
    if abs(a.poses[0].translation[2] - b.poses[0].translation[2]) > SAME_HEIGHT_INCH:
        return EventKind.JUMP
    one, other = leading_contacts(a), leading_contacts(b)
    if 1 in one and 1 in other and math.dist(one[1].point, other[1].point) > FAR_INCH / 10.0:
        return EventKind.TIE
    for stage, turn, turn_too in ((2, a.lambda_deg, b.lambda_deg), (3, a.mu_deg, b.mu_deg)):
        if (stage in one) != (stage in other) or turn is None or turn_too is None:
            return EventKind.DOUBLE_ROOT
        if stage in one and math.dist(one[stage].point, other[stage].point) > FAR_INCH / 10.0:
            return EventKind.LATER_TIE if abs(turn - turn_too) < SAME_TURN_DEG else EventKind.DOUBLE_ROOT
    return EventKind.LATER_TIE


def _regions(_: Case, state: ContactState) -> object:
    return tuple((c.bolt_region, c.nut_region) for c in leading_contacts(state).values())


def _features(_: Case, state: ContactState) -> object:
    return tuple(c.features for c in leading_contacts(state).values())


def _moment_side(_: Case, state: ContactState) -> object:
    lever = pivot_lever(state)
    return 0.0 if lever is None else math.copysign(1.0, lever)


def _tangent_side(component: int) -> Callable[[Case, ContactState], object]:
    def read(case: Case, state: ContactState) -> object:
        if state.contacts[0].features is FeaturePair.FLUSH:
            return 0.0
        return math.copysign(1.0, float(first_tangent(case.pair, state)[component]))

    return read


def _is_positive(name: str) -> Callable[[Case, ContactState], object]:
    def read(_: Case, state: ContactState) -> object:
        margin = getattr(state, name)
        return None if margin is None else margin > 0.0

    return read


_LABELS: tuple[tuple[EventKind, Callable[[Case, ContactState], object]], ...] = (
    (EventKind.FEATURE, _features),
    (EventKind.REGION, _regions),
    (EventKind.TANGENT_X, _tangent_side(1)),
    (EventKind.TANGENT_Y, _tangent_side(0)),
    (EventKind.PIVOT, _is_positive("pivot_margin")),
    (EventKind.DROP, _is_positive("drop_margin")),
)


def phase_line(start: Case, count: int) -> list[Case]:
    """``count`` cases at every degree of phase from that of the first."""
    roll, pitch, phase = start.pose_deg
    return [replace(start, pose_deg=(roll, pitch, phase + k)) for k in range(count)]
