"""Settled states beside a brute force: dense samples of the boundaries, and a search without derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.pose import pose_rotation
from oracle.rest import HeldBolt, lowest_near
from threadstate.device.model import Outcome, SettledState, default_device
from threadstate.device.settle import settle_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
PUSH = default_device().push
AS_ANGLE = np.array([1.0 / R, 1.0 / R, 1.0, 1.0])
"""Lengths become angles over the radius, and stay shifts."""


def held_bolt(state: SettledState) -> HeldBolt:
    """The default device at a state's command, its numbers as declared, over 25.4."""
    command = pose_rotation(state.roll_deg, state.pitch_deg, state.phase_deg)
    return HeldBolt(UNC, command, k_lateral=20.0 * 25.4, k_tilt=500.0 / 25.4, centre=0.0, push=PUSH)


def place_of(state: SettledState) -> tuple[Floats, float, float]:
    """The two angles and the shift across, the height of the origin, and the potential."""
    assert state.pose is not None
    assert state.shift is not None
    assert state.rotation_deg is not None
    assert state.elastic_energy is not None
    height = state.pose.translation[2]
    place = np.array([*np.radians(state.rotation_deg[:2]), *state.shift[:2]])
    return place, height, state.elastic_energy + PUSH * height


@pytest.fixture(scope="module")
def states() -> list[SettledState]:
    """Random poses, and some in the window, where threads touch."""
    rng = np.random.default_rng(21)
    anywhere = rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (8, 3))
    window = rng.uniform([-3.0, -3.0, -10.0], [3.0, 3.0, 10.0], (6, 3))
    found = settle_poses(UNC, np.vstack([anywhere, window, [(0.0, 0.0, 0.0), (1.0, 0.5, 120.0)]]))
    assert [state.outcome for state in found] == [Outcome.SETTLED] * len(found)
    return found


def test_samples_touch_where_the_solver_says_and_do_not_overlap(states: list[SettledState]) -> None:
    for state in states:
        place, height, _ = place_of(state)
        assert held_bolt(state).height(place, height, with_thread=True) == pytest.approx(height, abs=1e-10)


def test_no_feasible_direction_lowers_the_potential(states: list[SettledState]) -> None:
    """40 random directions each, of steps of 1e-5 to 1e-3 nominal radii, at the height at which samples touch."""
    rng = np.random.default_rng(22)
    for state in states:
        place, height, lowest = place_of(state)
        held = held_bolt(state)
        for _ in range(40):
            direction = rng.standard_normal(4)
            step = 10.0 ** rng.uniform(-5.0, -3.0) * R * direction / np.linalg.norm(direction) * AS_ANGLE
            value, _ = held.potential(place + step, height, PUSH, with_thread=False)
            assert value > lowest - 1e-10 * PUSH * R


def test_a_search_from_beside_comes_back_and_finds_nothing_lower(states: list[SettledState]) -> None:
    rng = np.random.default_rng(23)
    for state in states[:1]:
        place, height, lowest = place_of(state)
        direction = rng.standard_normal(4)
        beside = place + 5e-4 * R * direction / np.linalg.norm(direction) * AS_ANGLE
        _, _, value = lowest_near(held_bolt(state), beside, height, PUSH, 1e-3 * R, 1e-4 * R, with_thread=False)
        assert value > lowest - 1e-10 * PUSH * R
        assert value < lowest + 1e-5 * PUSH * R
