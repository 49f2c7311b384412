from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.first_height import first_height
from oracle.lift import least_lift
from oracle.overlap import overlap_components
from oracle.pose import pose_rotation
from oracle.profile import bolt_profile, nut_profile, radius, thread_gap
from oracle.turn import contact_components_along_turn, turned_pose
from threadstate.thread.catalogue import quarter_twenty_unc

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()
BOLT, NUT = bolt_profile(PAIR), nut_profile(PAIR)
ABOVE_INCH = np.array([0.0, 0.0, 1.0])

CHECKED_HEIGHTS_INCH = [
    ((4, 0, 185), 0.008681193158, (-0.010820115, 0.123674429, 0.0)),
    ((0, -4, 0), -0.003070141635, (-0.025731627, -0.121745498, -0.004869472)),
    ((-4, 0, 131), 0.002830893654, (-0.092371859, 0.044554317, 0.0)),
    ((1, -2, 10), 0.001127350432, (0.048928846, -0.114408383, 0.0)),
    ((0, 3, 250), 0.004929945576, (-0.097292174, -0.064694647, 0.0)),
]
"""Pose in degrees, height and point of the first contact: method, section 7."""

CHECKED_TURNS = [
    ((-4, 0, 131), 1.678293607, (0.104932854, -0.045557091, 0.0), 4.586498646, (-0.109348954, -0.006112413, 0.0)),
    (
        (1, -2, 10),
        1.697903289,
        (0.063357172, 0.075488949, 0.0),
        1.216002530,
        (-0.003085933, -0.124432977, -0.003361432),
    ),
    ((0, 3, 250), 2.474133102, (0.080957333, 0.058962653, 0.0), 4.828627189, (0.050144651, -0.113803892, 0.0)),
]
"""Pose, second turn and its contact, third turn and its contact: method, section 7. Each CP0 is on the nut's edge."""


def nut_edge_tangent(point: Floats) -> Floats:
    """Counter-clockwise tangent of the nut's top outline, by differences."""
    azimuth = math.atan2(point[1], point[0])

    def at(a: float) -> Floats:
        r = radius(-PAIR.thread_pitch * a / (2 * math.pi), NUT)
        return np.array([r * math.cos(a), r * math.sin(a), 0.0])

    difference = at(azimuth + 1e-6) - at(azimuth - 1e-6)
    return np.asarray(difference / np.linalg.norm(difference))


@pytest.mark.parametrize(
    ("profile", "s", "expected"),
    [
        (BOLT, 0.005, 0.116860254037844),
        (BOLT, 0.03, 0.099539745962156),
        (NUT, 0.03, 0.100165616729453),
        (BOLT, 0.0125, 0.12445),
        (NUT, 0.0375, 0.098),
        (NUT, 0.05, 0.10875),
    ],
)
def test_profile_has_the_values_of_the_method(profile: Floats, s: float, expected: float) -> None:
    assert radius(s, profile) == pytest.approx(expected, abs=1e-15)
    assert radius(s - 3 * PAIR.thread_pitch, profile) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize(("pose", "height", "point"), CHECKED_HEIGHTS_INCH)
def test_first_height_has_the_values_of_the_method(
    pose: tuple[float, float, float], height: float, point: tuple[float, float, float]
) -> None:
    found = first_height(PAIR, *pose)
    assert found.height == pytest.approx(height, abs=1e-12)
    # A smooth maximum polished by its value is placed only to the square root of round-off.
    assert found.point == pytest.approx(point, abs=1e-8)


def test_level_bolt_out_of_phase_lies_on_the_surface() -> None:
    assert first_height(PAIR, 0.0, 0.0, 120.0).height == 0.0


def test_level_bolt_in_phase_sinks_until_the_flanks_meet() -> None:
    half_clearance = (PAIR.fit.nut_pitch_diameter - PAIR.fit.bolt_pitch_diameter) / 2
    found = first_height(PAIR, 0.0, 0.0, 0.0)
    assert found.height == pytest.approx(-half_clearance * math.tan(math.radians(30.0)), abs=1e-14)


def test_thread_meets_thread_first_in_some_poses() -> None:
    pose = (3.7329537598678675, 2.3147751774318355, 350.1907642991677)
    found = first_height(PAIR, *pose)
    assert found.features == "thread-thread"
    # Halfway between the highest edge contact and the contact found, one point is strictly inside both threads.
    height = 0.5 * (found.height + max(found.by_feature[:2]))
    point = np.array(found.point) - 0.5 * (found.height - height) * ABOVE_INCH
    in_bolt = pose_rotation(*pose).T @ (point - height * ABOVE_INCH)
    assert thread_gap(in_bolt[0], in_bolt[1], in_bolt[2], BOLT) > 1e-5
    assert in_bolt[2] > 0.0
    assert thread_gap(point[0], point[1], point[2], NUT) < -1e-5
    assert point[2] < 0.0


@pytest.mark.parametrize(("pose", "lambda_deg", "second", "mu_deg", "third"), CHECKED_TURNS)
def test_turns_of_the_method_end_at_the_first_distinct_component(
    pose: tuple[float, float, float],
    lambda_deg: float,
    second: tuple[float, float, float],
    mu_deg: float,
    third: tuple[float, float, float],
) -> None:
    first = first_height(PAIR, *pose)
    rotation, translation = pose_rotation(*pose), first.height * ABOVE_INCH
    cp0, cp1 = np.array(first.point), np.array(second)
    turns = [(cp0, nut_edge_tangent(cp0), -lambda_deg, cp0.reshape(1, 3), second)]
    rotation_2, translation_2 = turned_pose(rotation, translation, *turns[0][:3])
    axis = cp1 - cp0
    lowering = -math.copysign(1.0, np.cross(axis, translation_2 - cp0)[2])
    turns.append((cp0, axis, lowering * mu_deg, np.array([cp0, cp1]), third))
    for (point, direction, turn_deg, known, expected), (r, t) in zip(
        turns, [(rotation, translation), (rotation_2, translation_2)], strict=True
    ):
        assert contact_components_along_turn(PAIR, r, t, point, direction, turn_deg, known, steps=20) is None
        past = turn_deg + math.copysign(2e-3, turn_deg)
        seen = contact_components_along_turn(PAIR, r, t, point, direction, past, known, steps=4)
        assert seen is not None
        assert abs(seen.turn_deg) > abs(turn_deg)
        assert np.linalg.norm(np.array(seen.point) - expected) < 3e-4


@pytest.mark.parametrize("pose", [case[0] for case in CHECKED_HEIGHTS_INCH])
@pytest.mark.parametrize("depth_inch", [1e-6, 1e-4, 2e-3])
def test_lift_undoes_a_sinking(pose: tuple[float, float, float], depth_inch: float) -> None:
    height = first_height(PAIR, *pose).height
    assert least_lift(PAIR, pose_rotation(*pose), height * ABOVE_INCH) < 1e-12
    lowered = least_lift(PAIR, pose_rotation(*pose), (height - depth_inch) * ABOVE_INCH)
    assert lowered == pytest.approx(depth_inch, abs=1e-10)


@pytest.mark.parametrize("pose", [case[0] for case in CHECKED_HEIGHTS_INCH])
def test_overlap_begins_at_the_first_height(pose: tuple[float, float, float]) -> None:
    first = first_height(PAIR, *pose)
    rotation = pose_rotation(*pose)
    assert overlap_components(PAIR, rotation, (first.height + 1e-9) * ABOVE_INCH) == []
    (component,) = overlap_components(PAIR, rotation, (first.height - 2e-6) * ABOVE_INCH)
    assert 1e-7 < component.depth < 4e-6
    assert np.linalg.norm(np.array(component.point) - first.point) < 1e-3


def test_a_level_bolt_pressed_in_out_of_phase_overlaps_in_one_piece() -> None:
    (component,) = overlap_components(PAIR, pose_rotation(0.0, 0.0, 180.0), -1e-3 * ABOVE_INCH)
    assert component.depth == pytest.approx(1e-3, abs=1e-4)
    assert component.extent > PAIR.nominal_diameter / 2


def test_a_bolt_tilted_too_far_for_the_rays_is_refused() -> None:
    with pytest.raises(ValueError, match="valid: at most 25"):
        overlap_components(PAIR, pose_rotation(30.0, 0.0, 0.0), ABOVE_INCH)
