"""Contacts that appear together within a wide tolerance: the earliest says when, and the state is checked as any."""

from __future__ import annotations

import numpy as np
import pytest

from oracle.first_height import first_height
from oracle.lift import least_lift
from threadstate.state.model import Flag
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
WIDE = SolveOptions(tie_tolerance=1e-4)
ROUND_OFF_INCH = 1e-15
ROUND_OFF_DEG = 1e-10
LIFT_TOLERANCE_INCH = 1e-10

FIRST = [
    (-1.6474823024400242, -8.185046509755987, 353.1598648645002),
    (-4.966808348544548, 5.4804209519529845, 263.37752705015004),
]
SECOND = [
    (-8.668218765669184, -5.910260262549347, 196.07582444848808),
    (-0.2714921155578516, -4.786684884223048, 10.591438147046684),
    (-7.156828582205647, -6.617747750934953, 119.2079672514643),
]
THIRD = [
    (-0.5872479021080874, 7.035192015394042, 253.27760122775214),
    (3.9528106600783737, 6.945647552411712, 253.08581840588883),
    (4.39591034514557, 7.48897332937014, 253.2535497022545),
    (-1.9378798891845088, 2.928924478525916, 252.79094054161715),
]
"""Roll, pitch, phase (deg): two places far apart are met within the wide tolerance in that stage."""


@pytest.mark.parametrize("pose", FIRST)
def test_the_height_of_a_tie_is_that_of_its_earliest_contact(pose: tuple[float, float, float]) -> None:
    tied, exact = solve_pose(PAIR, *pose, WIDE), solve_pose(PAIR, *pose)
    assert Flag.TIE in tied.flags
    assert Flag.TIE not in exact.flags
    assert tied.poses[0].translation[2] == pytest.approx(exact.poses[0].translation[2], abs=ROUND_OFF_INCH)


@pytest.mark.parametrize("pose", SECOND)
def test_the_second_turn_of_a_tie_is_that_of_its_earliest_contact(pose: tuple[float, float, float]) -> None:
    tied, exact = solve_pose(PAIR, *pose, WIDE), solve_pose(PAIR, *pose)
    assert Flag.TIE in tied.flags
    assert Flag.TIE not in exact.flags
    assert tied.lambda_deg == pytest.approx(exact.lambda_deg, abs=ROUND_OFF_DEG)
    assert [contact.stage for contact in tied.contacts] == [1, 2, 3]


@pytest.mark.parametrize("pose", THIRD)
def test_the_third_turn_of_a_tie_is_that_of_its_earliest_contact(pose: tuple[float, float, float]) -> None:
    tied, exact = solve_pose(PAIR, *pose, WIDE), solve_pose(PAIR, *pose)
    assert Flag.TIE in tied.flags
    assert tied.mu_deg == pytest.approx(exact.mu_deg, abs=ROUND_OFF_DEG)
    assert len(tied.contacts) > len(exact.contacts)


EMBEDDED = [
    (-8.668218765669184, -5.910260262549347, 196.07582444848808),
    (-7.144625090092896, -4.253164029201628, 143.52866178453286),
]
"""The same, in the second stage; by then the bolt has rolled into the nut beside its first contact."""


@pytest.mark.parametrize("pose", EMBEDDED)
def test_a_third_contact_that_comes_with_the_second_has_its_embedment(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose, WIDE)
    assert (state.mu_deg, state.drop) == (0.0, 0.0)
    end = state.poses[2]
    assert end == state.poses[1]
    lift = least_lift(PAIR, np.array(end.rotation), np.array(end.translation))
    assert lift > 1e-6
    assert state.embedment == pytest.approx(lift, abs=LIFT_TOLERANCE_INCH)


THREE = [
    (0.0009356254644120507, -0.0015889308040763594, -0.1484847635907487),
    (0.00034094690857931976, -0.0006007942552865823, -2.1004545559649275),
]
"""Nearly level and in phase: three places are met within the wide tolerance in the first stage."""
HEIGHT_TOLERANCE_INCH = 1e-9


@pytest.mark.parametrize("pose", THREE)
def test_three_first_contacts_that_tie_leave_nothing_to_turn(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose, WIDE)
    assert Flag.TIE in state.flags
    assert (state.lambda_deg, state.mu_deg, state.drop) == (0.0, 0.0, 0.0)
    assert state.poses[0] == state.poses[1] == state.poses[2]
    assert {contact.stage for contact in state.contacts} == {1, 2, 3}
    points = np.array([contact.point for contact in state.contacts])
    apart = np.linalg.norm(points[:, None] - points[None, :], axis=2)[np.triu_indices(len(points), 1)]
    assert apart.min() > 1e-6
    height = first_height(PAIR, *pose).height
    assert state.poses[0].translation[2] == pytest.approx(height, abs=HEIGHT_TOLERANCE_INCH)
