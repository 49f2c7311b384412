"""The poses: a seed's choice, half on the grid and half off it, those that are decided."""

from __future__ import annotations

from benchmarks.sample import sample_poses
from studies.chart.contestant import LIMITED
from studies.chart.exact import Pose, proved_state
from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import ContactState
from threadstate.thread.pair import Pair


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
