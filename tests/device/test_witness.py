"""Settled states beside a brute force: dense samples of the boundaries, and programs with differences for slopes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from studies.settle.check import LOWER, OVERLAP, RESIDUAL, check, held_bolt, place_of
from studies.settle.study import CAME_BACK
from threadstate.device.document import device_from_document
from threadstate.device.model import Device, Outcome, SettledFlag, SettledState, default_device
from threadstate.device.settle import settle_pose, settle_poses
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
DEVICE = default_device()
PUSH = DEVICE.push


@pytest.fixture(scope="module")
def states() -> list[SettledState]:
    """Random poses, and some in the window, where threads touch."""
    rng = np.random.default_rng(21)
    anywhere = rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (8, 3))
    window = rng.uniform([-3.0, -3.0, -10.0], [3.0, 3.0, 10.0], (6, 3))
    found = settle_poses(UNC, np.vstack([anywhere, window, [(0.0, 0.0, 0.0), (1.0, 0.5, 120.0)]]))
    assert [state.outcome for state in found] == [Outcome.SETTLED] * len(found)
    return found


def test_samples_touch_forces_balance_and_no_place_beside_is_lower(states: list[SettledState]) -> None:
    rng = np.random.default_rng(22)
    for state in states:
        checked = check(UNC, DEVICE, state, 40, rng)
        assert checked.faults == ()
        assert abs(checked.overlap) < OVERLAP
        assert checked.least_force > 0.0
        assert checked.residual < RESIDUAL


def test_the_check_sees_a_state_that_is_none(states: list[SettledState]) -> None:
    """Lowered by 2e-8 r it overlaps; shifted by 1e-3 r nothing balances, and places beside it are lower."""
    rng = np.random.default_rng(23)
    state = next(state for state in states if SettledFlag.FLUSH not in state.flags)
    assert state.pose is not None
    assert state.shift is not None
    x, y, z = state.pose.translation
    sx, sy, sz = state.shift
    down = 2e-8 * R
    low = replace(state, pose=replace(state.pose, translation=(x, y, z - down)), shift=(sx, sy, sz - down))
    assert any("overlap" in fault for fault in check(UNC, DEVICE, low, 0, rng).faults)
    aside = 1e-3 * R
    shifted = replace(state, pose=replace(state.pose, translation=(x + aside, y, z)), shift=(sx + aside, sy, sz))
    held = held_bolt(UNC, DEVICE, shifted)
    _, height = held.potential(*place_of(shifted))
    up = height - z
    shifted = replace(
        shifted, pose=replace(state.pose, translation=(x + aside, y, height)), shift=(sx + aside, sy, sz + up)
    )
    faults = check(UNC, DEVICE, shifted, 100, rng).faults
    assert any("unbalanced" in fault for fault in faults)
    assert any("lower" in fault for fault in faults)


AXIAL = replace(DEVICE, stiffness=(*DEVICE.stiffness[:5], (0.0, 0.0, 0.0, 0.0, 0.0, 50.0)))
"""With 50 N/mm along the nut's axis."""


def test_lower_places_beyond_a_barrier_are_those_of_another_minimum() -> None:
    """This bolt is free from 4e-4 r on where its potential is lower; between it is by 3e-7 F r higher."""
    pair = pair_by_designation("1/4-20 BSW-medium/normal")
    state = settle_pose(pair, -2.155576010799126, -0.8588533707490544, -13.437054550662593, AXIAL)
    rng = np.random.default_rng(27)
    checked = check(pair, AXIAL, state, 1000, rng)
    assert checked.beyond > 0
    assert checked.faults == ()


def test_a_device_that_is_stiff_along_the_axis_has_places_of_no_lower_potential() -> None:
    """Pulled back by nearly the push, the bolt is near the height at which its potential is least of all."""
    pair = pair_by_designation("M20x2.5-6g/6H")
    state = settle_pose(pair, -2.34289584492275, -1.1790626220823812, -2.550111940999405, AXIAL)
    assert state.contacts[0].force[2] < 1e-3 * PUSH
    assert check(pair, AXIAL, state, 200, np.random.default_rng(28)).faults == ()


SLOW = [
    ("1/4-20 UNC", 0.0, (-1.7579298171557776, -0.667889104691983, -14.249032791488725)),
    ("1/4-20 UNC-2A/2B at minimum material", 0.0, (-1.2240987410536048, 1.4621506014225796, -15.512103253168576)),
    ("1/4-20 UNC", 10.0, (-3.998390920053353, 3.1800178782254616, -13.423299144502908)),
    ("M20x2.5-6g/6H", 10.0, (2.5905756451209356, 1.1503173194500302, -1.2728461176352506)),
]
"""Pair, height of the centre (mm) and command. Two contacts press against each other, and the potential is convex along
them alone; it is convex along none; two maxima of an edge are near each other, in the last two.
"""


@pytest.mark.parametrize(("name", "centre", "pose"), SLOW)
def test_bolts_between_opposed_contacts_and_beside_two_maxima_settle(
    name: str, centre: float, pose: tuple[float, float, float]
) -> None:
    pair, device = pair_by_designation(name), replace(DEVICE, centre=centre)
    state = settle_pose(pair, *pose, device)
    assert state.outcome is Outcome.SETTLED
    assert check(pair, device, state, 40, np.random.default_rng(29)).faults == ()


def test_the_brute_force_from_beside_comes_back(states: list[SettledState]) -> None:
    rng = np.random.default_rng(24)
    for state in states[:3]:
        held = held_bolt(UNC, DEVICE, state)
        place, height = place_of(state)
        value, _ = held.potential(place, height)
        way = rng.standard_normal(5) * (held.scale > 0.0)
        beside = place + 1e-3 * R / np.linalg.norm(way) * way * held.scale
        found, up, lowest = held.lowest_by_programs(beside, height, 2e-3 * R)
        assert value - LOWER * PUSH * R < lowest < value + CAME_BACK * PUSH * R
        assert np.abs(found - place).max() < 1e-4
        assert up == pytest.approx(height, abs=1e-5 * R)


@pytest.mark.parametrize(
    ("changes", "pose"),
    [
        # A thread overlaps far from both edges, where phi is not curved downwards between azimuths of the grid.
        ({"centre": 10.0}, (-2.666439695241727, 3.462352994878289, -3.8871175981265838)),
        # A ridge goes from one edge to the other between two azimuths.
        ({"k_tilt": 5000.0}, (0.6743914549129135, -3.857426925949495, 23.472914328040616)),
        ({"centre": 10.0}, (1.5609308178094052, -2.776247934846022, 0.8886324966830593)),
        # Opposed contacts carry a thousand times the first part of the push.
        ({}, (-2.9750855355988373, -3.8456127419519097, -2.1992482445151387)),
        # A fall begins so slowly that the bolt hardly moves.
        ({"centre": -10.0}, (1.2898333143465273, -0.852635347461975, -9.421857849259325)),
    ],
)
def test_poses_that_were_wrong_or_undecided(changes: dict[str, object], pose: tuple[float, float, float]) -> None:
    device: Device = device_from_document({"unit": "mm", **changes})
    state = settle_pose(UNC, *pose, device)
    assert state.outcome is Outcome.SETTLED
    assert check(UNC, device, state, 20, np.random.default_rng(25)).faults == ()
