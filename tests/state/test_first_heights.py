"""First contacts alone are those of whole states."""

from __future__ import annotations

import numpy as np

from threadstate.state.records import first_heights
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
POSES_DEG = ((1.0, 2.0, 30.0), (-4.0, 4.0, 200.0), (0.0, 3.0, 10.0), (4.0, -1.0, 351.0), (1e-3, 0.0, 77.0))


def test_first_heights_are_those_of_whole_states() -> None:
    first = [state.poses[0] for state in solve_poses(PAIR, POSES_DEG)]
    found = first_heights(PAIR, np.array([np.ravel(pose.rotation) for pose in first]))
    assert np.allclose(found, [pose.translation[2] for pose in first], rtol=0.0, atol=1e-13 * PAIR.nominal_diameter)


def test_each_first_height_is_the_same_whatever_the_others_are() -> None:
    rotations = np.array([np.ravel(state.poses[0].rotation) for state in solve_poses(PAIR, POSES_DEG)])
    alone = [first_heights(PAIR, rotations[i : i + 1])[0] for i in range(len(rotations))]
    assert np.array_equal(first_heights(PAIR, rotations), alone)
