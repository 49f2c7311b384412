"""Descents with few searches end where those do that search after each step."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact._stage_kernel import THREAD_THREAD
from threadstate.device import _chart_kernel as ck
from threadstate.device import _descent_kernel as dk
from threadstate.device import _gap_kernel as gk
from threadstate.device import _leg_kernel as lk
from threadstate.device import _places_kernel as pl
from threadstate.device import _rest_kernel as rk
from threadstate.device import _thread_maximum_kernel as tm
from threadstate.device import _turn_kernel as tk
from threadstate.device._settle_kernel import LAST_STEPS, PATH_OVERLAP, PATH_TOLERANCE
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPoint, Held
from threadstate.device.command import command_numbers
from threadstate.device.model import Outcome, default_device
from threadstate.device.settle import device_numbers, settle_pose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
BOLT, NUT = UNC.bolt.packed, UNC.nut.packed
HELD = default_device().in_unit(UNC.unit)
R = UNC.nominal_diameter / 2.0
LONGEST = tk.DESCENT_STEP * R
ROLL_DEG, PITCH_DEG, PHASE_DEG = 1.4, -2.6, 209.0


class At(NamedTuple):
    """A point of a path: the device's numbers at its command, and the bolt's coordinates."""

    device: Floats
    q: Floats


def at_point(point: AssemblyPoint) -> At:
    device = device_numbers(UNC, HELD)
    device[ck.D_FINE] = pl.FINE
    lk.set_phase(math.radians(point.phase_deg), command_numbers(HELD, ROLL_DEG, PITCH_DEG, 0.0), device)
    place = np.empty(ck.PLACE_SIZE)
    q = np.zeros(ck.COORDINATES)
    q[:3] = np.radians(point.rotation_deg)
    # The command's height is that of the first contact; the bolt's place says where the centre is.
    ck.set_place(q, device, place)
    q[3:] += np.array(point.pose.translation) - place[ck.N_OFFSET : ck.N_OFFSET + 3]
    device[ck.D_PLACE : ck.D_PLACE + 3] = q[3:] - np.array(point.shift)
    return At(device, q)


DESCENT = dk.Descent(HELD.push, LONGEST, math.inf, LAST_STEPS, PATH_TOLERANCE, PATH_OVERLAP)


@pytest.fixture(scope="module")
def points() -> list[AssemblyPoint]:
    """Points of a path that engages, on contacts."""
    path = assemble_pose(UNC, ROLL_DEG, PITCH_DEG, PHASE_DEG)
    assert path.outcome is AssemblyOutcome.ENGAGED
    return [point for point in path.points if point.held is Held.CONTACTS][::15]


def test_few_searches_lead_where_a_search_after_each_step_does(points: list[AssemblyPoint]) -> None:
    """From 1e-4 in and 0.01 deg beside, with all places known first, or none."""
    followed = 0
    for point in points:
        ends = []
        for known, searches in ((False, True), (False, False), (True, False)):
            device, q = at_point(point)
            threads, work, place = pl.new_threads(BOLT), rk.new_work(), np.empty(ck.PLACE_SIZE)
            ck.set_place(q, device, place)
            count = pl.find_places(dk.REACH * LONGEST, place, device, BOLT, NUT, threads, work.search, work.places)
            q[:3] += math.radians(0.01)
            q[3:] += 1e-4
            given = count if known else 0
            ended = dk.descend_with(q, given, searches, DESCENT, rk.Scene(device, BOLT, NUT, threads, work))
            ends.append((ended[0], q, sorted(work.places[: ended[1], gk.G_VALUE])))
        status, expected, places = ends[0]
        for other, q, values in ends[1:]:
            if status != dk.AT_REST or other != dk.AT_REST:
                continue
            assert np.abs(q - expected).max() < 1e-6 * R
            assert len(values) == len(places)
            followed += 1
    assert followed > len(points)


def test_a_place_that_is_not_known_is_found_where_the_bolt_rests(points: list[AssemblyPoint]) -> None:
    """The descent is told of one of the contacts alone, and would end where the others overlap."""
    tried = 0
    for point in points:
        if len(point.contacts) < 3:
            continue
        device, q = at_point(point)
        start, place = q.copy(), np.empty(ck.PLACE_SIZE)
        threads, work = pl.new_threads(BOLT), rk.new_work()
        ck.set_place(q, device, place)
        count = pl.find_places(dk.REACH * LONGEST, place, device, BOLT, NUT, threads, work.search, work.places)
        work.places[0] = work.places[np.argmax(work.places[:count, gk.G_VALUE])]
        status, found = dk.descend_followed(q, 1, DESCENT, rk.Scene(device, BOLT, NUT, threads, work))
        assert (status, found) == (dk.AT_REST, count)
        assert np.abs(q - start).max() < 1e-6 * R
        tried += 1
    assert tried > 0


def test_a_descent_that_does_not_end_with_few_searches_begins_anew() -> None:
    """After the snap of this path steps of one lead where those of the other do not, to and fro."""
    path = assemble_pose(UNC, -2.8459593331404998, -3.057662095373053, 111.05345667669637)
    assert (path.outcome, path.flags) == (AssemblyOutcome.ENGAGED, ())


@pytest.mark.parametrize("phase_deg", [0.05, 0.5, 1.0])
def test_a_bolt_falls_past_a_double_root_of_its_contacts(phase_deg: float) -> None:
    """Each correction of the way back there leaves a fourth of the overlap: it takes more than ``MAX_CORRECTIONS``."""
    loose = pair_by_designation("1/4-20 UNC-2A/2B at minimum material")
    state = settle_pose(loose, 3.0, 2.0, phase_deg)
    assert state.outcome is Outcome.SETTLED
    assert len(state.falls) == 1
    before = settle_pose(loose, 3.0, 2.0, 0.0)
    assert state.elastic_energy == pytest.approx(before.elastic_energy, rel=0.05 * phase_deg + 1e-3)


def test_no_place_within_reach_is_lost_to_the_bound_on_what_a_ridge_rises_by(points: list[AssemblyPoint]) -> None:
    """A search with six times the reach bounds no ridge near it, and has the same places up to there."""
    reach, compared = dk.REACH * LONGEST, 0
    for point in points:
        device, q = at_point(point)
        place = np.empty(ck.PLACE_SIZE)
        ck.set_place(q, device, place)
        values = []
        for far in (1.0, 6.0):
            places = np.zeros((pl.MAX_PLACES + 1, gk.GAP_SIZE))
            threads, search = pl.new_threads(BOLT), np.zeros(pl.PLACES_WORK)
            count = pl.find_places(far * reach, place, device, BOLT, NUT, threads, search, places)
            values.append(sorted(value for value in places[:count, gk.G_VALUE] if value > -reach))
        assert values[0] == pytest.approx(values[1], abs=1e-12 * R)
        compared += len(values[0])
    assert compared > len(points)


def test_a_ridge_that_cannot_rise_to_where_a_maximum_counts_is_not_followed(points: list[AssemblyPoint]) -> None:
    """Beside the maximum of a place: it is found, and not where only higher ones count."""
    for point in points:
        device, q = at_point(point)
        place, jet = np.empty(ck.PLACE_SIZE), np.empty(len(pl.new_threads(BOLT).jet))
        ck.set_place(q, device, place)
        places = np.zeros((pl.MAX_PLACES + 1, gk.GAP_SIZE))
        threads = pl.new_threads(BOLT)
        count = pl.find_places(dk.REACH * LONGEST, place, device, BOLT, NUT, threads, np.zeros(pl.PLACES_WORK), places)
        for gap in places[:count]:
            if int(gap[gk.G_PAIR]) != THREAD_THREAD or gap[gk.G_Z] > UNC.thread_pitch:
                continue
            pl.set_base(0.0, place, threads.placement)
            start = (gap[gk.G_THETA] + 1e-3, gap[gk.G_Z], 0.0, 0.02)
            parts = (threads.placement, BOLT, NUT, jet)
            theta, _, kind = tm.ridge_maximum(*start, -math.inf, *parts)
            if kind == tm.MAXIMUM:
                assert theta == pytest.approx(gap[gk.G_THETA], abs=1e-6)
                assert tm.ridge_maximum(*start, 0.1 * R, *parts)[2] == tm.TOO_LOW
                return
    pytest.fail("no place of the threads has a ridge beside it")
