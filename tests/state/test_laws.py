"""Laws that hold of every state: periods, independence of the batch, scale, and how fast a height can fall."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.contact.samples import as_poses, random_poses
from threadstate.state.model import ContactState, FeaturePair, Flag
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from threadstate.thread.fit import Fit
from threadstate.thread.pair import Pair
from threadstate.units import MILLIMETRES_PER_INCH, LengthUnit

LENGTH_TOLERANCE_INCH = 1e-11
ANGLE_TOLERANCE_DEG = 1e-9
SHORT_LEVER_INCH = 0.02
SHORT_LEVER_TOLERANCE_DEG = 1e-8
SCALED_LENGTH_TOLERANCE_MM = 1e-9

PAIR = quarter_twenty_unc()
FARTHEST_INCH = math.hypot(PAIR.fit.bolt_major_diameter / 2, PAIR.thread_pitch)
"""No point of the bolt is farther from its origin."""


def in_millimetres(pair: Pair) -> Pair:
    """The same thread, written in mm."""
    k, fit = MILLIMETRES_PER_INCH, pair.fit
    return replace(
        pair,
        unit=LengthUnit.MILLIMETRE,
        nominal_diameter=k * pair.nominal_diameter,
        thread_pitch=k * pair.thread_pitch,
        fit=Fit(
            name=fit.name,
            bolt_major_diameter=k * fit.bolt_major_diameter,
            bolt_pitch_diameter=k * fit.bolt_pitch_diameter,
            bolt_minor_diameter=k * fit.bolt_minor_diameter,
            nut_major_diameter=k * fit.nut_major_diameter,
            nut_pitch_diameter=k * fit.nut_pitch_diameter,
            nut_minor_diameter=k * fit.nut_minor_diameter,
        ),
    )


def turns_deg(state: ContactState) -> list[float]:
    return [turn for turn in (state.lambda_deg, state.mu_deg) if turn is not None]


def lengths(state: ContactState) -> list[float]:
    """Every length of a state."""
    found = [length for length in (state.drop, state.embedment, state.pivot_offset) if length is not None]
    for pose in state.poses:
        found += pose.translation
    for contact in state.contacts:
        found += (*contact.point, *contact.point_bolt, contact.bolt_margin, contact.nut_margin)
    return found


def has_short_lever(state: ContactState) -> bool:
    """Whether two contacts are so near each other that round-off in a gap is much of the turn that closes it."""
    points = [np.array(contact.point) for contact in state.contacts if contact.features is not FeaturePair.FLUSH]
    return any(np.linalg.norm(a - b) < SHORT_LEVER_INCH for a, b in combinations(points, 2))


def kind(state: ContactState) -> tuple[object, ...]:
    """What of a state is no number."""
    contacts = [(c.stage, c.features, c.bolt_region, c.nut_region) for c in state.contacts]
    return state.state_class, state.flags, tuple(contacts)


def assert_same(one: ContactState, other: ContactState, factor: float, length_tolerance: float) -> None:
    """``other`` is ``one`` with all lengths multiplied."""
    pose = (one.roll_deg, one.pitch_deg, one.phase_deg)
    angle_tolerance = SHORT_LEVER_TOLERANCE_DEG if has_short_lever(one) else ANGLE_TOLERANCE_DEG
    assert kind(one) == kind(other), pose
    assert turns_deg(other) == pytest.approx(turns_deg(one), abs=angle_tolerance), pose
    assert lengths(other) == pytest.approx([factor * length for length in lengths(one)], abs=length_tolerance), pose
    for a, b in zip(one.poses, other.poses, strict=True):
        np.testing.assert_allclose(a.rotation, b.rotation, rtol=0.0, atol=2.0 * math.radians(angle_tolerance))
    for contact, again in zip(one.contacts, other.contacts, strict=True):
        assert again.normal == pytest.approx(contact.normal, abs=1e-8)


@pytest.mark.parametrize("turns", [-2, -1, 1, 2])
def test_a_whole_turn_of_phase_changes_nothing(turns: int) -> None:
    poses = random_poses(51, 150, tilt_deg=4.0)
    later = poses + np.array([0.0, 0.0, 360.0 * turns])
    for one, other in zip(solve_poses(PAIR, poses), solve_poses(PAIR, later), strict=True):
        assert_same(one, other, 1.0, LENGTH_TOLERANCE_INCH)


def test_a_pose_has_the_same_bits_alone_and_in_a_batch() -> None:
    poses = np.vstack(
        [random_poses(52, 100, tilt_deg=4.0), random_poses(53, 50, tilt_deg=10.0), random_poses(54, 5, tilt_deg=0.0)]
    )
    batch = solve_poses(PAIR, poses)
    backwards = solve_poses(PAIR, poses[::-1])[::-1]
    alone = [solve_pose(PAIR, *pose) for pose in as_poses(poses)]
    assert batch == backwards == alone


def test_the_same_thread_in_millimetres_has_the_same_states() -> None:
    poses = np.vstack([random_poses(55, 150, tilt_deg=4.0), random_poses(56, 100, tilt_deg=10.0, phase_deg=20.0)])
    metric = solve_poses(in_millimetres(PAIR), poses)
    for one, other in zip(solve_poses(PAIR, poses), metric, strict=True):
        assert_same(one, other, MILLIMETRES_PER_INCH, SCALED_LENGTH_TOLERANCE_MM)


def test_a_bolt_that_rests_on_the_surface_cannot_fall_faster_than_its_points_move() -> None:
    poses = random_poses(59, 600, tilt_deg=9.0)
    changes = random_poses(60, 600, tilt_deg=0.2, phase_deg=0.2)
    compared = 0
    for before, after, change in zip(
        solve_poses(PAIR, poses), solve_poses(PAIR, poses + changes), changes, strict=True
    ):
        first = before.contacts[0]
        # The rotation between two poses is no greater than the sum of the angles' changes.
        moved = FARTHEST_INCH * math.radians(float(np.abs(change).sum()))
        # While the point in contact stays over the nut's surface the bolt cannot be lower than to rest on it.
        if first.features is FeaturePair.EDGE_SURFACE and first.nut_margin > 2.0 * moved:
            fall = before.poses[0].translation[2] - after.poses[0].translation[2]
            assert fall <= moved + LENGTH_TOLERANCE_INCH
            compared += 1
    assert compared > 100


@pytest.mark.parametrize("axis", ["roll", "pitch", "phase"])
def test_heights_on_the_surface_change_no_faster_than_the_bolt_s_points_move(axis: str) -> None:
    column = ("roll", "pitch", "phase").index(axis)
    step_deg = 0.01
    moved = FARTHEST_INCH * math.radians(step_deg)
    compared = 0
    for start in as_poses(random_poses(57, 20, tilt_deg=4.0)):
        poses = np.tile(start, (50, 1))
        poses[:, column] += step_deg * np.arange(50)
        for one, next_one in pairwise(solve_poses(PAIR, poses)):
            first, second = one.contacts[0], next_one.contacts[0]
            if {first.features, second.features} == {FeaturePair.EDGE_SURFACE} and min(
                first.nut_margin, second.nut_margin
            ) > 2.0 * moved:
                rise = next_one.poses[0].translation[2] - one.poses[0].translation[2]
                assert abs(rise) <= moved + LENGTH_TOLERANCE_INCH
                compared += 1
    assert compared > 100


@given(roll=st.floats(-10.0, 10.0), pitch=st.floats(-10.0, 10.0), phase=st.floats(-720.0, 720.0))
def test_heights_stay_within_the_parts(roll: float, pitch: float, phase: float) -> None:
    state = solve_pose(PAIR, roll, pitch, phase)
    height = state.poses[0].translation[2]
    tilt = math.acos(min(1.0, math.cos(math.radians(roll)) * math.cos(math.radians(pitch))))
    # The lowest point of the base is no deeper below the origin than the tilt makes it.
    assert -PAIR.thread_pitch < height <= PAIR.fit.bolt_major_diameter / 2 * math.sin(tilt) + LENGTH_TOLERANCE_INCH


@pytest.mark.parametrize("phase", [0.0, 90.0, 180.0, 270.0, 360.0, 720.0, -90.0])
@pytest.mark.parametrize(
    "tilts", [(0.0, 4.0), (4.0, 0.0), (-4.0, 0.0), (0.0, -4.0), (1.0, 1.0), (-1.0, 1.0), (0.1, 0.1)]
)
def test_symmetric_poses_are_solved(tilts: tuple[float, float], phase: float) -> None:
    state = solve_pose(PAIR, *tilts, phase)
    assert len(state.contacts) >= 2 or Flag.NO_SECOND in state.flags


@pytest.mark.parametrize("phase", [0.0, 1.9, 2.3, 90.0, 131.0, 200.0, 357.5])
def test_heights_tend_to_the_level_one_as_the_tilt_vanishes(phase: float) -> None:
    level = solve_pose(PAIR, 0.0, 0.0, phase).poses[0].translation[2]
    # In phase, nearer ones are refused: the overlap of third contacts that tie is not decided.
    for tilt_deg in (1e-2, 1e-3, 5e-4 if phase == 0.0 else 1e-4):
        height = solve_pose(PAIR, tilt_deg, 0.5 * tilt_deg, phase).poses[0].translation[2]
        # A tilt moves no point of the bolt farther than this; over a flank, which is 60 deg steep, that lifts it by
        # up to sqrt(3) times more, and as much by the shift to the side.
        assert abs(height - level) <= 3.0 * FARTHEST_INCH * math.radians(1.5 * tilt_deg)


@pytest.mark.parametrize("root_form", RootForm)
def test_every_pair_of_the_catalogue_has_states(root_form: RootForm) -> None:
    states = solve_poses(quarter_twenty_unc(root_form), random_poses(58, 50, tilt_deg=4.0))
    assert all(state.contacts for state in states)
