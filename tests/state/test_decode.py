from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.errors import UnresolvedPoseError
from threadstate.state.decode import decoded_states
from threadstate.state.model import Contact, FeaturePair, Flag, StagePose, StateClass
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.regions import Region

PAIR = quarter_twenty_unc()
OPTIONS = SolveOptions()
POSES_DEG = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [0.0, -0.0, 9.0]])

Array = NDArray[np.float64]


@pytest.fixture
def records() -> Array:
    """Three records: two stages with three contacts, three stages with none, one stage with one contact.

    Every number is another one, and what a record's counts leave out is NaN.
    """
    records = np.full((3, rk.RECORD_SIZE), math.nan)
    records[:, rk.O_STATUS] = 0.0
    records[:, rk.O_POSES] = 2, 3, 1
    records[:, rk.O_CONTACTS] = 3, 0, 1
    records[:, rk.O_FLAGS] = rk.FLAG_TIE + rk.FLAG_NO_THIRD, 0, rk.FLAG_FLUSH
    records[:2, rk.O_LAMBDA] = 0.5, 0.25
    records[1, rk.O_MU] = 0.125
    records[:2, rk.O_PIVOT] = 7.0, 8.0
    records[1, [rk.O_DROP, rk.O_EMBEDMENT]] = 5.0, 4.0
    for i, stages in enumerate((2, 3, 1)):
        records[i, rk.O_POSE : rk.O_POSE + 12 * stages] = 1000 * (i + 1) + np.arange(12 * stages)
    for i, position, stage, features, bolt_region, nut_region in (
        (0, 0, 1, 0, 0, 8),
        (0, 1, 2, 3, 4, 5),
        (0, 2, 2, 5, 8, 0),
        (2, 0, 1, 6, 2, 7),
    ):
        contact = records[i, rk.O_CONTACT + rk.POINT_SIZE * position :][: rk.POINT_SIZE]
        contact[:] = 10000 * (i + 1) + 100 * position + np.arange(rk.POINT_SIZE)
        contact[[rk.P_STAGE, rk.P_PAIR, rk.P_BOLT_REGION, rk.P_NUT_REGION]] = stage, features, bolt_region, nut_region
    return records


def test_every_number_of_a_record_has_its_place(records: Array) -> None:
    first, second, third = decoded_states(PAIR, OPTIONS, POSES_DEG, records)

    assert (second.roll_deg, second.pitch_deg, second.phase_deg) == (4.0, 5.0, 6.0)
    assert first.flags == (Flag.TIE, Flag.NO_THIRD)
    assert second.flags == ()
    assert third.flags == (Flag.FLUSH,)
    assert (first.lambda_deg, first.mu_deg) == (math.degrees(0.5), None)
    assert (second.lambda_deg, second.mu_deg) == (math.degrees(0.25), math.degrees(0.125))
    assert (first.drop, first.embedment, first.pivot_offset) == (None, None, 7.0)
    assert (second.drop, second.embedment, second.pivot_offset) == (5.0, 4.0, 8.0)
    assert (third.lambda_deg, third.drop, third.pivot_offset, third.pivot_margin) == (None, None, None, None)
    assert (first.state_class, first.drop_margin) == (StateClass.UNSTABLE_TWO_POINT, None)
    assert (second.state_class, second.drop_margin) == (StateClass.STABLE_THREE_POINT, 1.0)
    assert second.embedment_margin == 2e-8 * PAIR.thread_pitch - 4.0
    assert second.pivot_margin == 8.0 - 0.1 * PAIR.nominal_diameter / 2.0
    assert third.state_class is StateClass.STABLE_THREE_POINT

    assert [len(state.poses) for state in (first, second, third)] == [2, 3, 1]
    assert second.poses[1] == StagePose(
        ((2012.0, 2013.0, 2014.0), (2015.0, 2016.0, 2017.0), (2018.0, 2019.0, 2020.0)), (2021.0, 2022.0, 2023.0)
    )
    assert [len(state.contacts) for state in (first, second, third)] == [3, 0, 1]
    assert first.contacts[1] == Contact(
        stage=2,
        point=(10102.0, 10103.0, 10104.0),
        point_bolt=(10105.0, 10106.0, 10107.0),
        normal=(10108.0, 10109.0, 10110.0),
        bolt_region=Region.CREST,
        nut_region=Region.ROOT_FILLET_NEG,
        features=FeaturePair.EDGE_THREAD,
        bolt_margin=10113.0,
        nut_margin=10114.0,
    )
    assert (first.contacts[0].bolt_region, first.contacts[0].nut_region) == (Region.ROOT, Region.SURFACE)
    assert (first.contacts[2].bolt_region, first.contacts[2].nut_region) == (Region.BASE, Region.CREST)
    assert third.contacts[0].point == (30002.0, 30003.0, 30004.0)


def test_a_state_does_not_depend_on_those_beside_it(records: Array) -> None:
    together = decoded_states(PAIR, OPTIONS, POSES_DEG, records)
    for i, state in enumerate(together):
        assert decoded_states(PAIR, OPTIONS, POSES_DEG[[i]], records[[i]]) == [state]
    assert decoded_states(PAIR, OPTIONS, POSES_DEG[:0], records[:0]) == []


def test_numbers_and_names_are_plain_ones(records: Array) -> None:
    state = decoded_states(PAIR, OPTIONS, POSES_DEG, records)[0]
    contact = state.contacts[0]
    numbers = (state.roll_deg, state.lambda_deg, state.pivot_offset, *state.poses[0].translation, *contact.normal)
    assert {type(number) for number in (*numbers, contact.bolt_margin)} == {float}
    assert type(contact.stage) is int


def test_the_first_unresolved_pose_is_named(records: Array) -> None:
    records[1:, rk.O_STATUS] = 1.0
    with pytest.raises(UnresolvedPoseError, match=r"4\b.*5\b.*6\b"):
        decoded_states(PAIR, OPTIONS, POSES_DEG, records)
