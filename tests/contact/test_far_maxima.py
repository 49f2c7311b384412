"""Maxima of phi that are left before they are located would not have been followed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._geometry_kernel import MOTION_SIZE, motion_scale
from threadstate.contact._ridge_grid_kernel import CROSSINGS_SIZE, GRID_SIZE, MAX_CROSSINGS, set_columns
from threadstate.contact._tangency_kernel import (
    PLACEMENT_SIZE,
    TANGENCY_JET_SIZE,
    TJ_PHI,
    TJ_RATE,
    set_jet,
    set_placement,
)
from threadstate.thread.catalogue import pair_by_designation

AZIMUTHS = 32
PLACEMENTS = 150


@pytest.mark.parametrize("name", ["1/4-20 UNC-2A/2B", "M6", "1/4-16 ACME-2G at minimum material"])
def test_a_maximum_that_is_left_is_too_far_to_be_followed(name: str) -> None:
    """Of random turns: where the maximum is located all the same it reaches zero beyond ``FOLLOW_RANGE``, but for few.

    Those are of a quadratic model that does not hold as far as the maximum; other instants lead to the same contact.
    """
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    choose = np.random.default_rng(42)
    motion, other = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    grid, crossings = np.empty(GRID_SIZE), np.empty(CROSSINGS_SIZE)
    placement, jet = np.empty(PLACEMENT_SIZE), np.empty(TANGENCY_JET_SIZE)
    maxima, pose = np.empty((MAX_CROSSINGS, 2)), np.empty(12)
    set_columns(AZIMUTHS, bolt, grid)
    far = near = wrong = 0
    for _ in range(PLACEMENTS):
        roll, pitch = choose.uniform(-4.0, 4.0, 2)
        stage.rotation(math.radians(roll), math.radians(pitch), choose.uniform(0.0, 0.3), pose)
        pose[9:] = choose.uniform(-0.02, 0.02, 3) * pair.thread_pitch
        pose[11] -= choose.uniform(0.0, 0.8) * pair.thread_pitch
        axis = choose.normal(size=3)
        axis[2] *= 0.2
        stage.set_motions(pose, True, False, np.zeros(3), axis / np.linalg.norm(axis), motion, other)
        reach = ridge.FOLLOW_RANGE * motion_scale(motion, bolt)
        set_placement(motion, 0.0, placement)
        for j in range(ridge.ridge_maxima(AZIMUTHS, placement, bolt, nut, grid, crossings, maxima)):
            theta, z = maxima[j]
            set_jet(theta, z, placement, bolt, nut, jet)
            if not ridge.is_far(jet, ridge.FAR * reach):
                near += 1
                continue
            far += 1
            _, _, converges = ridge.nearby_maximum(theta, z, 2.0 * reach, placement, bolt, nut, jet)
            wrong += bool(converges and jet[TJ_RATE] > 0.0 and abs(jet[TJ_PHI]) <= reach * jet[TJ_RATE])
    assert far > 200
    assert near > 100
    assert wrong <= 0.01 * far
