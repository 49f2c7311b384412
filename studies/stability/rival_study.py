"""A slower method at a hard place: fewer trials, each compared with the exact answers about its case, and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from studies.methods import Answer, Case, Method, Refusal
from studies.stability.agreement import Outcome, contact_slack, flips_within_margins, outcome, same_contacts, truths
from studies.stability.change import SolvedCase, change_between
from studies.stability.tally import described
from studies.stability.trials import Kind, Trial
from threadstate.state.model import ContactState


@dataclass(frozen=True, slots=True)
class Wrong:
    """A silently wrong answer: what is wrong, and the case in words that reproduce it."""

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
    def case_count(self) -> int:
        """The number of cases."""
        return self.outcomes.total()

    def add(self, other: RivalTally) -> None:
        """Add another one's counts and extremes to this one."""
        self.outcomes.update(other.outcomes)
        self.reasons.update(other.reasons)
        self.wrong += other.wrong
        for decade, (height, turn, point) in other.largest.items():
            self.record_change(decade, height, turn, point)
        self.flips_within += other.flips_within
        self.flips_at_events += other.flips_at_events
        self.flips_beyond += other.flips_beyond

    def record_change(self, decade: int, height: float, turn: float, point: float) -> None:
        """Record the largest changes of a decade."""
        a, b, c = self.largest.get(decade, (0.0, 0.0, 0.0))
        self.largest[decade] = max(a, height), max(b, turn), max(c, point)


DIMENSION_DECADES = (-12, -6, -3)
"""A changed dimension costs new meshes."""


@dataclass(frozen=True)
class RivalChunk:
    """A centre of one place with its trials, and the method that solves them; ``place`` is its name."""

    method: Method
    place: str
    centre: Case
    trials: tuple[Trial, ...]


def thinned(trials: Sequence[Trial], most: int) -> tuple[Trial, ...]:
    """The first trial of each kind and decade, all of those without a decade; at most so many, evenly chosen."""
    chosen: list[Trial] = []
    seen: set[tuple[Kind, int]] = set()
    for trial in trials:
        if trial.kind is Kind.DIMENSIONS and trial.decade not in DIMENSION_DECADES:
            continue
        if trial.decade is not None:
            if (trial.kind, trial.decade) in seen:
                continue
            seen.add((trial.kind, trial.decade))
        chosen.append(trial)
    if len(chosen) <= most:
        return tuple(chosen)
    return tuple(chosen[i * len(chosen) // most] for i in range(most))


def study_rival(exact: Method, chunk: RivalChunk) -> RivalTally:
    """The tally of the method about this centre."""
    tally = RivalTally()
    method = chunk.method
    (given,) = method.answers([chunk.centre])
    at_centre = _classify(exact, method, chunk.centre, given, tally)
    centre = SolvedCase(chunk.centre, given) if isinstance(given, ContactState) else None
    for trial, answer in zip(chunk.trials, method.answers([trial.case for trial in chunk.trials]), strict=True):
        found = _classify(exact, method, trial.case, answer, tally)
        if centre is None or not isinstance(answer, ContactState) or trial.decade is None:
            continue
        if found is Outcome.RIGHT and at_centre is Outcome.RIGHT:
            _compare(method, centre, SolvedCase(trial.case, answer), trial.decade, tally)
    return tally


def _classify(exact: Method, method: Method, case: Case, answer: Answer, tally: RivalTally) -> Outcome:
    error = method.declared_error(case.pair)
    found = outcome(case, answer, truths(exact, case, error), error)
    tally.outcomes[found] += 1
    if isinstance(answer, Refusal):
        tally.reasons[answer.reason] += 1
    if found.is_wrong:
        tally.wrong.append(Wrong(found, described(case)))
    return found


def _compare(method: Method, centre: SolvedCase, other: SolvedCase, decade: int, tally: RivalTally) -> None:
    error = method.declared_error(centre.case.pair)
    same = same_contacts(centre, other, error)
    change = change_between(centre, other) if same else None
    if change is not None:
        tally.record_change(decade, change.height, change.turn, change.point)
    if centre.state.state_class is other.state.state_class:
        return
    if not same:
        tally.flips_at_events += 1
    elif flips_within_margins(centre, other, contact_slack(centre.case, error)):
        tally.flips_within += 1
    else:
        tally.flips_beyond += 1
