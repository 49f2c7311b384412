"""Drop, embedment and pivot offset against their definitions (method, section 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from tests.contact.samples import random_poses
from tests.oracle.lift import least_lift
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

LENGTH_TOLERANCE_INCH = 1e-12
LIFT_TOLERANCE_INCH = 1e-10
"""The brute force is good to 1e-10 of the thread pitch or to 1e-12 in, its own steps."""

PAIR = quarter_twenty_unc()


@dataclass(frozen=True)
class Embedded:
    """Third poses that overlap, and some that do not."""

    overlapping: list[ContactState]
    free: list[ContactState]


@pytest.fixture(scope="module")
def states() -> list[ContactState]:
    near = random_poses(41, 300, tilt_deg=4.0, phase_deg=20.0)
    poses = np.vstack([near, random_poses(42, 300, tilt_deg=4.0), random_poses(43, 150, tilt_deg=10.0)])
    return solve_poses(PAIR, poses)


@pytest.fixture(scope="module")
def embedded(states: list[ContactState]) -> Embedded:
    third = [state for state in states if state.embedment is not None]
    return Embedded([s for s in third if s.embedment != 0.0], [s for s in third if s.embedment == 0.0][:40])


def oracle_lift(state: ContactState) -> float:
    pose = state.poses[2]
    return least_lift(PAIR, np.array(pose.rotation), np.array(pose.translation))


def test_embedment_is_the_least_lift(embedded: Embedded) -> None:
    assert len(embedded.overlapping) >= 150
    for state in embedded.overlapping:
        assert state.embedment == pytest.approx(oracle_lift(state), abs=LIFT_TOLERANCE_INCH), state.poses[2]


def test_without_embedment_the_solids_do_not_overlap(embedded: Embedded) -> None:
    assert len(embedded.free) >= 20
    none_inch = SolveOptions().embedment_tolerance * PAIR.thread_pitch
    for state in embedded.free:
        assert oracle_lift(state) <= none_inch, state.poses[2]


def test_drop_is_how_far_the_origin_sinks_in_the_third_stage(states: list[ContactState]) -> None:
    dropped = [state for state in states if state.drop is not None]
    assert dropped
    for state in dropped:
        sunk = state.poses[1].translation[2] - state.poses[2].translation[2]
        assert state.drop == pytest.approx(sunk, abs=LENGTH_TOLERANCE_INCH)
        assert sunk > 0.0


def test_pivot_offset_is_the_distance_of_the_origin_from_the_axis(states: list[ContactState]) -> None:
    pivoted = [state for state in states if state.pivot_offset is not None]
    assert pivoted
    for state in pivoted:
        cp0, cp1 = np.array(state.contacts[0].point), np.array(state.contacts[1].point)
        axis = (cp1 - cp0) / np.linalg.norm(cp1 - cp0)
        origin = np.array(state.poses[1].translation) - cp0
        distance = np.linalg.norm(origin - (origin @ axis) * axis)
        assert state.pivot_offset == pytest.approx(float(distance), abs=LENGTH_TOLERANCE_INCH)


def test_lengths_are_absent_where_their_stage_was_not_reached(states: list[ContactState]) -> None:
    for state in states:
        assert (state.pivot_offset is None) == (len(state.poses) < 2 or state.contacts[1].features.value == "flush")
        assert (state.drop is None) == (state.embedment is None) == (len(state.poses) < 3)
        assert (state.lambda_deg is None) == (len(state.poses) < 2)
        assert (state.mu_deg is None) == (len(state.poses) < 3)


def test_a_third_pose_along_which_the_edge_nearly_lies_has_an_embedment() -> None:
    """So many boxes along the edge stay open that they are more than are kept: the lift itself has to say."""
    (state,) = solve_poses(PAIR, [(-1.0, 4.0, 3.297539792023599)])
    assert state.embedment == pytest.approx(oracle_lift(state), abs=LIFT_TOLERANCE_INCH)
