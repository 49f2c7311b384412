"""Proportions of samples, with Wilson intervals."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from statistics import NormalDist

from threadstate.chances.model import Record
from threadstate.errors import InvalidValueError

CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """An interval of probabilities."""

    low: float
    high: float


def wilson(count: int, of: int) -> Interval:
    """Wilson's interval of 95 % for ``count`` of ``of`` independent samples (Wilson 1927).

    It is 0 to 1 where there are none.

    Raises:
        InvalidValueError: there are less than 0 or more than all.
    """
    if not 0 <= count <= of:
        raise InvalidValueError("count", count, f"0 to {of}")
    if of == 0:
        return Interval(0.0, 1.0)
    z = NormalDist().inv_cdf(0.5 + 0.5 * CONFIDENCE)
    share = count / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    # At the ends both are equal but for round-off.
    low = 0.0 if count == 0 else middle - half
    high = 1.0 if count == of else middle + half
    return Interval(low, high)


@dataclass(frozen=True, slots=True)
class Proportion:
    """How many of some samples have a property."""

    count: int
    of: int

    @property
    def share(self) -> float:
        """The part of them; 0 where there are none."""
        return self.count / self.of if self.of else 0.0

    @property
    def interval(self) -> Interval:
        """Wilson's interval."""
        return wilson(self.count, self.of)


@dataclass(frozen=True, slots=True)
class Chance:
    """How many of some paths engage; undecided ones might."""

    engaged: int
    undecided: int
    of: int

    @property
    def share(self) -> float | None:
        """The part of the decided ones that engages; None where none is decided."""
        decided = self.of - self.undecided
        return self.engaged / decided if decided else None

    @property
    def bounds(self) -> Interval:
        """The part of all if all undecided ones fail, and if they all engage; 0 and 1 where there are none."""
        if self.of == 0:
            return Interval(0.0, 1.0)
        return Interval(self.engaged / self.of, (self.engaged + self.undecided) / self.of)

    @property
    def interval(self) -> Interval:
        """From the lower end of Wilson's interval of the one bound to the upper end of that of the other."""
        return Interval(wilson(self.engaged, self.of).low, wilson(self.engaged + self.undecided, self.of).high)


def chance_of(records: Iterable[Record]) -> Chance:
    """The chance that such paths engage."""
    listed = list(records)
    return Chance(
        sum(record.engages for record in listed),
        sum(not record.is_decided for record in listed),
        len(listed),
    )
