"""How a perturbed answer follows from its centre's: by steady steps, and across events that are each looked at."""

from __future__ import annotations

from dataclasses import dataclass, field

from studies.methods.case import between, same_input
from studies.methods.method import Method
from studies.stability.change import Answered, has_jumped, is_steady
from studies.stability.judge import Event, Verdict, explanation
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
