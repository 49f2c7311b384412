"""The visits of made-up paths and of one that is computed."""

from __future__ import annotations

import pytest

from tests.chances.made_up import path, point
from threadstate.chances.compute import computed_record
from threadstate.chances.model import Leaving, LegName, Record
from threadstate.chances.record import following_from, record_of, visits_of
from threadstate.chances.sampling import Approach, Uncertainty
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, Held, PathEvent, PathEventKind
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair
from threadstate.thread.catalogue import quarter_twenty_unc

EE, ET, TE, FLUSH = FeaturePair.EDGE_EDGE, FeaturePair.EDGE_THREAD, FeaturePair.THREAD_EDGE, FeaturePair.FLUSH
APPROACH = Approach(3, 0.0, 0.0, 0.0, 0.1)
PAIR = quarter_twenty_unc()


def test_points_of_one_formation_are_one_visit() -> None:
    found = visits_of(
        path(
            [
                point(0.0, [EE, ET]),
                point(-10.0, [ET, EE]),
                point(-20.0, [ET, EE, TE]),
                point(-30.0, [TE, TE, TE]),
                point(-40.0, [TE]),
            ]
        )
    )
    assert [one.left for one in found] == [Leaving.GAINED, Leaving.MOVED, Leaving.LOST, Leaving.END]
    assert [(one.from_deg, one.to_deg) for one in found] == [
        (0.0, -20.0),
        (-20.0, -30.0),
        (-30.0, -40.0),
        (-40.0, -40.0),
    ]
    assert found[0].formation.features == (EE, ET)
    assert str(found[0].formation) == "edge-edge, edge-thread"
    assert [len(one.readings) for one in found] == [2, 1, 1, 1]


def test_a_reading_is_the_resultant_of_the_contacts() -> None:
    (found,) = visits_of(path([point(5.0, [EE, ET, TE])]))
    (reading,) = found.readings
    assert (reading.phase_deg, reading.torque, reading.force) == (5.0, 0.25, (3.0, 0.0, 6.0))


@pytest.mark.parametrize(
    ("before", "after", "left"),
    [
        (Held.CONTACTS, Held.SURFACE, Leaving.ON_SURFACE),
        (Held.SURFACE, Held.CONTACTS, Leaving.OFF_SURFACE),
        (Held.CONTACTS, Held.STRIP, Leaving.ON_STRIP),
        (Held.STRIP, Held.CONTACTS, Leaving.OFF_STRIP),
        (Held.STRIP, Held.SURFACE, Leaving.ON_SURFACE),
        (Held.SURFACE, Held.STRIP, Leaving.ON_STRIP),
    ],
)
def test_what_holds_the_bolt_comes_before_how_many_contacts(before: Held, after: Held, left: Leaving) -> None:
    first, last = visits_of(path([point(0.0, [EE, EE], before), point(-1.0, [FLUSH], after)]))
    assert (first.left, last.left) == (left, Leaving.END)


def test_a_fall_is_how_a_visit_is_left_even_where_contacts_are_gained() -> None:
    points = [point(0.0, [EE]), point(-10.0, [EE]), point(-10.05, [EE, TE])]
    fall = PathEvent(PathEventKind.FALL, -10.05, -10.0)
    assert [one.left for one in visits_of(path(points, [fall]))] == [Leaving.FALL, Leaving.END]
    earlier = PathEvent(PathEventKind.FALL, -5.0, -4.0)
    assert [one.left for one in visits_of(path(points, [earlier]))] == [Leaving.GAINED, Leaving.END]


def test_the_formation_after_a_fall_is_left_as_it_is() -> None:
    points = [point(0.0, [EE]), point(-10.0, [EE]), point(-10.05, [EE, TE]), point(-10.1, [EE])]
    fall = PathEvent(PathEventKind.FALL, -10.05, -10.0)
    assert [one.left for one in visits_of(path(points, [fall]))] == [Leaving.FALL, Leaving.LOST, Leaving.END]


def test_the_snap_ends_a_visit_also_where_the_bolt_is_held_alike() -> None:
    points = [point(0.0, [ET]), point(40.0, [ET]), point(38.0, [ET]), point(20.0, [ET])]
    snap = PathEvent(PathEventKind.SNAP, 40.0, 39.0)
    before, after = visits_of(path(points, [snap], Strategy.CCW_THEN_CW))
    assert (before.leg, before.left, before.from_deg, before.to_deg) == (LegName.CCW, Leaving.SNAP, 0.0, 40.0)
    assert (after.leg, after.left, after.from_deg, after.to_deg) == (LegName.CW, Leaving.END, 40.0, 20.0)
    (only,) = visits_of(path(points[:2], (), Strategy.CCW_THEN_CW))
    assert (only.leg, only.left) == (LegName.CCW, Leaving.END)


def test_a_left_hand_bolt_turns_the_other_way_round() -> None:
    points = [point(0.0, [ET]), point(-40.0, [ET]), point(-20.0, [ET])]
    snap = PathEvent(PathEventKind.SNAP, -40.0, -39.0)
    legs = [one.leg for one in visits_of(path(points, [snap], Strategy.CCW_THEN_CW))]
    assert legs == [LegName.CCW, LegName.CW]


def test_the_bolt_is_assembled_from_where_the_height_follows_the_lead() -> None:
    heights = [(0.0, 0.0), (-90.0, 0.01), (-180.0, -0.0125), (-270.0, -0.025)]
    points = [point(phase, [ET], z=z) for phase, z in heights]
    assert following_from(points, 0.05) == 2
    found = record_of(path(points, outcome=AssemblyOutcome.ENGAGED), APPROACH, 0.05)
    assert (found.turned_deg, found.assembled_deg) == (270.0, 180.0)
    assert record_of(path(points), APPROACH, 0.05).assembled_deg is None


def test_a_start_that_does_not_settle_has_no_visits() -> None:
    found = record_of(path([], outcome=AssemblyOutcome.UNDECIDED), APPROACH, 0.05)
    assert (found.visits, found.turned_deg, found.torque, found.is_bounded) == ((), None, None, False)


def computed(point_limit: int) -> Record:
    """A path without friction that engages where it is not bounded."""
    uncertainty = Uncertainty((0.0, -2.0), 1.0, (0.0, 0.0))
    return computed_record(PAIR, default_device(), Strategy.CCW_THEN_CW, uncertainty, point_limit, 0)


def test_a_computed_path_has_its_points_in_its_visits() -> None:
    record = computed(1000)
    one = record.approach
    whole = assemble_pose(PAIR, one.roll_deg, one.pitch_deg, one.phase_deg, default_device(), mu=0.0)
    readings = [reading for visit in record.visits for reading in visit.readings]
    assert record.outcome is whole.outcome is AssemblyOutcome.ENGAGED
    assert [reading.phase_deg for reading in readings] == pytest.approx([found.phase_deg for found in whole.points])
    # Nothing but the push, 10 N, acts along z: the device's stiffness there is 0.
    assert [reading.force[2] for reading in readings] == pytest.approx([10.0] * len(readings), abs=1e-5)
    turned = sum(visit.turned_deg for visit in record.visits)
    assert turned == pytest.approx(record.turned_deg, abs=1e-6)
    assert record.assembled_deg is not None
    assert 90.0 <= turned - record.assembled_deg < 270.0
    assert [visit.left for visit in record.visits].count(Leaving.SNAP) == 1
    falls = [event for event in whole.events if event.kind is PathEventKind.FALL]
    assert sum(visit.left is Leaving.FALL for visit in record.visits) <= len(falls)


def test_a_path_beyond_the_limit_of_points_is_bounded() -> None:
    record = computed(10)
    assert (record.outcome, record.is_bounded, record.visits) == (AssemblyOutcome.UNDECIDED, True, ())
