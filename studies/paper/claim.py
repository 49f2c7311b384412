"""What the study says of one statement of the paper, the tolerances behind the paper's words, and how findings
become a verdict.

Lengths in inches, angles in degrees. Each tolerance is chosen for what the word means, once, for all statements.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """What the measurement says of the statement."""

    AGREES = "agrees"
    DISAGREES = "disagrees"
    UNDECIDED = "cannot be decided"


@dataclass(frozen=True)
class Statement:
    """A statement of the paper, where it stands there, and how it is put to the test.

    ``reference`` is a section or figure, ``text`` the statement in short, ``test`` what is measured and the rule by
    which it is decided.
    """

    reference: str
    text: str
    test: str


@dataclass(frozen=True)
class Outcome:
    """What was measured, the verdict that follows by the statement's rule, and what to know about it.

    ``holds_by_order``: whether the statement holds as declared, and with the bolt turned before it is tilted, where
    both were put to the test.
    """

    measurement: str
    verdict: Verdict
    reason: str = ""
    holds_by_order: tuple[bool, bool] | None = None


@dataclass(frozen=True)
class Claim:
    """A statement of the paper beside its outcome: a row of the table; see :class:`Statement` and :class:`Outcome`."""

    reference: str
    statement: str
    test: str
    measurement: str
    verdict: Verdict
    reason: str
    holds_by_order: tuple[bool, bool] | None


def claim(statement: Statement, outcome: Outcome) -> Claim:
    """The row of a statement and its outcome."""
    return Claim(
        statement.reference,
        statement.text,
        statement.test,
        outcome.measurement,
        outcome.verdict,
        outcome.reason,
        outcome.holds_by_order,
    )


ON_SURFACE = 1e-9
"""A contact within this of the nut's plane is at its surface; what embeds less does not embed."""

SAME_PLACE = 1e-6
"""Points nearer than this are one point: a microinch, the paper's finest step."""

MAJORITY = 0.5
"""More than this share is a majority."""

MIRRORED_SHARE = 0.9
"""From this share on, one turn is the mirror image of another."""

SHIFT = 2.0
"""The bolt shifts down where it falls, in a step, by more than this times what the thread's own lead gives in it."""

NARROW = 30.0
"""Within this of the steepest step a phase belongs to its neighbourhood."""

NEAR_IN_PHASE = 15.0
"""A steepest fall that begins within this of phase 0 happens when the threads are in phase."""

SEVERAL_DEGREES = 10.0
"""At most this is several degrees of phase."""

ABOUT_SIXTY = 66.0
"""At most this is no more than about 60 deg."""

QUARTER_TURN = (75.0, 105.0)
"""What is approximately 90 deg."""

CONSTANT_RATE = 0.01
"""Rates that differ by less than this share are one rate."""

NONLINEAR = 0.1
"""What differs from proportional by more than this share is not linear."""

SIGNIFICANT_NORMAL = 10.0
"""A normal that turns by more than this varies significantly."""

NEAR_SURFACE = 0.005
"""A contact no deeper than this, a tenth of the thread pitch, is near the surface."""

A_FEW_MILLIONTHS = 10e-6
"""At most this is a few millionths of an inch."""

WITHIN_A_FACTOR = 2.0
"""A number that depends on meshes that are not given is met within this factor."""


@dataclass(frozen=True)
class Finding:
    """What was measured in one reading of the paper, and whether the statement holds in it."""

    measurement: str
    holds: bool


@dataclass(frozen=True)
class Read:
    """A finding and the reading of the paper that it belongs to: ``if``, continued by ``reading``."""

    reading: str
    finding: Finding


def decided(holds: bool) -> Verdict:
    """The verdict where nothing is left open."""
    return Verdict.AGREES if holds else Verdict.DISAGREES


def unanimous(measurement: str, holds: Sequence[bool], otherwise: str) -> Outcome:
    """The outcome where several meanings of a statement are equally good: decided if they are of one mind.

    ``otherwise`` says what would have to be known.
    """
    if len(set(holds)) == 1:
        return Outcome(measurement, decided(holds[0]))
    return Outcome(measurement, Verdict.UNDECIDED, otherwise)


def settled(declared: Finding, others: Sequence[Read], note: str = "") -> Outcome:
    """The outcome over all readings, with the declared reading's measurement.

    The statement agrees if it holds as declared, disagrees if it holds in no reading; else what is unstated decides.
    The reason names the readings that differ from the declared one, and what those measure in which it holds.
    """
    differing = [other for other in others if other.finding.holds != declared.holds]
    if declared.holds:
        verdict = Verdict.AGREES
        stated = [other.reading for other in differing]
    else:
        verdict = Verdict.UNDECIDED if differing else Verdict.DISAGREES
        stated = [f"{other.reading} ({other.finding.measurement})" for other in differing]
    exceptions = [f"{'not so' if declared.holds else 'holds'} if {', or if '.join(stated)}"] if stated else []
    return Outcome(declared.measurement, verdict, "; ".join([*exceptions, *([note] if note else [])]))
