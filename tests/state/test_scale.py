"""A thread written in another unit, or a thousand times as large, meets its nut in the same states."""

from __future__ import annotations

import pytest

from studies.methods import scaled
from tests.contact.samples import as_poses, random_poses
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
POSES = 200
LENGTH_TOLERANCE_PITCHES = 1e-14
ANGLE_TOLERANCE_DEG = 1e-9


@pytest.mark.parametrize("factor", [2.0**-30, 1e-6, 1e-3, 25.4, 2.0**10, 1e6])
def test_a_state_does_not_depend_on_the_scale(factor: float) -> None:
    poses = as_poses(random_poses(20260128, POSES, tilt_deg=4.0))
    resized = scaled(PAIR, factor)
    for one, other in zip(solve_poses(PAIR, poses), solve_poses(resized, poses), strict=True):
        heights = (
            one.poses[0].translation[2] / PAIR.thread_pitch,
            other.poses[0].translation[2] / resized.thread_pitch,
        )
        assert heights[1] == pytest.approx(heights[0], abs=LENGTH_TOLERANCE_PITCHES)
        assert other.lambda_deg == pytest.approx(one.lambda_deg, abs=ANGLE_TOLERANCE_DEG)
        assert other.mu_deg == pytest.approx(one.mu_deg, abs=ANGLE_TOLERANCE_DEG)
        assert (other.state_class, [contact.features for contact in other.contacts]) == (
            one.state_class,
            [contact.features for contact in one.contacts],
        )
