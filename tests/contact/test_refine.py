"""Refined contacts: what settles, and what stays as it was found."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest

from tests.contact.samples import Floats
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _refine_kernel as refine
from threadstate.contact import _stage_kernel as stage
from threadstate.contact import _wide_kernel as wide
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

PAIR = quarter_twenty_unc()
POSE_DEG = (1.0, -2.0, 10.0)
TIME = 0.01
"""A height (in) that the bolt comes down from its start to the first contact."""


class Found(NamedTuple):
    """What was returned, the contact, the pose in sums of two doubles, and what is known of the contact."""

    time: float
    settles: bool
    contact: Floats
    pose: Floats
    refined: Floats


def first_contact() -> tuple[Floats, Floats]:
    """The first contact of a pose as a search lists it, and the record."""
    record = solve_records(PAIR, SolveOptions(), np.array([POSE_DEG]))[0]
    x, y, z = record[rk.O_CONTACT + rk.P_POINT : rk.O_CONTACT + rk.P_POINT + 3]
    bolt_x, bolt_y = record[rk.O_CONTACT + rk.P_BOLT_POINT : rk.O_CONTACT + rk.P_BOLT_POINT + 2]
    pair = record[rk.O_CONTACT + rk.P_PAIR]
    return np.array([TIME, pair, math.atan2(bolt_y, bolt_x), math.atan2(y, x), x, y, z]), record


def refined_first(contact: Floats, record: Floats, *, alone: bool = True, as_found: bool = True) -> Found:
    """A first contact refined, from a start ``TIME`` above it."""
    start, moved = np.empty((12, 2)), np.empty((12, 2))
    known = np.empty((refine.REFINED_SIZE, 2))
    refine.set_first_pose(*(math.radians(angle) for angle in POSE_DEG), record[rk.O_POSE + 11] + TIME, start)
    down = np.array([[0.0, 0.0], [0.0, 0.0], [-1.0, 0.0]])
    found = contact.copy()
    time, settles = refine.refine_contact(
        False,
        start,
        np.zeros((3, 2)),
        down,
        PAIR.bolt.packed,
        PAIR.nut.packed,
        found,
        contact[stage.K_TIME],
        alone,
        as_found,
        moved,
        known,
    )
    return Found(time, settles, found, moved, known)


def test_a_displaced_contact_is_found_again() -> None:
    contact, record = first_contact()
    displaced = contact.copy()
    displaced[stage.K_TIME] += 1e-7
    displaced[stage.K_BOLT_AZIMUTH] -= 1e-6
    found = refined_first(displaced, record)
    assert found.settles
    assert found.time == pytest.approx(TIME, abs=1e-17)
    np.testing.assert_allclose(found.contact, contact, rtol=0.0, atol=1e-15)
    assert found.pose[11, 0] == record[rk.O_POSE + 11]
    assert found.refined[refine.F_THETA, 1] != 0.0


def test_the_last_digits_of_what_is_found_are_of_no_account() -> None:
    contact, record = first_contact()
    displaced = contact.copy()
    displaced[stage.K_TIME] += 1e-16
    displaced[[stage.K_BOLT_AZIMUTH, stage.K_NUT_AZIMUTH]] += 1e-15
    one, other = (refined_first(found, record, as_found=False) for found in (contact, displaced))
    assert one.settles and other.settles
    for a, b in ((one.contact, other.contact), (one.pose, other.pose), (one.refined, other.refined)):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("column", [stage.K_TIME, stage.K_BOLT_AZIMUTH])
def test_a_contact_that_leads_elsewhere_does_not_settle(column: int) -> None:
    contact, record = first_contact()
    contact[column] += 0.5
    assert not refined_first(contact, record).settles


def test_a_tangency_that_round_off_makes_of_flanks_that_nearly_touch_as_a_whole_is_the_first_contact() -> None:
    """Thread on thread beside the first contact, at a phase beside which the second one is where it is here."""
    m6 = pair_by_designation("M6")
    tilt = 7.251056780298752e-07, 4.5571130323874975e-07
    here, beside = (solve_pose(m6, *tilt, phase) for phase in (-2.3833869396069804, -2.3843869396069804))
    for one, other in zip(here.contacts, beside.contacts, strict=True):
        assert one.features is other.features
        assert math.dist(one.point, other.point) < 1e-4 * m6.nominal_diameter
    assert here.lambda_deg == pytest.approx(beside.lambda_deg, rel=1e-4)


def test_simultaneous_contacts_and_those_of_thread_on_surface_stay_as_they_were_found() -> None:
    contact, record = first_contact()
    contact[stage.K_BOLT_AZIMUTH] += 1e-9
    tied = refined_first(contact, record, alone=False)
    np.testing.assert_array_equal(tied.contact, contact)
    np.testing.assert_array_equal(tied.refined[refine.F_POINT :, 0], contact[stage.K_X :])
    contact[stage.K_PAIR] = stage.THREAD_SURFACE
    on_surface = refined_first(contact, record)
    np.testing.assert_array_equal(on_surface.contact, contact)
    assert tied.settles and on_surface.settles


def test_a_turn_about_an_axis_and_back_is_none() -> None:
    _, record = first_contact()
    start, there, back = np.empty((12, 2)), np.empty((12, 2)), np.empty((12, 2))
    refine.set_first_pose(0.01, -0.02, 3.0, 0.004, start)
    point, axis = np.zeros((3, 2)), np.empty((3, 2))
    point[:, 0] = record[rk.O_CONTACT + rk.P_POINT : rk.O_CONTACT + rk.P_POINT + 3]
    refine.set_unit(((0.3, 0.0), (-0.7, 0.0), (0.1, 0.0)), False, axis)
    wide.set_moved(start, True, point, axis, (0.6, 0.0), there)
    wide.set_moved(there, True, point, axis, (-0.6, 0.0), back)
    assert np.max(np.abs(there[:, 0] - start[:, 0])) > 0.01
    difference = (back[:, 0] - start[:, 0]) + (back[:, 1] - start[:, 1])
    assert np.max(np.abs(difference)) < 1e-30
