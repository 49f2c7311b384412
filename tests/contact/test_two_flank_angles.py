"""Pairs whose flanks have two angles, the flatter one facing the bolt's base or away from it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from oracle.first_height import first_height
from oracle.lift import least_lift
from tests.contact.samples import random_poses
from tests.thread.shapes import BUTTRESS, TURNED_BUTTRESS
from threadstate.errors import InvalidValueError
from threadstate.state.model import Flag
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits

SEED = 1907


def poses_near_phase(count: int) -> np.ndarray:
    """Half of them within the phases at which a thread is met first."""
    poses = random_poses(SEED, count, tilt_deg=4.0)
    poses[::2, 2] = np.random.default_rng(SEED).uniform(-20.0, 20.0, len(poses[::2]))
    return poses


@pytest.mark.slow
@pytest.mark.parametrize("pair", [BUTTRESS, TURNED_BUTTRESS], ids=lambda pair: pair.designation)
def test_embedment_is_the_least_lift(pair: Pair) -> None:
    embedded = [state for state in solve_poses(pair, poses_near_phase(40)) if (state.embedment or 0.0) > 0.0]
    assert len(embedded) >= 3
    for state in embedded[:8]:
        last = state.poses[-1]
        lift = least_lift(pair, np.array(last.rotation), np.array(last.translation))
        assert state.embedment == pytest.approx(lift, abs=1e-8 * pair.thread_pitch)


@pytest.mark.parametrize("pair", [BUTTRESS, TURNED_BUTTRESS], ids=lambda pair: pair.designation)
def test_a_left_hand_pair_is_the_mirror_image(pair: Pair) -> None:
    left = replace(pair, hand=Hand.LEFT)
    poses = poses_near_phase(30)
    mirrored = solve_poses(left, poses * np.array([-1.0, 1.0, -1.0]))
    for state, image in zip(solve_poses(pair, poses), mirrored, strict=True):
        assert (state.state_class, state.flags) == (image.state_class, image.flags)
        assert image.poses[-1].translation == pytest.approx(
            np.array(state.poses[-1].translation) * [1.0, -1.0, 1.0], abs=1e-12
        )


@pytest.mark.parametrize("pair", [BUTTRESS, TURNED_BUTTRESS], ids=lambda pair: pair.designation)
def test_a_level_bolt_in_phase_rests_on_its_positive_flank(pair: Pair) -> None:
    """It can be turned back by the play of the one flank and on by that of the other before it lies on the surface."""
    down, up = axial_limits(pair)
    degrees = 360.0 / pair.lead
    for phase in (-0.999 * up * degrees, 0.0, 0.999 * down * degrees):
        state = solve_pose(pair, 0.0, 0.0, phase)
        assert Flag.FLUSH in state.flags
        assert state.poses[0].translation[2] == pytest.approx(phase / degrees - down, abs=1e-14)
        assert {contact.nut_region for contact in state.contacts} == {"flank_pos"}
    for phase in (-1.001 * up * degrees, 1.001 * down * degrees):
        assert solve_pose(pair, 0.0, 0.0, phase).poses[0].translation[2] == 0.0


@pytest.mark.parametrize("name", ["flank_half_angle_deg", "flank_half_angle_neg_deg"])
def test_either_flank_may_be_too_flat(name: str) -> None:
    flat = TURNED_BUTTRESS if name == "flank_half_angle_deg" else BUTTRESS
    angle: dict[str, Any] = {name: 6.9}
    flat = replace(flat, form=replace(flat.form, **angle))
    with pytest.raises(InvalidValueError, match=rf"{name} is 6\.9; valid: at least 7 deg"):
        solve_pose(flat, 1.0, 0.0, 0.0)


def test_threads_whose_steep_flanks_meet_and_part_within_a_short_way_down_are_found() -> None:
    """A first contact of thread on thread below the surface, 2.3e-3 in above the first one of an edge."""
    pair = pair_by_designation("1/2-20 PUSH-BUTT-2A/2B at minimum material")
    pose = (-2.8435585997826642, 2.9578925131061204, -85.88997041840751)
    state = solve_pose(pair, *pose)
    assert state.contacts[0].features == "thread-thread"
    assert state.poses[0].translation[2] == pytest.approx(first_height(pair, *pose).height, abs=1e-12)
