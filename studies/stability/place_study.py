"""A hard place under perturbation: answers held against laws, their centre, class margins and brute force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studies.methods.case import Case, moved
from studies.methods.method import Answer, Method
from studies.stability.change import Answered, allowed, at_scale_one, change_between
from studies.stability.connect import Route, Surroundings
from studies.stability.judge import Event, Fault, missed_first, missed_later, wrong_embedment
from studies.stability.laws import broken_laws
from studies.stability.tally import Tally
from studies.stability.trials import Kind, Trial
from threadstate.state.model import ContactState

RATIO_FROM_DECADE = -7
"""Smaller changes of the input show round-off and no slope."""
TRIALS_A_SAMPLE = 480
"""One perturbed answer in so many is put to the brute force whatever it is: its height and its embedment."""
CENTRES_A_SAMPLE = 24
"""Every centre's height and embedment are put to it, and the turns of one in so many."""
ALONE_A_SAMPLE = 16
"""Of the answers whose way from the centre is not followed: the height and embedment of each, the turns of one."""


@dataclass(frozen=True)
class Chunk:
    """A few centres of one place with their trials; ``first`` is the first one's number there."""

    place: str
    first: int
    centres: tuple[Case, ...]
    trials: tuple[Trial, ...]


def study(method: Method, chunk: Chunk) -> Tally:
    """What a method does about these centres."""
    tally = Tally(centres=len(chunk.centres))
    around: list[Surroundings | None] = []
    for case, answer in zip(chunk.centres, method.answers(chunk.centres), strict=True):
        if isinstance(answer, ContactState):
            centre = Answered(case, answer)
            _check_laws(method, centre, tally)
            _compare(centre, tally, turns=(chunk.first + len(around)) % CENTRES_A_SAMPLE == 0)
            around.append(Surroundings(method, centre))
        else:
            tally.centres_refused += 1
            around.append(None)
    answers = method.answers([trial.case for trial in chunk.trials])
    for number, (trial, answer) in enumerate(zip(chunk.trials, answers, strict=True)):
        _try(method, trial, answer, around[trial.centre], tally)
        sampled = number % TRIALS_A_SAMPLE == TRIALS_A_SAMPLE // 2 and trial.kind is not Kind.SCALE
        if sampled and isinstance(answer, ContactState):
            _compare(Answered(trial.case, answer), tally, turns=False)
    for surroundings in filter(None, around):
        _settle(surroundings, tally)
    return tally


def _try(method: Method, trial: Trial, answer: Answer, surroundings: Surroundings | None, tally: Tally) -> None:
    tally.trials += 1
    if not isinstance(answer, ContactState):
        tally.refused += 1
        return
    answered = Answered(trial.case, answer)
    _check_laws(method, answered, tally)
    if surroundings is None:
        tally.without_centre += 1
        return
    if trial.kind is Kind.SCALE:
        answered = at_scale_one(answered, surroundings.centre.case.pair)
    route = surroundings.route_to(answered, divisible=trial.kind in (Kind.POSE, Kind.DIMENSIONS))
    if route is None:
        tally.judged_alone += 1
        _compare(answered, tally, turns=tally.judged_alone % ALONE_A_SAMPLE == 0)
    elif set(route) <= {Event.STEEP}:
        tally.kept += 1
        _measure(trial, surroundings.centre, answered, tally)
    else:
        tally.replaced += 1
    _check_class(surroundings.centre, answered, route, tally)


def _check_laws(method: Method, answered: Answered, tally: Tally) -> None:
    broken = broken_laws(method, answered)
    if broken:
        tally.fail(Fault.LAW, answered.case, "; ".join(broken[:3]))


def _measure(trial: Trial, centre: Answered, answered: Answered, tally: Tally) -> None:
    change = change_between(centre, answered)
    if change is None or trial.decade is None:
        return
    tally.see_change(trial.decade, change.height, change.turn, change.point)
    far = moved(centre.case, answered.case)
    if trial.decade >= RATIO_FROM_DECADE:
        tally.height.look_at(change.height / far, centre.case)
        tally.turn.look_at(change.turn / far, centre.case)
        tally.point.look_at(change.point / far, centre.case)


def _check_class(centre: Answered, answered: Answered, route: Route | None, tally: Tally) -> None:
    """A class that flips while its contacts stay has a margin that changes its sign and was small enough to."""
    before, after = centre.state, answered.state
    if before.state_class is after.state_class:
        return
    if route is None or set(route) - {Event.STEEP}:
        tally.flips_at_events += 1
        return
    height, rest = allowed(centre.case, answered.case)
    slack = max(height, rest)
    slack += centre.case.pair.thread_pitch * abs(
        centre.case.options.embedment_tolerance - answered.case.options.embedment_tolerance
    )
    margins = (
        (before.drop_margin, after.drop_margin),
        (before.embedment_margin, after.embedment_margin),
        (before.pivot_margin, after.pivot_margin),
    )
    crossed = [m for m, n in margins if m is not None and n is not None and (m > 0.0) != (n > 0.0)]
    if route or any(abs(margin) <= slack for margin in crossed):
        tally.flips_by_margin += 1
    else:
        tally.fail(Fault.CLASS, answered.case, f"{before.state_class.value} to {after.state_class.value}")


def _compare(answered: Answered, tally: Tally, *, turns: bool) -> None:
    """Hold an answer against the brute force alone."""
    tally.compared_heights += 1
    if missed_first(answered):
        tally.fail(Fault.MISSED_FIRST, answered.case, "height of the first contact")
    if answered.state.embedment is not None:
        tally.compared_lifts += 1
        wrong = wrong_embedment(answered)
        if wrong:
            tally.fail(Fault.WRONG_EMBEDMENT, answered.case, wrong)
    if turns:
        tally.compared_turns += 1
        if missed_later(answered):
            tally.fail(Fault.MISSED_LATER, answered.case, "a turn goes past a birth")


def _settle(surroundings: Surroundings, tally: Tally) -> None:
    for verdict, near, far in surroundings.met:
        if isinstance(verdict, Event):
            tally.events[verdict] += 1
        else:
            kinds: Sequence[str] = [one.state.contacts[-1].features.value for one in (near, far)]
            tally.fail(verdict, near.case, f"beside {far.case.pose_deg}, last contacts {' and '.join(kinds)}")
