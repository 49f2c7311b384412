"""The second and the third turn end at the first distinct component, by brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.state_turns import Turn, deepest_near, earlier_appearance, turns_of, within_brute_force
from tests.contact.samples import Floats, as_poses, random_poses
from threadstate.state.model import ContactState, FeaturePair
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

POSE_TOLERANCE = 1e-10
"""Of a rotation's elements and of a translation in inches: the axis here comes from slopes by differences."""
LEVEL_TOLERANCE = 1e-12
BEFORE_DEG = 1e-4
AFTER_DEG = 1e-4
NEAR_INCH = 5e-5
PARTED_INCH = 1e-6
"""A component deeper than this when it is first seen, to 1e-5 deg, had no onset there: it has parted from another."""

PAIR = quarter_twenty_unc()

SETS: dict[str, Floats] = {
    "library tilts": random_poses(31, 16, tilt_deg=4.0),
    "library tilts near phase 0": random_poses(32, 14, tilt_deg=4.0, phase_deg=20.0),
    "whole degrees": np.rint(random_poses(33, 12, tilt_deg=4.4)),
    "small tilts": random_poses(34, 8, tilt_deg=1.0),
    "all tilts": random_poses(35, 8, tilt_deg=10.0),
    "largest tilts": np.column_stack(
        [
            np.repeat([-10.0, 10.0], 3),
            np.tile([-9.9, 0.0, 9.9], 2),
            random_poses(36, 6, tilt_deg=0.0)[:, 2],
        ]
    ),
}


@pytest.fixture(scope="module")
def states() -> dict[str, list[ContactState]]:
    return {name: solve_poses(PAIR, poses) for name, poses in SETS.items()}


@pytest.fixture(scope="module")
def turns(states: dict[str, list[ContactState]]) -> dict[str, list[tuple[ContactState, Turn]]]:
    return {
        name: [(s, turn) for s in group if not is_level(s) for turn in turns_of(PAIR, s)]
        for name, group in states.items()
    }


def is_level(state: ContactState) -> bool:
    return state.roll_deg == 0.0 == state.pitch_deg


def pose_of(state: ContactState) -> tuple[float, float, float]:
    return state.roll_deg, state.pitch_deg, state.phase_deg


def test_the_sets_are_as_large_as_they_should_be() -> None:
    assert sum(len(poses) for poses in SETS.values()) >= 60
    assert len(as_poses(SETS["whole degrees"])) == np.sum(SETS["whole degrees"][:, 2] % 1.0 == 0.0)


@pytest.mark.parametrize("name", SETS)
def test_poses_follow_from_the_turns(name: str, turns: dict[str, list[tuple[ContactState, Turn]]]) -> None:
    for state, turn in turns[name]:
        if turn.turn_deg is None:
            continue
        assert 0.0 <= turn.turn_deg <= SolveOptions().turn_limit_deg
        rotation, translation = turn.pose_after(turn.turn_deg)
        found = state.poses[turn.stage - 1]
        np.testing.assert_allclose(found.rotation, rotation, rtol=0.0, atol=POSE_TOLERANCE, err_msg=f"{pose_of(state)}")
        np.testing.assert_allclose(found.translation, translation, rtol=0.0, atol=POSE_TOLERANCE)


@pytest.mark.parametrize("name", SETS)
def test_turns_lower_the_origin(name: str, turns: dict[str, list[tuple[ContactState, Turn]]]) -> None:
    for state, turn in turns[name]:
        lowered = turn.translation[2] - turn.pose_after(1e-3)[1][2]
        assert lowered > 0.0, pose_of(state)


@pytest.mark.parametrize("name", SETS)
def test_no_earlier_component(name: str, turns: dict[str, list[tuple[ContactState, Turn]]]) -> None:
    onsets = []
    for state, turn in turns[name]:
        earlier = earlier_appearance(PAIR, turn, SolveOptions().turn_limit_deg, steps=14)
        if earlier is None:
            continue
        # A piece that parts from an overlap was in contact before: it is no new contact.
        if earlier.depth < PARTED_INCH:
            onsets.append((pose_of(state), turn.stage, turn.turn_deg, earlier))
    assert onsets == []


@pytest.mark.parametrize("name", SETS)
def test_a_turn_ends_at_the_onset_of_a_component(name: str, turns: dict[str, list[tuple[ContactState, Turn]]]) -> None:
    for state, turn in turns[name]:
        if turn.turn_deg is None or turn.turn_deg < BEFORE_DEG or not within_brute_force(turn):
            continue
        for contact in turn.found:
            if contact.features is FeaturePair.FLUSH:
                continue
            point = np.array(contact.point)
            before = deepest_near(PAIR, *turn.pose_after(turn.turn_deg - BEFORE_DEG), point, NEAR_INCH)
            after = deepest_near(PAIR, *turn.pose_after(turn.turn_deg + AFTER_DEG), point, NEAR_INCH)
            # Nothing there before, something after: it is joined to no other at its onset.
            assert before < 0.0 < after, (pose_of(state), turn.stage)


@pytest.mark.parametrize("name", SETS)
def test_where_the_turn_ends_flush_the_bolt_lies_on_the_surface(
    name: str, turns: dict[str, list[tuple[ContactState, Turn]]]
) -> None:
    for state, turn in turns[name]:
        if not turn.found or turn.found[0].features is not FeaturePair.FLUSH:
            continue
        pose = state.poses[turn.stage - 1]
        assert abs(pose.translation[2]) < LEVEL_TOLERANCE
        assert math.hypot(*pose.rotation[2][:2]) < LEVEL_TOLERANCE


def test_every_way_a_turn_can_end_is_among_the_sets(turns: dict[str, list[tuple[ContactState, Turn]]]) -> None:
    ends = {
        (turn.stage, turn.found[0].features.value if turn.found else "none")
        for group in turns.values()
        for _, turn in group
    }
    assert {(2, "flush"), (2, "edge-edge"), (2, "edge-thread"), (2, "thread-edge")} <= ends
    assert {(3, "edge-edge"), (3, "edge-thread"), (3, "thread-edge")} <= ends


@pytest.mark.parametrize(
    ("roll", "pitch", "phases", "place"),
    [
        (-3.2083, 3.8903, np.linspace(1.51, 1.54, 13), (0.084008, 0.055526)),
        (-2.8166, 3.4257, np.linspace(1.62, 1.621, 6), (0.084008, 0.055526)),
        # The peak along the edge comes into the narrow box only during the time in which it is looked at.
        (-3.2082665934517456, 3.8903069117339752, np.linspace(1.6, 1.6633, 12), (0.084008, 0.055526)),
    ],
)
def test_a_contact_where_flank_meets_fillet_beside_an_earlier_one_is_not_missed(
    roll: float, pitch: float, phases: Floats, place: tuple[float, float]
) -> None:
    """The nut's edge touches within 1e-6 rad of where its crest fillet begins: the curvature jumps there."""
    poses = np.column_stack([np.full((len(phases), 2), (roll, pitch)), phases])
    for state in solve_poses(PAIR, poses):
        second = state.contacts[1]
        assert second.features is FeaturePair.THREAD_EDGE
        assert second.point[:2] == pytest.approx(place, abs=1e-5)
        turn = turns_of(PAIR, state)[0]
        assert turn.turn_deg is not None
        before, after = (
            deepest_near(PAIR, *turn.pose_after(turn.turn_deg + d), np.array(second.point), 5e-6) for d in (-1e-3, 1e-3)
        )
        assert before < 0.0 < after
