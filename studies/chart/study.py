"""All that the chart and its page stand on, measured in one run by processes side by side."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from studies.chart.contestant import LIMITED, ByMesh, Contestant, Exactly, Series, contestants
from studies.chart.cost import SceneCost, scene_cost
from studies.chart.errors import Score, score
from studies.chart.exact import Pose
from studies.chart.extrapolation import Extrapolated, extrapolated_heights
from studies.chart.measure import Run, run
from studies.chart.sample import true_states
from studies.chart.scale import Scale
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.scene_name import Scene
from threadstate.state.model import ContactState
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

CHUNK = 20
"""Poses of a job of the comparison; its meshes are made anew for each."""

Advance = Callable[[int], None]
Job = Callable[[], object]


@dataclass(frozen=True)
class Measured:
    """A run and its score."""

    run: Run
    score: Score


@dataclass(frozen=True)
class Study:
    """What was measured on the poses: every contestant, the finest mesh on more poses, the extrapolation."""

    pair: Pair
    scale: Scale
    truth: tuple[tuple[Pose, ContactState], ...]
    measured: tuple[Measured, ...]
    compared: tuple[Run, ...]
    extrapolated: Extrapolated
    costs: tuple[SceneCost, ...]

    def of(self, series: Series) -> list[Measured]:
        """The contestants of a series, in their order."""
        return [one for one in self.measured if one.run.contestant.series is series]

    @property
    def poses_truth(self) -> list[ContactState]:
        """The true states of the poses that contestants solve."""
        return [state for _, state in self.truth[: self.scale.poses]]


def work(scale: Scale) -> int:
    """What :func:`measured_study` advances by altogether."""
    solved = sum(_weight(one) * scale.poses for one in contestants(scale)) + _compared_weight(scale)
    return solved + scale.extrapolated + len(Scene) * len(scale.presets)


def measured_study(scale: Scale, processes: int, advance: Advance) -> Study:
    """Measure everything of that scale; jobs that take long go first."""
    pair = quarter_twenty_unc()
    truth = true_states(pair, max(scale.poses, scale.compared))
    poses = [pose for pose, _ in truth[: scale.poses]]
    everyone = contestants(scale)
    finest = Contestant(
        Series.EDGES, "compared", ByMesh(MeshOptions(scale.presets[-1].tessellation, scene=Scene.EDGES)), LIMITED
    )
    compared = [pose for pose, _ in truth[: scale.compared]]
    chunks = [compared[i : i + CHUNK] for i in range(0, len(compared), CHUNK)]
    jobs: list[tuple[int, Job]] = [(_weight(one) * len(poses), partial(run, one, pair, poses)) for one in everyone]
    jobs += [(_weight(finest) * len(chunk), partial(run, finest, pair, chunk)) for chunk in chunks]
    jobs += [(scale.extrapolated, partial(extrapolated_heights, pair, poses[: scale.extrapolated], scale.chords))]
    found = _done(jobs, processes, advance)
    runs, last = found[: len(everyone)], found[-1]
    assert isinstance(last, Extrapolated)
    costs = []
    for scene in Scene:
        costs += [scene_cost(pair, scene, preset) for preset in scale.presets]
        advance(len(scale.presets))
    states = [state for _, state in truth[: scale.poses]]
    return Study(
        pair=pair,
        scale=scale,
        truth=tuple(truth),
        measured=tuple(Measured(one, score(one, states)) for one in runs if isinstance(one, Run)),
        compared=tuple(one for one in found[len(everyone) : -1] if isinstance(one, Run)),
        extrapolated=last,
        costs=tuple(costs),
    )


def _done(jobs: Sequence[tuple[int, Job]], processes: int, advance: Advance) -> list[object]:
    """What jobs return, in their order, whatever order and process they were done in."""
    order = sorted(range(len(jobs)), key=lambda k: -jobs[k][0])
    found: list[object] = [None] * len(jobs)
    with multiprocessing.get_context("forkserver").Pool(processes) as pool:
        for k, result in pool.imap_unordered(_numbered, [(k, jobs[k][1]) for k in order]):
            found[k] = result
            advance(jobs[k][0])
    return found


def _numbered(job: tuple[int, Job]) -> tuple[int, object]:
    return job[0], job[1]()


def _compared_weight(scale: Scale) -> int:
    finest = ByMesh(MeshOptions(scale.presets[-1].tessellation, scene=Scene.EDGES))
    return _weight(Contestant(Series.EDGES, "compared", finest, LIMITED)) * scale.compared


def _weight(contestant: Contestant) -> int:
    """About how long a pose takes, beside others."""
    way = contestant.way
    if isinstance(way, Exactly):
        return 1 if way.boxes is None else 10
    if way.options.scene is Scene.CURVES:
        return 1
    return 1 + min(7, int(1e-3 / way.options.tessellation.chord_height / 7.0))
