"""Drop, embedment and pivot offset against their definitions (method, section 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from oracle.lift import least_lift
from tests.contact.samples import random_poses
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

pytestmark = pytest.mark.slow

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
    near = random_poses(41, 100, tilt_deg=4.0, phase_deg=20.0)
    poses = np.vstack([near, random_poses(42, 100, tilt_deg=4.0), random_poses(43, 50, tilt_deg=10.0)])
    return solve_poses(PAIR, poses)


@pytest.fixture(scope="module")
def embedded(states: list[ContactState]) -> Embedded:
    third = [state for state in states if state.embedment is not None]
    return Embedded([s for s in third if s.embedment != 0.0], [s for s in third if s.embedment == 0.0][:20])


def oracle_lift(state: ContactState) -> float:
    pose = state.poses[2]
    return least_lift(PAIR, np.array(pose.rotation), np.array(pose.translation))


def test_embedment_is_the_least_lift(embedded: Embedded) -> None:
    assert len(embedded.overlapping) >= 50
    for state in embedded.overlapping:
        assert state.embedment == pytest.approx(oracle_lift(state), abs=LIFT_TOLERANCE_INCH), state.poses[2]


def test_threads_that_part_below_an_edge_after_it_are_seen_by_both() -> None:
    """4e-5 in below the nut's edge threads overlap up to 1.1e-8 in above the height at which the edge ends to."""
    pair = pair_by_designation("1/4-20 BSW")
    state = solve_pose(pair, 0.35285675037654496, -2.1566974739891975, -2.413218975998657)
    pose = state.poses[2]
    lift = least_lift(pair, np.array(pose.rotation), np.array(pose.translation))
    assert lift == pytest.approx(state.embedment, abs=LENGTH_TOLERANCE_INCH)
    assert state.embedment == pytest.approx(0.000829501024125, abs=LENGTH_TOLERANCE_INCH)


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
    """More boxes along the edge stay undecided than the list holds: the lift itself decides."""
    (state,) = solve_poses(PAIR, [(-1.0, 4.0, 3.297539792023599)])
    assert state.embedment == pytest.approx(oracle_lift(state), abs=LIFT_TOLERANCE_INCH)


def test_a_bolt_that_would_meet_the_thread_again_higher_up_is_free_before() -> None:
    """Beside the clearance window a bolt is free between the nut's flanks; the last touch is that of a greater lift."""
    rng = np.random.default_rng(47)
    beside = -2.2863369352595844 + rng.uniform(1e-3, 0.05, 150) * rng.choice([-1.0, 1.0], 150)
    poses = np.column_stack([rng.uniform(-0.2, 0.2, (150, 2)), beside])
    pressed_again = (0.020245637584444028, 0.018515298030596795, -2.2863369352595844)
    third = [state for state in solve_poses(PAIR, np.vstack([pressed_again, poses])) if state.embedment]
    assert len(third) >= 10
    for state in third:
        assert state.embedment == pytest.approx(oracle_lift(state), abs=LIFT_TOLERANCE_INCH), state.poses[2]
    assert third[0].embedment == pytest.approx(1.5e-8, abs=1e-9), "not the 1.74e-4 in of the last touch"


def test_an_overlap_too_thin_for_witnesses_is_followed_by_its_touches() -> None:
    """Two edges cross and pass along each other, 5e-9 in deep, for 1.4e-4 in of lift."""
    (state,) = solve_poses(PAIR, [(0.17933066017060556, -0.024903597967867203, -2.2863369352595844)])
    assert state.embedment == pytest.approx(2.02e-4, abs=1e-6)
    for share in np.linspace(0.3, 0.99, 12):
        assert 0.0 < deepest_edge_point(state, share * state.embedment) < 1e-8
    for share in np.linspace(1.0 + 1e-6, 1.5, 6):
        assert deepest_edge_point(state, share * state.embedment) < 0.0


def test_two_edges_that_cross_hold_the_bolt_though_they_overlap_by_less_than_a_nanoinch() -> None:
    """The embedment jumps once, where the gap between two overlaps closes that are 1e-11 in deep there."""
    phases = 356.2205 + np.arange(-10, 11) * 1e-5
    states = solve_poses(PAIR, [(-3.0, -4.0, phase) for phase in phases])
    lifts = np.array([state.embedment or 0.0 for state in states])
    assert (np.diff(lifts) > 0.0).all()
    (jump,) = np.flatnonzero(np.diff(lifts) > 1e-6)
    for state, lift in zip(states[:jump], lifts[:jump], strict=True):
        assert deepest_edge_point(state, lift + 1e-10) < 0.0
    for state, lift in zip(states[jump + 2 :: 4], lifts[jump + 2 :: 4], strict=True):
        for share in np.linspace(0.1, 0.9, 9):
            assert deepest_edge_point(state, share * lift) > 0.0


def deepest_edge_point(state: ContactState, lift_inch: float) -> float:
    """How far inside the nut the deepest point of the bolt's edge is, found by sampling ever more closely."""
    rotation = np.array(state.poses[2].rotation)
    origin = np.array(state.poses[2].translation) + np.array([0.0, 0.0, lift_inch])
    bolt_radius, nut_radius = np.vectorize(PAIR.bolt.radius), np.vectorize(PAIR.nut.radius)
    turn = 2.0 * np.pi / PAIR.thread_pitch
    low, high = 0.0, 2.0 * np.pi
    depth = np.zeros(1)
    for samples in (40001, 4001, 4001, 4001):
        theta = np.linspace(low, high, samples)
        r = bolt_radius(-theta / turn)
        x, y, z = rotation @ np.array([r * np.cos(theta), r * np.sin(theta), 0.0 * r]) + origin[:, None]
        depth = np.minimum(np.hypot(x, y) - nut_radius(z - np.arctan2(y, x) / turn), -z)
        middle, width = theta[np.argmax(depth)], 4.0 * (high - low) / samples
        low, high = middle - width, middle + width
    return float(depth.max())
