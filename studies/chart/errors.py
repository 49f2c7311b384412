"""How far answers are from the truth."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from studies.chart.measure import Run
from threadstate.state.model import ContactState, FeaturePair

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
    """What a run came to.

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
