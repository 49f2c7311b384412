"""What was found at one hard place: counts, the largest changes, and every silent failure with its pose."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from studies.methods import FIT_DIAMETERS, USUAL, Case
from studies.stability.brute_force import Event, Fault
from threadstate.thread.catalogue import pair_by_designation


@dataclass(frozen=True, slots=True)
class Failure:
    """A silent failure: what is wrong, in which case (in words that reproduce it), and in detail.

    ``pose`` is in degrees; ``dimensions``, in inches, are those that are not 1/4-20 UNC's, or the other input changed.
    """

    fault: Fault
    pose: str
    dimensions: str
    detail: str


@dataclass(slots=True)
class Steepest:
    """The largest change of an answer per change of its input, and the case before it."""

    ratio: float = 0.0
    where: str = ""

    def update(self, ratio: float, case: Case) -> None:
        """Record a ratio if it is larger."""
        if ratio > self.ratio:
            self.ratio, self.where = ratio, described(case)


@dataclass(slots=True)
class Tally:
    """Counts and extremes of one place; two of them add up.

    ``trials`` are the perturbed cases, ``same_contacts`` those whose contacts are the centre's. Ratios are of heights,
    of turns times the bolt's reach and of contact points. ``largest`` has the largest change of each, in inches, by the
    decade of the input's change.
    """

    centres: int = 0
    centres_refused: int = 0
    trials: int = 0
    refused: int = 0
    same_contacts: int = 0
    other_contacts: int = 0
    unfollowed: int = 0
    without_centre: int = 0
    flips_by_margin: int = 0
    flips_at_events: int = 0
    events: Counter[Event] = field(default_factory=Counter)
    height: Steepest = field(default_factory=Steepest)
    turn: Steepest = field(default_factory=Steepest)
    point: Steepest = field(default_factory=Steepest)
    largest: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    compared_heights: int = 0
    compared_turns: int = 0
    compared_lifts: int = 0
    failures: list[Failure] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Add another one's counts and extremes to this one."""
        for name in _COUNTS:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.events.update(other.events)
        for mine, theirs in ((self.height, other.height), (self.turn, other.turn), (self.point, other.point)):
            if theirs.ratio > mine.ratio:
                mine.ratio, mine.where = theirs.ratio, theirs.where
        for decade, (height, turn, point) in other.largest.items():
            self.record_change(decade, height, turn, point)
        self.failures += other.failures

    def record_change(self, decade: int, height: float, turn: float, point: float) -> None:
        """Record the largest changes of a decade."""
        a, b, c = self.largest.get(decade, (0.0, 0.0, 0.0))
        self.largest[decade] = max(a, height), max(b, turn), max(c, point)

    def fail(self, fault: Fault, case: Case, detail: str) -> None:
        """Record a silent failure, once for each case and fault."""
        failure = Failure(fault, _pose(case), _changed_input(case), detail)
        if all(
            (known.fault, known.pose, known.dimensions) != (fault, failure.pose, failure.dimensions)
            for known in self.failures
        ):
            self.failures.append(failure)


_COUNTS = (
    "centres",
    "centres_refused",
    "trials",
    "refused",
    "same_contacts",
    "other_contacts",
    "unfollowed",
    "without_centre",
    "flips_by_margin",
    "flips_at_events",
    "compared_heights",
    "compared_turns",
    "compared_lifts",
)


def described(case: Case) -> str:
    """A case in words that reproduce it."""
    return ", ".join(filter(None, (_pose(case), _changed_input(case))))


def _pose(case: Case) -> str:
    roll, pitch, phase = case.pose_deg
    return f"roll {roll!r}, pitch {pitch!r}, phase {phase!r}"


def _changed_input(case: Case) -> str:
    if case.options != USUAL:
        options = case.options
        return f"tie tolerance {options.tie_tolerance:g}, embedment tolerance {options.embedment_tolerance:g}"
    if case.scale != 1.0:
        return f"all lengths times {case.scale:g}"
    pair = case.pair
    known = pair_by_designation(pair.designation)
    named = [(name, getattr(pair.fit, name), getattr(known.fit, name)) for name in FIT_DIAMETERS]
    named.append(("thread_pitch", pair.thread_pitch, known.thread_pitch))
    return ", ".join(f"{name} {value!r}" for name, value, usual in named if value != usual)
