"""What the study says of one statement of the paper."""

from __future__ import annotations

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
