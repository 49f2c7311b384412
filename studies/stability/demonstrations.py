"""Each named way to fail at one pose, and what every method does there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from studies.methods import Answer, Case, Method, Refusal, scaled
from studies.stability.agreement import Outcome, outcome, truths
from studies.stability.events import EventKind
from studies.stability.places import Place
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

PLAIN = (1.0, -2.0, 10.0)
"""A pose at which nothing happens."""


@dataclass(frozen=True)
class Demonstration:
    """A way to fail, why methods do, and a case."""

    mode: str
    why: str
    case: Case


@dataclass(frozen=True)
class Reply:
    """A method's answer and its outcome."""

    outcome: Outcome
    answer: Answer


@dataclass(frozen=True)
class Shown:
    """A demonstration with the exact answer and the replies of the other methods, in their order."""

    demonstration: Demonstration
    exact: Answer
    replies: tuple[Reply, ...]


_FIXED = (
    ("tunnelling", "the first step of 0.01 in ends where the surfaces do not cross", (0.0, -4.0, 350.0)),
    ("before the jump", "the highest contact is about to vanish", (0.0, -4.0, 357.0)),
    ("after the jump", "the bolt has fallen by 0.009 in within 1 deg of phase", (0.0, -4.0, 358.0)),
    ("flush contact", "after the second turn base and surface are coplanar", (4.0, 0.0, 185.0)),
    ("coplanar from the start", "a level bolt out of phase", (0.0, 0.0, 180.0)),
    ("coplanar threads", "a level bolt in phase lies on a strip of its thread", (0.0, 0.0, 0.0)),
    ("nearly level", "contact points follow the direction of a tilt of 1e-6 deg", (6e-7, -8e-7, 120.0)),
)

_AT_EVENTS = (
    (EventKind.TIE, "two first contacts at one height"),
    (EventKind.LATER_TIE, "two later contacts at one turn"),
    (EventKind.DOUBLE_ROOT, "a contact appears where it merges with another overlap"),
    (EventKind.GRAZING, "edges that meet are nearly parallel"),
    (EventKind.FLUSH, "a contact appears at the very turn at which the bolt would lie flush"),
    (EventKind.TANGENT_X, "the second turn's axis is along x, where acos loses half of its digits"),
    (EventKind.TANGENT_Y, "the second turn's axis is along y, whose sign acos loses"),
    (EventKind.DROP, "material rolls in at the pivot axis: drop equals embedment"),
    (EventKind.BALANCED, "the origin is on the pivot axis: the third turn has no sense"),
    (EventKind.PIVOT, "the pivot offset is at the threshold of its class"),
    (EventKind.REGION, "a contact is on the boundary of two regions"),
    (EventKind.FEATURE, "a contact moves from one pair of features to another"),
)


def demonstrations(pair: Pair, places: Sequence[Place]) -> list[Demonstration]:
    """All of them: fixed poses, the first centre of the places where events were found, and other inputs."""
    found = [Demonstration(mode, why, Case(pair, pose)) for mode, why, pose in _FIXED]
    first = {place.name: place.centres[0] for place in places}
    found += [Demonstration(kind.value, why, first[kind.value]) for kind, why in _AT_EVENTS if kind.value in first]
    plain = Case(pair, PLAIN)
    roll, pitch, phase = PLAIN
    tight = SolveOptions(tie_tolerance=1e-14, embedment_tolerance=1e-14)
    found += [
        Demonstration("tiny thread", "all lengths times 1e-6", _resized(plain, 1e-6)),
        Demonstration("huge thread", "all lengths times 1e6", _resized(plain, 1e6)),
        Demonstration(
            "large coordinates",
            "a million turns of phase added",
            replace(plain, pose_deg=(roll, pitch, phase + 360.0e6)),
        ),
        Demonstration("tolerances", "of ties and of embedment 1e-14", replace(plain, options=tight)),
    ]
    return found


def _resized(case: Case, factor: float) -> Case:
    return replace(case, pair=scaled(case.pair, factor), scale=factor)


def shown(exact: Method, others: Sequence[Method], demonstration: Demonstration) -> Shown:
    """What all methods do there."""
    case = demonstration.case
    replies = []
    for method in others:
        error = method.declared_error(case.pair)
        (answer,) = method.answers([case])
        replies.append(Reply(outcome(case, answer, truths(exact, case, error), error), answer))
    return Shown(demonstration, exact.answers([case])[0], tuple(replies))


def in_words(reply: Reply, exact: Answer, scale: float) -> str:
    """A reply in words; lengths in inches on a 1/4-20."""
    if isinstance(reply.answer, Refusal):
        return f"refused: {reply.answer.reason}"
    if not reply.outcome.is_wrong or not isinstance(exact, ContactState):
        return reply.outcome.value
    one, other = reply.answer, exact
    numbers = {
        Outcome.HEIGHT: (one.poses[0].translation[2] / scale, other.poses[0].translation[2] / scale, " in"),
        Outcome.SECOND: (one.lambda_deg, other.lambda_deg, " deg"),
        Outcome.THIRD: (one.mu_deg, other.mu_deg, " deg"),
    }
    if reply.outcome is Outcome.CLASS:
        return f"**wrong**: {_class(one)} instead of {_class(other)}"
    if reply.outcome not in numbers:
        return f"**wrong**: {reply.outcome.value}"
    computed, true, unit = numbers[reply.outcome]
    return f"**wrong**: {reply.outcome.value}, {_number(computed)}{unit} instead of {_number(true)}"


def _class(state: ContactState) -> str:
    return state.state_class.value.replace("_", " ")


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.6g}"
