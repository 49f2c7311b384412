"""A hard place under perturbation: answers checked by laws, against their centre, by class margins and by brute force.

A perturbed answer follows from its centre's by steady steps, and across events that are each explained.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from studies.methods import Answer, Case, Method, between, moved, same_input
from studies.stability.brute_force import (
    Event,
    Explanation,
    Fault,
    explanation,
    missed_first,
    missed_later,
    wrong_embedment,
)
from studies.stability.change import SolvedCase, allowed, at_scale_one, change_between, has_jumped, is_steady
from studies.stability.laws import broken_laws
from studies.stability.tally import Tally
from studies.stability.trials import Kind, Trial
from threadstate.state.model import ContactState

MAX_EVENTS_OF_ROUTE = 6
"""More events than this between two neighbours are not followed."""

MAX_EVENTS_OF_CENTRE = 6
"""More events than this about one centre are not followed; answers beyond them are checked by the brute force alone."""

MAX_SOLVED_OF_CENTRE = 200
"""So many poses are solved at most to find the events about one centre: few need a hundred, and beside edges that lie
all but in one plane each takes a tenth of a second. Answers beyond them are checked by the brute force, too."""

SLOPE_FACTORS = (1.0, 1e2, 1e4, 1e6)
"""By how much a slope may exceed the usual one where no event is found otherwise."""

Route = tuple[Explanation, ...]
"""The events between a centre and an answer, nearest first; empty where there are none."""


@dataclass(slots=True)
class Neighbourhood:
    """A centre and the known sides of the events around it, each with the route that leads there.

    The centre is a side itself once an answer was found to be steep about it, no event being in between. ``events``
    holds every event that was explained, with the two answers on its sides, ``solved`` what was solved on the way: the
    ways of several trials are halved at the same cases.
    """

    method: Method
    centre: SolvedCase
    sides: list[tuple[SolvedCase, Route]] = field(default_factory=list)
    events: list[tuple[Explanation, SolvedCase, SolvedCase]] = field(default_factory=list)
    solved: dict[Case, Answer] = field(default_factory=dict)

    def route_to(self, solved: SolvedCase, *, divisible: bool) -> Route | None:
        """What lies between the centre and an answer; None if more than can be followed.

        ``divisible``: between the two cases lie others. If not they are taken as neighbours at once.
        """
        if is_steady(self.centre, solved):
            return ()
        for factor in SLOPE_FACTORS[:-1]:
            for side, route in self.sides:
                if is_steady(side, solved, factor):
                    return route
        if len(self.events) >= MAX_EVENTS_OF_CENTRE or len(self.solved) >= MAX_SOLVED_OF_CENTRE:
            return None
        for factor in SLOPE_FACTORS:
            found = self._route(solved, factor, divisible=divisible)
            if found is not None:
                if found == (Event.STEEP,):
                    self.sides.append((self.centre, found))
                return found
        return None

    def _route(self, solved: SolvedCase, factor: float, *, divisible: bool) -> Route | None:
        """The events on the way, with slopes up to so many times the usual; None where they are steeper yet."""
        here = self.centre
        route: Route = () if factor == 1.0 else (Event.STEEP,)
        for _ in range(MAX_EVENTS_OF_ROUTE):
            if is_steady(here, solved, factor):
                return route
            near, far = self._halved(here, solved, factor) if divisible else (here, solved)
            if near is far:
                here = far
                continue
            if not has_jumped(near, far):
                return None
            explained = self._explain(near, far)
            route = (*route, explained)
            self.sides.append((far, route))
            if far is solved:
                return route
            here = far
        return None

    def _explain(self, near: SolvedCase, far: SolvedCase) -> Explanation:
        """Why two neighbours differ; cached, so that the same two are explained once."""
        for explained, one, other in self.events:
            if one.case == near.case and other.case == far.case:
                return explained
        explained = explanation(near, far)
        self.events.append((explained, near, far))
        return explained

    def _halved(self, near: SolvedCase, far: SolvedCase, factor: float) -> tuple[SolvedCase, SolvedCase]:
        """The first two neighbours between which the answer is not steady; as near as doubles or refusals let them.

        Twice the same where two steady steps lead on that are too much for one.
        """
        while True:
            case = between(near.case, far.case)
            if same_input(case, near.case) or same_input(case, far.case):
                return near, far
            if case not in self.solved:
                self.solved[case] = self.method.answers([case])[0]
            state = self.solved[case]
            if not isinstance(state, ContactState):
                return near, far
            middle = SolvedCase(case, state)
            if not is_steady(near, middle, factor):
                far = middle
            elif not is_steady(middle, far, factor):
                near = middle
            else:
                return far, far


RATIO_FROM_DECADE = -7
"""Smaller changes of the input show round-off and no slope."""
TRIALS_A_SAMPLE = 480
"""One perturbed answer in so many is checked by the brute force in any case: its height and its embedment."""
CENTRES_A_SAMPLE = 24
"""Every centre's height and embedment are checked by it, and the turns of one in so many."""
UNFOLLOWED_A_SAMPLE = 16
"""Of the answers that no route from the centre leads to: the height and embedment of each, the turns of one."""


@dataclass(frozen=True)
class Chunk:
    """A few centres of one place with their trials; ``first`` is the first one's number there."""

    place: str
    first: int
    centres: tuple[Case, ...]
    trials: tuple[Trial, ...]


def study(method: Method, chunk: Chunk) -> Tally:
    """The tally of a method about these centres."""
    tally = Tally(centres=len(chunk.centres))
    around: list[Neighbourhood | None] = []
    for case, answer in zip(chunk.centres, method.answers(chunk.centres), strict=True):
        if isinstance(answer, ContactState):
            centre = SolvedCase(case, answer)
            _check_laws(method, centre, tally)
            _compare(centre, tally, turns=(chunk.first + len(around)) % CENTRES_A_SAMPLE == 0)
            around.append(Neighbourhood(method, centre))
        else:
            tally.centres_refused += 1
            around.append(None)
    answers = method.answers([trial.case for trial in chunk.trials])
    for number, (trial, answer) in enumerate(zip(chunk.trials, answers, strict=True)):
        _try(method, trial, answer, around[trial.centre], tally)
        sampled = number % TRIALS_A_SAMPLE == TRIALS_A_SAMPLE // 2 and trial.kind is not Kind.SCALE
        if sampled and isinstance(answer, ContactState):
            _compare(SolvedCase(trial.case, answer), tally, turns=False)
    for neighbourhood in filter(None, around):
        _count_events(neighbourhood, tally)
    return tally


def _try(method: Method, trial: Trial, answer: Answer, neighbourhood: Neighbourhood | None, tally: Tally) -> None:
    tally.trials += 1
    if not isinstance(answer, ContactState):
        tally.refused += 1
        return
    solved = SolvedCase(trial.case, answer)
    _check_laws(method, solved, tally)
    if neighbourhood is None:
        tally.without_centre += 1
        return
    if trial.kind is Kind.SCALE:
        solved = at_scale_one(solved, neighbourhood.centre.case.pair)
    route = neighbourhood.route_to(solved, divisible=trial.kind in (Kind.POSE, Kind.DIMENSIONS))
    if route is None:
        tally.unfollowed += 1
        _compare(solved, tally, turns=tally.unfollowed % UNFOLLOWED_A_SAMPLE == 0)
    elif set(route) <= {Event.STEEP}:
        tally.same_contacts += 1
        _measure(trial, neighbourhood.centre, solved, tally)
    else:
        tally.other_contacts += 1
    _check_class(neighbourhood.centre, solved, route, tally)


def _check_laws(method: Method, solved: SolvedCase, tally: Tally) -> None:
    broken = broken_laws(method, solved)
    if broken:
        tally.fail(Fault.LAW, solved.case, "; ".join(broken[:3]))


def _measure(trial: Trial, centre: SolvedCase, solved: SolvedCase, tally: Tally) -> None:
    change = change_between(centre, solved)
    if change is None or trial.decade is None:
        return
    tally.record_change(trial.decade, change.height, change.turn, change.point)
    far = moved(centre.case, solved.case)
    if trial.decade >= RATIO_FROM_DECADE:
        tally.height.update(change.height / far, centre.case)
        tally.turn.update(change.turn / far, centre.case)
        tally.point.update(change.point / far, centre.case)


def _check_class(centre: SolvedCase, solved: SolvedCase, route: Route | None, tally: Tally) -> None:
    """A class that flips while its contacts stay has a margin that changes its sign and was small enough to."""
    before, after = centre.state, solved.state
    if before.state_class is after.state_class:
        return
    if route is None or set(route) - {Event.STEEP}:
        tally.flips_at_events += 1
        return
    height, rest = allowed(centre.case, solved.case)
    slack = max(height, rest)
    slack += centre.case.pair.thread_pitch * abs(
        centre.case.options.embedment_tolerance - solved.case.options.embedment_tolerance
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
        tally.fail(Fault.CLASS, solved.case, f"{before.state_class.value} to {after.state_class.value}")


def _compare(solved: SolvedCase, tally: Tally, *, turns: bool) -> None:
    """Check an answer by the brute force alone."""
    tally.compared_heights += 1
    if missed_first(solved):
        tally.fail(Fault.MISSED_FIRST, solved.case, "height of the first contact")
    if solved.state.embedment is not None:
        tally.compared_lifts += 1
        wrong = wrong_embedment(solved)
        if wrong:
            tally.fail(Fault.WRONG_EMBEDMENT, solved.case, wrong)
    if turns:
        tally.compared_turns += 1
        if missed_later(solved):
            tally.fail(Fault.MISSED_LATER, solved.case, "a turn passes a contact onset")


def _count_events(neighbourhood: Neighbourhood, tally: Tally) -> None:
    for explained, near, far in neighbourhood.events:
        if isinstance(explained, Event):
            tally.events[explained] += 1
        else:
            kinds: Sequence[str] = [one.state.contacts[-1].features.value for one in (near, far)]
            tally.fail(explained, near.case, f"beside {far.case.pose_deg}, last contacts {' and '.join(kinds)}")
