"""What a method answered at one hard place, held against the exact answers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from studies.stability.agreement import Outcome


@dataclass(frozen=True, slots=True)
class Wrong:
    """A wrong answer given without a word: what is wrong, and the case in words that reproduce it."""

    outcome: Outcome
    case: str


@dataclass(slots=True)
class RivalTally:
    """Counts and extremes of one method at one place; two of them add up.

    ``reasons`` are those of refusals. ``largest`` has the largest change of a height, of a turn times the bolt's reach
    and of a contact point, in inches, by the decade of the input's change, between right answers with the same
    contacts. A class flips ``within`` its margins, at an ``event`` (other contacts), or ``beyond``.
    """

    outcomes: Counter[Outcome] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)
    wrong: list[Wrong] = field(default_factory=list)
    largest: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    flips_within: int = 0
    flips_at_events: int = 0
    flips_beyond: int = 0

    @property
    def asked(self) -> int:
        """How many cases."""
        return self.outcomes.total()

    def add(self, other: RivalTally) -> None:
        """Take another one's counts and extremes into this one."""
        self.outcomes.update(other.outcomes)
        self.reasons.update(other.reasons)
        self.wrong += other.wrong
        for decade, (height, turn, point) in other.largest.items():
            self.see_change(decade, height, turn, point)
        self.flips_within += other.flips_within
        self.flips_at_events += other.flips_at_events
        self.flips_beyond += other.flips_beyond

    def see_change(self, decade: int, height: float, turn: float, point: float) -> None:
        """Keep the largest changes of a decade."""
        a, b, c = self.largest.get(decade, (0.0, 0.0, 0.0))
        self.largest[decade] = max(a, height), max(b, turn), max(c, point)
