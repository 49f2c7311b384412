"""Whether an answer agrees with an exact one to a case that is within the method's declared error."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from enum import StrEnum
from functools import lru_cache

from studies.methods import Answer, Case, Method, with_dimensions
from studies.stability.change import STEEPNESS, SolvedCase, leading_contacts
from threadstate.state.model import Contact, ContactState, FeaturePair
from threadstate.thread.pair import Pair

ONE_CONTACT_PITCHES = 0.1
"""Contacts, or turns times the bolt's reach, that are farther apart are never one."""


class Outcome(StrEnum):
    """The classification of an answer; from ``HEIGHT`` on it is wrong, at the first wrong stage."""

    RIGHT = "right"
    REFUSED = "refused"
    NO_TRUTH = "no truth"
    HEIGHT = "wrong height"
    FIRST = "another first contact"
    SECOND = "another second contact"
    THIRD = "another third contact"
    CLASS = "another class"

    @property
    def is_wrong(self) -> bool:
        """Whether the answer is wrong."""
        return self not in (Outcome.RIGHT, Outcome.REFUSED, Outcome.NO_TRUTH)


_AGREEING_FARTHER = (Outcome.HEIGHT, Outcome.FIRST, Outcome.SECOND, Outcome.THIRD, Outcome.CLASS, Outcome.RIGHT)


def about(case: Case, error: float) -> list[Case]:
    """The case, poses about it by which no point of the bolt moves much farther than ``error``, and bolts off by it.

    The last two are the case's own pose with the bolt's surface nearer to the nut's by that much, and farther.
    """
    size = math.degrees(error / case.reach)
    corners = itertools.product((-1.0, 1.0), repeat=3)
    axes = [tuple(sign if i == j else 0.0 for j in range(3)) for i in range(3) for sign in (-1.0, 1.0)]
    ways = [(0.0, 0.0, 0.0), *axes, *corners]
    poses = [
        replace(case, pose_deg=(roll + size * a, pitch + size * b, phase + size * c))
        for roll, pitch, phase in (case.pose_deg,)
        for a, b, c in ways
    ]
    return [*poses, *(replace(case, pair=_grown(case.pair, off)) for off in (error, -error))]


@lru_cache(maxsize=64)
def _grown(pair: Pair, off: float) -> Pair:
    """The pair with every radius of the bolt larger by ``off``."""
    return with_dimensions(pair, (2.0 * off, 2.0 * off, 2.0 * off, 0.0, 0.0, 0.0, 0.0))


def truths(exact: Method, case: Case, error: float) -> list[SolvedCase]:
    """The exact answers about a case, its own first; refused ones are left out."""
    cases = about(case, error)
    answers = exact.answers(cases)
    return [
        SolvedCase(one, answer) for one, answer in zip(cases, answers, strict=True) if isinstance(answer, ContactState)
    ]


def outcome(case: Case, answer: Answer, known: Sequence[SolvedCase], error: float) -> Outcome:
    """The answer against the exact ones known about its case; if it agrees with none, the best match's outcome."""
    if not isinstance(answer, ContactState):
        return Outcome.REFUSED
    if not known:
        return Outcome.NO_TRUTH
    given = SolvedCase(case, answer)
    return max((difference(given, truth, error) for truth in known), key=_AGREEING_FARTHER.index)


def difference(one: SolvedCase, other: SolvedCase, error: float) -> Outcome:
    """The first stage in which two answers differ by more than an error of the surfaces can make; else RIGHT."""
    a, b = one.state, other.state
    if abs(a.poses[0].translation[2] - b.poses[0].translation[2]) > error:
        return Outcome.HEIGHT
    slack = contact_slack(one.case, error)
    turns = ((None, None), (a.lambda_deg, b.lambda_deg), (a.mu_deg, b.mu_deg))
    for stage, (turn, turn_too) in enumerate(turns, start=1):
        far = math.inf if (turn is None) != (turn_too is None) else math.radians(abs((turn or 0.0) - (turn_too or 0.0)))
        if far * one.case.reach > slack or not _stages_agree(_of_stage(a, stage), _of_stage(b, stage), slack):
            return (Outcome.FIRST, Outcome.SECOND, Outcome.THIRD)[stage - 1]
    return Outcome.RIGHT if a.state_class is b.state_class else Outcome.CLASS


def contact_slack(case: Case, error: float) -> float:
    """How far an error of the surfaces may move a contact: the more, the smaller the tilt; in the pair's unit."""
    largest = ONE_CONTACT_PITCHES * case.pair.thread_pitch
    return largest if case.tilt == 0.0 else min(largest, STEEPNESS * error / case.tilt)


def _of_stage(state: ContactState, stage: int) -> list[Contact]:
    return [contact for contact in state.contacts if contact.stage == stage]


def _stages_agree(these: list[Contact], those: list[Contact], slack: float) -> bool:
    """Whether a stage ends alike: in a patch, in nothing, or in a contact that both have."""
    kinds = [{contact.features is FeaturePair.FLUSH for contact in contacts} for contacts in (these, those)]
    if kinds[0] != kinds[1]:
        return False
    if kinds[0] != {False}:
        return True
    return any(math.dist(one.point, other.point) <= slack for one in these for other in those)


def flips_within_margins(before: SolvedCase, after: SolvedCase, slack: float) -> bool:
    """Whether a class that flips has a margin, on either side, that is no larger than ``slack``."""
    margins = (
        margin
        for state in (before.state, after.state)
        for margin in (state.drop_margin, state.embedment_margin, state.pivot_margin)
        if margin is not None
    )
    return any(abs(margin) <= slack for margin in margins)


def same_contacts(before: SolvedCase, after: SolvedCase, error: float) -> bool:
    """Whether both states come to the same contacts."""
    held = leading_contacts(before.state).keys() == leading_contacts(after.state).keys()
    return held and difference(before, after, error) in (Outcome.RIGHT, Outcome.CLASS)
