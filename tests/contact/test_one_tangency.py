"""A tangency of threads and an earlier contact beside it: one where phi falls by less than round-off between them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._geometry_kernel import MOTION_SIZE
from threadstate.contact._stage_kernel import set_motions
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed
DOWN = np.array([0.0, 0.0, -1.0])


@pytest.mark.parametrize(("share", "expected"), [(0.0, True), (0.5, True), (2.0, False), (1e6, False)])
def test_one_within_round_off_of_phi_along_the_helix(share: float, expected: bool) -> None:
    state = solve_pose(PAIR, 4.0, 1.0, 358.725)
    contact, pose = state.contacts[-1], state.poses[-1]
    assert contact.features is FeaturePair.THREAD_THREAD
    rotation, origin = np.array(pose.rotation), np.array(pose.translation)
    motion, of_nut = np.empty(MOTION_SIZE), np.empty(MOTION_SIZE)
    set_motions(np.concatenate([rotation.ravel(), origin]), False, False, DOWN, DOWN, motion, of_nut)
    x, y, z = contact.point_bolt
    theta = math.atan2(y, x)
    placement, jet = np.empty(tk.PLACEMENT_SIZE), np.empty(tk.TANGENCY_JET_SIZE)
    tk.set_placement(motion, 0.0, placement)
    tk.set_jet(theta, z, placement, BOLT, NUT, jet)

    way = math.sqrt(2.0 * share * tk.PHI_ROUND_OFF * PAIR.thread_pitch / -jet[tk.TJ_UU])
    radius, advance = math.hypot(x, y), PAIR.thread_pitch / (2.0 * math.pi)
    beside = np.array([radius * math.cos(theta + way), radius * math.sin(theta + way), z + advance * way])
    tangency = np.array([0.0, theta, z, *contact.point])
    assert tk.is_one_with(tangency, *(rotation @ beside + origin), motion, BOLT, NUT) is expected
