"""A bolt in phase that is all but level: contacts and turns go to limits in the direction of its tilt."""

from __future__ import annotations

import math

import pytest

from threadstate.state.model import Contact, FeaturePair
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
TIMES = 10.0
TURN_TOLERANCE, PLACE_TOLERANCE = 1e-5, 1e-5
"""How far turns over the tilt, and places over the nominal diameter, are from their limits: an earliest one of several
that tie within 5e-10 deg may be another one."""

CASES = {
    "some 1e-7 deg": (1.244773113e-7, 1.317139252e-7, -0.588257134),
    "some 1e-8 deg": (2.63875271e-9, 3.752628839e-8, -1.95510526),
    "a second contact that doubles hide": (-6.404057841312052e-09, 2.6224387281405916e-08, -0.13148931561248065),
    "two of them": (5.3184709903180835e-08, 2.6792007542110766e-08, -1.7614011092283082),
    "the threads touch first, between two azimuths of the search": (5.3185e-6, 2.6792e-6, -1.76140111),
}

CASES_OF_SINGLE_CONTACTS = {
    "the overlap of threads that grows from the first contact": (1.0490068e-6, 6.767491838e-7, -1.7614021092),
    "the same, at another phase": (1.1242593331918938e-06, 7.948523509432825e-07, -1.0363042377285159),
    "heights of two contacts that differ by less than the tolerance of a tie": (-9.816e-10, -1e-9, 91.84079877),
    "the same, with a third contact": (-1e-9, -6.0527e-10, 108.247735254),
    "a strip that ties within the tolerance": (-4.5983697998338915e-10, 2.1016230167199715e-09, 2.1959579326056136),
}


@pytest.mark.parametrize("pose_deg", CASES.values(), ids=CASES.keys())
def test_a_tilt_ten_times_as_large_has_the_same_first_contact_and_ten_times_the_turn(
    pose_deg: tuple[float, float, float],
) -> None:
    roll, pitch, phase = pose_deg
    near, far = (solve_pose(PAIR, factor * roll, factor * pitch, phase) for factor in (1.0, TIMES))
    assert near.lambda_deg is not None
    assert far.lambda_deg == pytest.approx(TIMES * near.lambda_deg, rel=TURN_TOLERANCE)
    assert_same(near.contacts[0], far.contacts[0])


@pytest.mark.parametrize("pose_deg", CASES_OF_SINGLE_CONTACTS.values(), ids=CASES_OF_SINGLE_CONTACTS.keys())
def test_a_tilt_ten_times_as_large_has_the_same_contacts_where_none_tie(pose_deg: tuple[float, float, float]) -> None:
    roll, pitch, phase = pose_deg
    near, far = (solve_pose(PAIR, factor * roll, factor * pitch, phase) for factor in (1.0, TIMES))
    assert near.lambda_deg is not None
    assert far.lambda_deg == pytest.approx(TIMES * near.lambda_deg, rel=TURN_TOLERANCE)
    for one, other in zip(near.contacts, far.contacts, strict=True):
        assert_same(one, other)


def assert_same(one: Contact, other: Contact) -> None:
    assert one.features is other.features
    assert math.dist(one.point, other.point) < PLACE_TOLERANCE * PAIR.nominal_diameter


def test_of_the_threads_first_contact_only_an_overlap_that_an_edge_enters_tells() -> None:
    state = solve_pose(PAIR, *CASES["the threads touch first, between two azimuths of the search"])
    assert state.contacts[0].features is FeaturePair.THREAD_THREAD
