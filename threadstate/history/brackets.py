"""Brackets of changes along a circle of phase: two phases between which labels change, or a height jumps."""

from __future__ import annotations

from dataclasses import dataclass, replace

from threadstate.history.changes import Changes
from threadstate.history.model import CIRCLE_DEG, POINT_DEG
from threadstate.history.stretches import UNDECIDED_CODE

UNDECIDED_GAP_DEG = 0.02
"""Undecided stretches no farther apart than this are one: where the search ends early is no property of the parts."""


@dataclass(frozen=True, slots=True)
class Bracket:
    """Two phases between which something changes, the codes at them, and places in between with codes of their own."""

    low: float
    high: float
    low_code: int
    high_code: int
    through: tuple[float, ...] = ()

    @property
    def width(self) -> float:
        """How far apart the phases are, in degrees."""
        return self.high - self.low

    @property
    def decided(self) -> bool:
        """Whether there are labels on both sides."""
        return UNDECIDED_CODE not in (self.low_code, self.high_code)


def brackets_of(changes: Changes, line: int) -> list[Bracket]:
    """The brackets of a line in order, those joined that bound a point, those left out that part undecided phases."""
    on_line = changes.line == line
    columns = (changes.low, changes.high, changes.low_code, changes.high_code)
    rows = zip(*(column[on_line].tolist() for column in columns), strict=True)
    joined: list[Bracket] = []
    for bracket in (Bracket(*row) for row in rows):
        if joined and bracket.high - joined[-1].low < POINT_DEG:
            joined[-1] = joined_brackets(joined[-1], bracket)
        else:
            joined.append(bracket)
    over_start = joined[0].high + CIRCLE_DEG - joined[-1].low if joined else CIRCLE_DEG
    if len(joined) > 1 and over_start < POINT_DEG:
        first = joined.pop(0)
        later = tuple(phase + CIRCLE_DEG for phase in first.through)
        once_more = replace(first, low=first.low + CIRCLE_DEG, high=first.high + CIRCLE_DEG, through=later)
        joined[-1] = joined_brackets(joined[-1], once_more)
    remaining: list[Bracket] = []
    for bracket in joined:
        if (
            remaining
            and remaining[-1].low_code == bracket.high_code == UNDECIDED_CODE
            and bracket.low - remaining[-1].high < UNDECIDED_GAP_DEG
        ):
            remaining.pop()
        else:
            remaining.append(bracket)
    return remaining


def joined_brackets(one: Bracket, other: Bracket) -> Bracket:
    """One bracket for two, the first before the other; what holds between them belongs to it."""
    through = (*one.through, 0.5 * (one.high + other.low), *other.through)
    return Bracket(one.low, max(one.high, other.high), one.low_code, other.high_code, through)
