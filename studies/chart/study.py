"""The data of the chart and its page, measured in one run by processes side by side.

The poses, every contestant on them, what a scene costs before the first pose, and heights of first contact by meshes,
extrapolated to meshes of no chord height (Richardson).
"""

from __future__ import annotations

import multiprocessing
import resource
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.sample import sample_poses
from studies.chart.contestant import LIMITED, ByMesh, Contestant, Exactly, Scale, Series, contestants
from studies.chart.errors import Score, score
from studies.chart.exact import Pose, proved_state
from studies.chart.measure import Run, mesh_procedure, run
from threadstate.errors import UnresolvedPoseError
from threadstate.mesh.options import MeshOptions, Scene
from threadstate.mesh.presets import Preset, Tessellation
from threadstate.mesh.procedure import MeshProcedure
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solid import Floats
from threadstate.state.model import ContactState
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair, Part


def true_states(pair: Pair, count: int) -> list[tuple[Pose, ContactState]]:
    """The first poses that are tilted and that the tightest search decides, and their states: the truth."""
    found: list[tuple[Pose, ContactState]] = []
    for roll, pitch, phase in sample_poses(2 * count + 10).tolist():
        if len(found) < count and (roll or pitch):
            try:
                found.append(((roll, pitch, phase), proved_state(pair, (roll, pitch, phase), LIMITED)))
            except UnresolvedPoseError:
                continue
    return found


@dataclass(frozen=True)
class SceneCost:
    """Triangles of both parts; memory (bytes) that meshes and search trees add to a fresh process; CPU seconds."""

    scene: Scene
    preset: Preset
    triangles: int
    memory: int
    seconds: float


def scene_cost(pair: Pair, scene: Scene, preset: Preset) -> SceneCost:
    """The cost of a scene, measured in a process of its own."""
    with multiprocessing.get_context("forkserver").Pool(1) as pool:
        return pool.apply(_cost, (pair, scene, preset))


def _cost(pair: Pair, scene: Scene, preset: Preset) -> SceneCost:
    # What is compiled and imported at first use is no part of the scene.
    mesh_procedure(ByMesh(MeshOptions(Preset.COARSE.tessellation, scene=scene)), pair)
    before, began = _peak(), time.process_time()
    method = mesh_procedure(ByMesh(MeshOptions(preset.tessellation, scene=scene)), pair)
    seconds, memory = time.process_time() - began, _peak() - before
    parts = [scene_part(method.pair, part, preset.tessellation, scene) for part in Part]
    return SceneCost(scene, preset, sum(len(part.triangles) for part in parts), memory, seconds)


def _peak() -> int:
    """The most memory that this process has had, in bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


FINAL_STEP = 1e-7
"""In thread pitches: small beside every chord height."""


@dataclass(frozen=True)
class Extrapolated:
    """By pose: the height at the finest mesh, and at none; lengths."""

    finest: Floats
    limit: Floats


def extrapolated_heights(pair: Pair, poses: list[Pose], chords: Sequence[float]) -> Extrapolated:
    """Heights of first contact by meshes of those chord heights (thread pitches), the lowest last.

    A mesh's height is off by a part of its chord height; which part depends on where on a facet the contact is. So a
    line is laid through the heights over the chord heights, each weighing as much as its chord is low.
    """
    heights = np.empty((len(chords), len(poses)))
    for k, chord in enumerate(chords):
        options = MeshOptions(Tessellation(chord, 0.5), final_step=FINAL_STEP, scene=Scene.EDGES)
        method = MeshProcedure(pair, options)
        for i, pose in enumerate(poses):
            found, _ = method.first_pose(pose)
            # The blocked place is up to a final step too low: half of one is left.
            heights[k, i] = found[2, 3] + 0.5 * FINAL_STEP * pair.thread_pitch
    return Extrapolated(heights[-1], limit_of_none(np.array(chords), heights))


def limit_of_none(chords: Floats, heights: Floats) -> Floats:
    """Where lines through heights (k, n) over chords (k,) meet chord 0, each point weighing 1 / chord."""
    weight = 1.0 / chords
    mean = (weight @ chords) / weight.sum()
    slope = ((weight * (chords - mean)) @ heights) / (weight @ (chords - mean) ** 2)
    return np.asarray((weight @ heights) / weight.sum() - slope * mean)


CHUNK = 20
"""Poses of a job of the comparison; its meshes are made again for each."""

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
