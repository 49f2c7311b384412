"""A slower method at a hard place: fewer trials, each held against the exact answers about its case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studies.methods.case import Case
from studies.methods.method import Answer, Method, Refusal
from studies.stability.agreement import Outcome, contact_slack, flips_within_margins, outcome, same_contacts, truths
from studies.stability.change import Answered, change_between
from studies.stability.rival_tally import RivalTally, Wrong
from studies.stability.tally import described
from studies.stability.trials import Kind, Trial
from threadstate.state.model import ContactState

DIMENSION_DECADES = (-12, -6, -3)
"""A changed dimension costs new meshes."""


@dataclass(frozen=True)
class RivalChunk:
    """A centre of one place with its trials, and the method that is asked; ``place`` is its name."""

    method: Method
    place: str
    centre: Case
    trials: tuple[Trial, ...]


def thinned(trials: Sequence[Trial], most: int) -> tuple[Trial, ...]:
    """The first trial of each kind and decade, all of those without a decade; at most so many, evenly chosen."""
    kept: list[Trial] = []
    seen: set[tuple[Kind, int]] = set()
    for trial in trials:
        if trial.kind is Kind.DIMENSIONS and trial.decade not in DIMENSION_DECADES:
            continue
        if trial.decade is not None:
            if (trial.kind, trial.decade) in seen:
                continue
            seen.add((trial.kind, trial.decade))
        kept.append(trial)
    if len(kept) <= most:
        return tuple(kept)
    return tuple(kept[i * len(kept) // most] for i in range(most))


def study_rival(exact: Method, chunk: RivalChunk) -> RivalTally:
    """What the method does about this centre."""
    tally = RivalTally()
    method = chunk.method
    (given,) = method.answers([chunk.centre])
    at_centre = _judge(exact, method, chunk.centre, given, tally)
    centre = Answered(chunk.centre, given) if isinstance(given, ContactState) else None
    for trial, answer in zip(chunk.trials, method.answers([trial.case for trial in chunk.trials]), strict=True):
        found = _judge(exact, method, trial.case, answer, tally)
        if centre is None or not isinstance(answer, ContactState) or trial.decade is None:
            continue
        if found is Outcome.RIGHT and at_centre is Outcome.RIGHT:
            _compare(method, centre, Answered(trial.case, answer), trial.decade, tally)
    return tally


def _judge(exact: Method, method: Method, case: Case, answer: Answer, tally: RivalTally) -> Outcome:
    error = method.declared_error(case.pair)
    found = outcome(case, answer, truths(exact, case, error), error)
    tally.outcomes[found] += 1
    if isinstance(answer, Refusal):
        tally.reasons[answer.reason] += 1
    if found.is_wrong:
        tally.wrong.append(Wrong(found, described(case)))
    return found


def _compare(method: Method, centre: Answered, other: Answered, decade: int, tally: RivalTally) -> None:
    error = method.declared_error(centre.case.pair)
    same = same_contacts(centre, other, error)
    change = change_between(centre, other) if same else None
    if change is not None:
        tally.see_change(decade, change.height, change.turn, change.point)
    if centre.state.state_class is other.state.state_class:
        return
    if not same:
        tally.flips_at_events += 1
    elif flips_within_margins(centre, other, contact_slack(centre.case, error)):
        tally.flips_within += 1
    else:
        tally.flips_beyond += 1
