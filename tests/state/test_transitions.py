"""States beside phases at which the first contact changes from one part's edge to its thread: it is on both there."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.history.labels import labels_of
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
STEP_DEG = 1e-6
CHANGES = [
    # roll, pitch, about where the first contact changes, and its features on both sides.
    (-4.0, 0.0, 8.326905, FeaturePair.THREAD_EDGE, FeaturePair.EDGE_EDGE),
    (-3.0, -3.0, 19.297937, FeaturePair.THREAD_EDGE, FeaturePair.EDGE_EDGE),
    (0.0, -4.0, 35.060188, FeaturePair.EDGE_THREAD, FeaturePair.EDGE_EDGE),
    (0.0, -2.0, 5.167854, FeaturePair.EDGE_THREAD, FeaturePair.EDGE_EDGE),
    (4.0, -2.0, 9.567245, FeaturePair.EDGE_THREAD, FeaturePair.EDGE_EDGE),
    (4.0, 4.0, 343.293081, FeaturePair.THREAD_THREAD, FeaturePair.THREAD_EDGE),
]
"""Phases to the last digit, about 2e-6 deg."""


@pytest.mark.parametrize(("roll", "pitch", "phase", "before", "after"), CHANGES)
def test_what_follows_is_the_same_where_the_first_contact_leaves_an_edge(
    roll: float, pitch: float, phase: float, before: FeaturePair, after: FeaturePair
) -> None:
    phases = phase + STEP_DEG * np.arange(-25, 26)
    states = solve_poses(PAIR, [(roll, pitch, at) for at in phases.tolist()])
    features = [state.contacts[0].features for state in states]
    change = features.index(after)
    assert change > 0
    assert features == [before] * change + [after] * (len(states) - change)
    for same in (states[:change], states[change:]):
        assert len({labels_of(state).contacts for state in same}) == 1
    # The turn changes at once where the tangent about which the bolt turns is another curve's, and nowhere else.
    rises = np.abs(np.diff([state.lambda_deg for state in states]))
    assert np.delete(rises, change - 1).max() < 1e-6
    if FeaturePair.THREAD_EDGE is before:
        assert rises[change - 1] < 1e-6
