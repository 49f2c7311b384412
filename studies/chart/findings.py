"""Results of the measurements: who is on the front, at what ratio of times, how the finest mesh agrees."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from studies.chart.contestant import TURN_LIMIT_DEG, Series
from studies.chart.errors import FailureMode, Spread, failure_mode, height_error, is_clear, same_components, spread
from studies.chart.exact import Pose
from studies.chart.measure import Run
from studies.chart.study import Measured, Study
from threadstate.state.model import ContactState

LEVELS_INCH = (1e-4, 3e-5, 1e-5, 3e-6, 1e-6)
"""Errors of the height at which times are compared."""

MESHES = (Series.EDGES, Series.FULL, Series.BAND, Series.DECADES, Series.COAL)


@dataclass(frozen=True)
class Ratio:
    """How many times as long the fastest contestant that is as accurate as ``level`` takes, pose by pose.

    ``name`` is the contestant's; ``low`` and ``high`` are the 5th and 95th percentiles over the poses.
    """

    level: float
    name: str
    median: float
    low: float
    high: float


@dataclass(frozen=True)
class Disagreement:
    """A pose on which the finest mesh has other contacts than the exact method, and why."""

    pose: Pose
    mode: FailureMode
    clear: bool


@dataclass(frozen=True)
class Agreement:
    """The finest mesh against the truth.

    ``same`` of ``clear`` poses, those whose margins exceed the mesh's own error, have the same later contacts.
    """

    asked: int
    answered: int
    height: Spread
    clear: int
    same: int
    disagreements: tuple[Disagreement, ...]

    @property
    def same_share(self) -> float:
        """Of the clear poses, NaN of none."""
        return self.same / self.clear if self.clear else math.nan


def as_built(study: Study) -> Measured:
    """The exact method as it is built."""
    return study.measured[0]


def name_of(one: Measured) -> str:
    """A contestant by series and setting."""
    return f"{one.run.contestant.series.value}, {one.run.contestant.label}"


def front(points: Sequence[tuple[float, float]]) -> list[int]:
    """The indices of points that no other is at most equal to in both costs and less in one; by the first cost."""
    found: list[int] = []
    lowest = float("inf")
    for i in sorted(range(len(points)), key=lambda k: points[k]):
        if points[i][1] < lowest or (found and points[i] == points[found[-1]]):
            found.append(i)
            lowest = points[i][1]
    return found


def on_the_front(study: Study) -> list[Measured]:
    """The contestants that nothing beats both in median time and in the 95th percentile of the height's error."""
    costs = [(one.score.seconds.median, one.score.height.p95) for one in study.measured]
    return [study.measured[k] for k in front(costs)]


def better_in_something(study: Study) -> list[Measured]:
    """Sampling contestants that are faster than the exact method, or nearer in heights, points or turns."""
    exact = as_built(study).score
    return [
        one
        for one in study.measured
        if one.run.contestant.series is not Series.EXACT
        and (
            one.score.seconds.median <= exact.seconds.median
            or one.score.height.p95 <= exact.height.p95
            or one.score.point.p95 <= exact.point.p95
            or one.score.turn.p95 <= exact.turn.p95
        )
    ]


def poses_both_faster_and_nearer(study: Study) -> int:
    """How many single answers by sampling took less time than the exact one and have a smaller error of height."""
    exact = as_built(study).run
    count = 0
    for one in study.measured:
        if one.run.contestant.series is not Series.EXACT:
            for k, true in enumerate(study.poses_truth):
                state, reference = one.run.states[k], exact.states[k]
                if state is not None and reference is not None:
                    faster = one.run.seconds[k] < exact.seconds[k]
                    count += faster and height_error(state, true) < height_error(reference, true)
    return count


def ratios(study: Study, series: tuple[Series, ...]) -> list[Ratio]:
    """At each level, the fastest of those series that reaches it against the exact method."""
    exact = np.array(as_built(study).run.seconds)
    found = []
    for level in LEVELS_INCH:
        able = [one for one in study.measured if one.run.contestant.series in series and one.score.height.p95 <= level]
        if able:
            best = min(able, key=lambda one: one.score.seconds.median)
            low, median, high = np.quantile(np.array(best.run.seconds) / exact, (0.05, 0.5, 0.95)).tolist()
            found.append(Ratio(level, name_of(best), median, low, high))
    return found


def agreement(study: Study) -> Agreement:
    """The finest mesh on the poses of the comparison."""
    pitch = study.pair.thread_pitch
    solved = [(pair, run) for run in study.compared for pair in zip(run.states, run.seconds, strict=True)]
    true = study.truth[: study.scale.compared]
    heights, disagreements, clear, same, answered = [], [], 0, 0, 0
    for ((state, _), run), (pose, right) in zip(solved, true, strict=True):
        if state is None:
            continue
        answered += 1
        heights.append(height_error(state, right))
        is_told = is_clear(right, run.segment)
        clear += is_told
        same += is_told and same_components(state, right, pitch)
        mode = failure_mode(state, right, run.segment, run.reach, pitch)
        if mode is not None:
            disagreements.append(Disagreement(pose, mode, is_told))
    return Agreement(len(true), answered, spread(heights), clear, same, tuple(disagreements))


def modes(one: Measured, study: Study) -> Counter[FailureMode]:
    """How often a contestant's answers are others than the true ones, by mode."""
    found: Counter[FailureMode] = Counter()
    for state, true in zip(one.run.states, study.poses_truth, strict=True):
        mode = _mode(state, true, one.run, study)
        if mode is not None:
            found[mode] += 1
    return found


def _mode(state: ContactState | None, true: ContactState, run: Run, study: Study) -> FailureMode | None:
    if state is None:
        return None
    return failure_mode(state, true, run.segment, run.reach, study.pair.thread_pitch)


@dataclass(frozen=True)
class Backing:
    """How the truth is backed: distances of the exact height from meshes, and from as-built answers."""

    finest: Spread
    extrapolated: Spread


def backing(study: Study) -> Backing:
    """Extrapolated heights against the true ones."""
    true = np.array([state.poses[0].translation[2] for state in study.poses_truth[: study.scale.extrapolated]])
    found = study.extrapolated
    return Backing(spread(np.abs(found.finest - true).tolist()), spread(np.abs(found.limit - true).tolist()))


def document(study: Study) -> str:
    """Everything measured; times in s, lengths in the pair's unit, angles in deg; what is no number is null."""
    front = {id(one) for one in on_the_front(study)}
    value = {
        "pair": study.pair.designation,
        "unit": study.pair.unit.value,
        "turn_limit_deg": TURN_LIMIT_DEG,
        "poses": [pose for pose, _ in study.truth[: study.scale.poses]],
        "contestants": [
            {
                "series": one.run.contestant.series.value,
                "label": one.run.contestant.label,
                "triangles": one.run.triangles,
                "setup_s": one.run.setup_s,
                "on_front": id(one) in front,
                **asdict(one.score),
                "failure_modes": {mode.name.lower(): count for mode, count in modes(one, study).items()},
                "seconds_by_pose": one.run.seconds,
            }
            for one in study.measured
        ],
        "ratios": {
            "meshes": [asdict(one) for one in ratios(study, MESHES)],
            "curves": [asdict(one) for one in ratios(study, (Series.CURVES,))],
        },
        "agreement": asdict(agreement(study)),
        "backing": asdict(backing(study)),
        "scenes": [asdict(cost) for cost in study.costs],
    }
    return json.dumps(_without_nan(value), indent=1, allow_nan=False) + "\n"


def _without_nan(value: object) -> object:
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(part) for part in value]
    return None if isinstance(value, float) and math.isnan(value) else value
