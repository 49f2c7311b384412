"""A hard place under perturbation: answers held against laws, their centre, class margins and brute force.

A perturbed answer follows from its centre's by steady steps, and across events that are each looked at.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from studies.methods import Answer, Case, Method, between, moved, same_input
from studies.stability.change import Answered, allowed, at_scale_one, change_between, has_jumped, is_steady
from studies.stability.judge import Event, Fault, Verdict, explanation, missed_first, missed_later, wrong_embedment
from studies.stability.laws import broken_laws
from studies.stability.tally import Tally
from studies.stability.trials import Kind, Trial
from threadstate.state.model import ContactState

MOST_EVENTS = 6
"""More events than this between two neighbours are not followed."""

MOST_MET = 6
"""More events than this about one centre are not looked at; what is behind them is judged by itself."""
STEEPER = (1.0, 1e2, 1e4, 1e6)
"""How many times steeper than is usual an answer may be where no event is found otherwise."""

Route = tuple[Verdict, ...]
"""What lies between a centre and an answer, nearest first; empty where nothing does."""


@dataclass(slots=True)
class Surroundings:
    """A centre and the sides of the events around it that are known, each with the route that leads there.

    The centre is a side itself once an answer was found to be steep about it, no event being in between. ``met`` holds
    every event that was looked at, with the two answers on its sides.
    """

    method: Method
    centre: Answered
    sides: list[tuple[Answered, Route]] = field(default_factory=list)
    met: list[tuple[Verdict, Answered, Answered]] = field(default_factory=list)

    def route_to(self, answered: Answered, *, divisible: bool) -> Route | None:
        """What lies between the centre and an answer; None if more than can be followed.

        ``divisible``: between the two cases lie others. If not they are taken as neighbours at once.
        """
        if is_steady(self.centre, answered):
            return ()
        for factor in STEEPER[:-1]:
            for side, route in self.sides:
                if is_steady(side, answered, factor):
                    return route
        if len(self.met) >= MOST_MET:
            return None
        for factor in STEEPER:
            found = self._walk(answered, factor, divisible=divisible)
            if found is not None:
                if found == (Event.STEEP,):
                    self.sides.append((self.centre, found))
                return found
        return None

    def _walk(self, answered: Answered, factor: float, *, divisible: bool) -> Route | None:
        """The events on the way, with slopes up to so many times the usual; None where they are steeper yet."""
        here = self.centre
        route: Route = () if factor == 1.0 else (Event.STEEP,)
        for _ in range(MOST_EVENTS):
            if is_steady(here, answered, factor):
                return route
            near, far = self._halved(here, answered, factor) if divisible else (here, answered)
            if near is far:
                here = far
                continue
            if not has_jumped(near, far):
                return None
            verdict = self._verdict(near, far)
            route = (*route, verdict)
            self.sides.append((far, route))
            if far is answered:
                return route
            here = far
        return None

    def _verdict(self, near: Answered, far: Answered) -> Verdict:
        """Why two neighbours differ; the same two are looked at once."""
        for verdict, one, other in self.met:
            if one.case == near.case and other.case == far.case:
                return verdict
        verdict = explanation(near, far)
        self.met.append((verdict, near, far))
        return verdict

    def _halved(self, near: Answered, far: Answered, factor: float) -> tuple[Answered, Answered]:
        """The first two neighbours between which the answer is not steady; as near as doubles or refusals let them.

        Twice the same where two steady steps lead on that are too much for one.
        """
        while True:
            case = between(near.case, far.case)
            if same_input(case, near.case) or same_input(case, far.case):
                return near, far
            state = self.method.answers([case])[0]
            if not isinstance(state, ContactState):
                return near, far
            middle = Answered(case, state)
            if not is_steady(near, middle, factor):
                far = middle
            elif not is_steady(middle, far, factor):
                near = middle
            else:
                return far, far


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
