"""Heights of first contact by meshes, extrapolated to meshes of no chord height (Richardson)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from studies.chart.exact import Pose
from threadstate.mesh.method import MeshMethod
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import Tessellation
from threadstate.mesh.scene_name import Scene
from threadstate.mesh.solid import Floats
from threadstate.thread.pair import Pair

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
        method = MeshMethod(pair, options)
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
