"""How far answers are from the truth, and why one by meshes is another than the true one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np

from studies.chart.measure import Run
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag

FLOOR_INCH = 1e-17
"""An error of nothing is charted as this; a height of some 1e-3 in is written down to 2e-19."""


@dataclass(frozen=True)
class Spread:
    """Median, 95th percentile and largest of a quantity; NaN of none."""

    median: float
    p95: float
    largest: float


@dataclass(frozen=True)
class Score:
    """The result of a run.

    Errors are of poses that were answered: ``height`` of first contact and ``point`` (of contacts of the same stage
    and place in order, the largest of a pose) as lengths, ``turn`` (the larger of both) in degrees. ``same_class`` and
    ``same_contacts`` (features and flags, in order) are shares of the answered ones. ``seconds`` are of CPU, a pose.
    """

    height: Spread
    point: Spread
    turn: Spread
    seconds: Spread
    same_class: float
    same_contacts: float
    answered: int
    asked: int


def score(run: Run, truth: Sequence[ContactState]) -> Score:
    """A run against the true states of its poses."""
    both = [(one, true) for one, true in zip(run.states, truth, strict=True) if one is not None]
    return Score(
        height=spread(height_error(one, true) for one, true in both),
        point=spread(point_error(one, true) for one, true in both),
        turn=spread(turn_error(one, true) for one, true in both),
        seconds=spread(run.seconds),
        same_class=share(one.state_class is true.state_class for one, true in both),
        same_contacts=share(same_contacts(one, true) for one, true in both),
        answered=len(both),
        asked=len(truth),
    )


def spread(values: Iterable[float]) -> Spread:
    """The spread of those values that are numbers."""
    numbers = np.array([value for value in values if not math.isnan(value)])
    if len(numbers) == 0:
        return Spread(math.nan, math.nan, math.nan)
    return Spread(float(np.median(numbers)), float(np.quantile(numbers, 0.95)), float(numbers.max()))


def share(holds: Iterable[bool]) -> float:
    """The share that holds; NaN of none."""
    found = list(holds)
    return sum(found) / len(found) if found else math.nan


def height_error(one: ContactState, true: ContactState) -> float:
    """The difference of the heights of first contact."""
    return abs(one.poses[0].translation[2] - true.poses[0].translation[2])


def point_error(one: ContactState, true: ContactState) -> float:
    """The largest distance of contacts of the same stage, patches apart; NaN where there are none."""
    distances = []
    for stage in (1, 2, 3):
        here, there = (
            [c.point for c in state.contacts if c.stage == stage and c.features is not FeaturePair.FLUSH]
            for state in (one, true)
        )
        distances += [math.dist(a, b) for a, b in zip(here, there, strict=False)]
    return max(distances, default=math.nan)


def turn_error(one: ContactState, true: ContactState) -> float:
    """The larger difference of the turns that both have, in degrees; NaN where there is none."""
    turns = ((one.lambda_deg, true.lambda_deg), (one.mu_deg, true.mu_deg))
    return max((abs(a - b) for a, b in turns if a is not None and b is not None), default=math.nan)


def same_contacts(one: ContactState, true: ContactState) -> bool:
    """Whether flags, and features by stage, are the same; of patches, only that there is one."""
    return one.flags == true.flags and _features(one) == _features(true)


def _features(state: ContactState) -> list[tuple[int, FeaturePair]]:
    return [(c.stage, c.features) for c in state.contacts if c.features is not FeaturePair.FLUSH]


SAME_PLACE = 0.2
"""Contacts nearer than this many thread pitches, their turns alike, are of the same component."""
ALIKE_DEG = 0.2
"""Turns this near each other are of one event to a mesh: facets under a grazing edge meet up to that much early."""


class FailureMode(StrEnum):
    """What went wrong at the first stage that differs, by the first rule that applies."""

    TUNNELLED = "the descent passed the first contact"
    """The height is too low by more than meshes and steps explain."""
    THREAD_ON_THREAD = "thread met thread, which no edge sees"
    """The true contact is one of two threads."""
    GROWN_TOGETHER = "a contact too near an earlier one"
    """A contact, the true one or the answer's, is within four segments of an earlier one: one overlap for both."""
    ONE_STEP = "two places of contact within one step"
    """Turn and place are right, but the answer has another contact beside: both appear within the final step."""
    REGION_BOUNDARY = "a contact at the boundary of its region"
    """Turn and place are right and the features are not, within a segment of the boundary of a region."""
    NEARLY_LEVEL = "the bolt nearly flush"
    """The turn is right, and it ends flush in one of the two alone."""
    TIE = "two contacts at nearly the same turn"
    """The turn is right and the place is another: two contacts come within what meshes can be off."""
    EARLY_FACETS = "facets met where surfaces do not"
    """The turn ends before the true one, or where there is none."""
    MISSED = "a contact passed over"
    """The turn goes on beyond the true contact."""
    UNEXPLAINED = "unexplained"
    """No rule applies."""


def is_clear(state: ContactState, segment: float) -> bool:
    """Whether a mesh with edges of such segments can distinguish the true contacts and their features."""
    touching = [contact for contact in state.contacts if contact.features is not FeaturePair.FLUSH]
    margins = [margin for contact in touching for margin in (contact.bolt_margin, contact.nut_margin)]
    return (
        all(math.dist(a.point, b.point) > 4.0 * segment for a, b in combinations(touching, 2))
        and min(margins) > segment
        and not {Flag.TIE, Flag.BALANCED, Flag.GRAZING} & set(state.flags)
    )


def same_components(one: ContactState, true: ContactState, thread_pitch: float) -> bool:
    """Whether second and third contacts are the same, by place and turn, or are absent or a patch in both."""
    for turns, stage in (((one.lambda_deg, true.lambda_deg), 2), ((one.mu_deg, true.mu_deg), 3)):
        if (turns[0] is None) != (turns[1] is None) or not alike(*turns):
            return False
        here, there = _touching(one, stage), _touching(true, stage)
        if bool(here) != bool(there) or (here and not _near(here, there, thread_pitch)):
            return False
    return True


def alike(one: float | None, other: float | None) -> bool:
    """Whether two turns (deg) are of one event to a mesh."""
    return one is None or other is None or abs(one - other) < ALIKE_DEG


def failure_mode(
    one: ContactState, true: ContactState, segment: float, reach: float, thread_pitch: float
) -> FailureMode | None:
    """The mode of an answer that is not the true one; None where it is.

    ``segment`` is the longest of the mesh's edges, ``reach`` what meshes and steps can be off (lengths).
    """
    if same_components(one, true, thread_pitch) and same_contacts(one, true):
        return None
    if height_error(one, true) > 10.0 * reach and one.poses[0].translation[2] < true.poses[0].translation[2]:
        return FailureMode.TUNNELLED
    turns = {1: (0.0, 0.0), 2: (one.lambda_deg, true.lambda_deg), 3: (one.mu_deg, true.mu_deg)}
    for stage, (mine, right) in turns.items():
        here, there = _touching(one, stage), _touching(true, stage)
        is_alike = (mine is None) == (right is None) and alike(mine, right)
        is_there = bool(here) == bool(there) and (not here or _near(here, there, thread_pitch))
        if is_alike and is_there and [c.features for c in here] == [c.features for c in there]:
            continue
        if any(contact.features is FeaturePair.THREAD_THREAD for contact in there):
            return FailureMode.THREAD_ON_THREAD
        if any(_beside_earlier(state, stage, segment) for state in (one, true)):
            return FailureMode.GROWN_TOGETHER
        if is_alike and is_there and Flag.TIE in one.flags and len(here) > len(there):
            return FailureMode.ONE_STEP
        if is_alike and is_there:
            margins = [margin for c in here + there for margin in (c.bolt_margin, c.nut_margin)]
            return FailureMode.REGION_BOUNDARY if min(margins) < segment else FailureMode.UNEXPLAINED
        if is_alike:
            return FailureMode.TIE if here and there else FailureMode.NEARLY_LEVEL
        if mine is not None and (right is None or mine < right):
            return FailureMode.EARLY_FACETS
        return FailureMode.MISSED
    return (
        FailureMode.NEARLY_LEVEL if (Flag.FLUSH in one.flags) != (Flag.FLUSH in true.flags) else FailureMode.UNEXPLAINED
    )


def _beside_earlier(state: ContactState, stage: int, segment: float) -> bool:
    """Whether a contact of a stage is within four segments of one of an earlier stage."""
    earlier = [contact for k in range(1, stage) for contact in _touching(state, k)]
    return any(math.dist(a.point, b.point) < 4.0 * segment for a in _touching(state, stage) for b in earlier)


def _touching(state: ContactState, stage: int) -> list[Contact]:
    return [c for c in state.contacts if c.stage == stage and c.features is not FeaturePair.FLUSH]


def _near(here: Sequence[Contact], there: Sequence[Contact], thread_pitch: float) -> bool:
    return any(math.dist(a.point, b.point) < SAME_PLACE * thread_pitch for a in here for b in there)
