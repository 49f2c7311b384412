"""Every contact lies on both surfaces in its stage's pose, with the right normal, regions and margins."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

from oracle.contact_rules import Touch, frame_gap, normal_faults, region_faults, surface_gaps
from oracle.pose import pose_rotation
from tests.contact.samples import Floats, random_poses
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from threadstate.thread.pair import Pair

SURFACE_TOLERANCE_INCH = 1e-9
ROTATION_TOLERANCE = 1e-13

PAIR = quarter_twenty_unc()

SETS: dict[str, Floats] = {
    "library tilts": random_poses(21, 400, tilt_deg=4.0),
    "library tilts near phase 0": random_poses(22, 400, tilt_deg=4.0, phase_deg=20.0),
    "all tilts": random_poses(23, 200, tilt_deg=10.0),
    "all tilts near phase 0": random_poses(24, 200, tilt_deg=10.0, phase_deg=20.0),
    "level": random_poses(25, 100, tilt_deg=0.0),
    "level and in phase": random_poses(26, 50, tilt_deg=0.0, phase_deg=2.0),
}


@pytest.fixture(scope="module")
def states() -> dict[str, list[ContactState]]:
    return {name: solve_poses(PAIR, poses) for name, poses in SETS.items()}


def touches(pair: Pair, state: ContactState) -> list[Touch]:
    return [Touch.of(pair, contact, state.poses[contact.stage - 1]) for contact in state.contacts]


def faults(pair: Pair, state: ContactState) -> list[str]:
    found = []
    for touch in touches(pair, state):
        gaps = {"frames": frame_gap(touch), **surface_gaps(touch)}
        wrong = [f"{name} {gap}" for name, gap in gaps.items() if gap > SURFACE_TOLERANCE_INCH]
        wrong += normal_faults(touch) + region_faults(touch, SURFACE_TOLERANCE_INCH)
        where = f"stage {touch.contact.stage} {touch.contact.features.value}"
        found += [f"{state.roll_deg, state.pitch_deg, state.phase_deg} {where}: {fault}" for fault in wrong]
    return found


@pytest.mark.parametrize("name", SETS)
def test_contacts_lie_on_both_surfaces(name: str, states: dict[str, list[ContactState]]) -> None:
    assert [fault for state in states[name] for fault in faults(PAIR, state)] == []


def test_contacts_of_another_root_form_lie_on_both_surfaces() -> None:
    pair = quarter_twenty_unc(RootForm.NEWER)
    solved = solve_poses(pair, random_poses(27, 100, tilt_deg=5.0))
    assert [fault for state in solved for fault in faults(pair, state)] == []


@pytest.mark.parametrize("name", SETS)
def test_first_pose_is_the_one_asked_for_and_comes_straight_down(
    name: str, states: dict[str, list[ContactState]]
) -> None:
    for state in states[name]:
        wanted = pose_rotation(state.roll_deg, state.pitch_deg, state.phase_deg)
        np.testing.assert_allclose(state.poses[0].rotation, wanted, rtol=0.0, atol=ROTATION_TOLERANCE)
        assert state.poses[0].translation[:2] == (0.0, 0.0)


@pytest.mark.parametrize("name", SETS)
def test_poses_are_rotations(name: str, states: dict[str, list[ContactState]]) -> None:
    for state in states[name]:
        for pose in state.poses:
            rotation = np.array(pose.rotation)
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), rtol=0.0, atol=ROTATION_TOLERANCE)
            assert np.linalg.det(rotation) > 0.0


def test_the_sets_hold_every_pair_of_features_that_comes_second_or_third(
    states: dict[str, list[ContactState]],
) -> None:
    seen = Counter((c.stage, c.features.value) for group in states.values() for s in group for c in s.contacts)
    assert {(2, "edge-edge"), (2, "edge-thread"), (2, "thread-edge"), (2, "flush")} <= set(seen)
    assert {(3, "edge-edge"), (3, "edge-thread"), (3, "thread-edge"), (1, "flush")} <= set(seen)


def test_no_number_of_a_state_is_nan(states: dict[str, list[ContactState]]) -> None:
    for group in states.values():
        for state in group:
            numbers = [
                n for c in state.contacts for n in (*c.point, *c.point_bolt, *c.normal, c.bolt_margin, c.nut_margin)
            ]
            numbers += [n for pose in state.poses for row in (*pose.rotation, pose.translation) for n in row]
            numbers += [
                n
                for n in (state.lambda_deg, state.mu_deg, state.drop, state.embedment, state.pivot_offset)
                if n is not None
            ]
            assert all(math.isfinite(n) for n in numbers)
