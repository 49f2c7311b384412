"""Boxes of the contact search are looked at by their starts, and closed by an onset beside them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.contact.edges import new_edge, new_kept, refined_edges, wide_motion
from threadstate.contact import _box_kernel as box
from threadstate.contact import _edge_search_kernel as edge_search
from threadstate.contact import _onset_kernel as onset
from threadstate.contact import _queue_kernel as queues
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as solve
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._refined_edge_kernel import is_refined
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed
TIE = 1e-12

Floats = NDArray[np.float64]


def second_turn(pose_deg: tuple[float, float, float], work: stage.Work) -> tuple[Edge, Edge]:
    """The edges of the bolt and of the nut as the bolt is turned about the tangent at the first contact of a pose."""
    row = solve_records(PAIR, SolveOptions(), np.array([pose_deg]))[0]
    pose, contact = row[rk.O_POSE : rk.O_POSE + 12].copy(), row[rk.O_CONTACT :]
    point, on_bolt = contact[rk.P_POINT : rk.P_POINT + 3].copy(), contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 2]
    known = np.zeros((1, stage.CONTACT_SIZE))
    known[0, stage.K_PAIR] = contact[rk.P_PAIR]
    known[0, stage.K_BOLT_AZIMUTH] = math.atan2(on_bolt[1], on_bolt[0])
    known[0, stage.K_NUT_AZIMUTH] = math.atan2(point[1], point[0])
    known[0, stage.K_X :] = point
    axis = np.zeros(3)
    solve.second_axis(known[0], pose, BOLT, NUT, axis)
    edges = new_edge(work.bolt_motion, BOLT, NUT, new_kept(1)), new_edge(work.nut_motion, NUT, BOLT, new_kept(1))
    coplanar = stage.axis_in_both_planes(known, 1)
    stage.set_motions(pose, True, coplanar, point, axis, work.bolt_motion, work.nut_motion)
    stage.keep_contacts(known, 1, pose, *edges)
    return edges


def wanted_of(work: stage.Work) -> edge_search.EdgeSearch:
    return edge_search.EdgeSearch(
        False, TIE, work.boxes, work.scratch, work.queue, work.regions, work.entries, work.jet, work.wedge
    )


def test_boxes_wait_by_their_starts_and_the_last_of_equals_comes_first() -> None:
    queue = queues.new_queue()
    queues.clear(queue)
    starts = np.random.default_rng(64).integers(0, 40, 300).tolist()
    waiting: list[tuple[int, int]] = []
    for i, start in enumerate(starts):
        queues.add(Box(float(i), 1.0, float(start), 50.0), queue)
        waiting.append((start, -i))
        if i % 3 == 2:  # one is taken in between, whose row is used again
            taken = min(waiting)
            waiting.remove(taken)
            assert queues.first(queue) == (-taken[1], 1.0, taken[0], 50.0)
            queues.remove_first(queue)
    assert queue.state[queues.USED] == 201
    for taken in sorted(waiting):
        assert queues.first(queue) == (-taken[1], 1.0, taken[0], 50.0)
        queues.remove_first(queue)
    assert queue.state[queues.STACKS] == 0


def test_parts_cover_the_box() -> None:
    whole = Box(1.0, 0.25, 2.0, 3.0)
    by_time = [edge_search.part_of(whole, True, j, 0.25) for j in range(4)]
    assert [(one.start, one.end) for one in by_time] == [(2.0, 2.25), (2.25, 2.5), (2.5, 2.75), (2.75, 3.0)]
    assert {(one.theta, one.half) for one in by_time} == {(1.0, 0.25)}
    by_azimuth = [edge_search.part_of(whole, False, j, 0.5) for j in range(2)]
    assert [(one.theta, one.half) for one in by_azimuth] == [(0.875, 0.125), (1.125, 0.125)]
    assert {(one.start, one.end) for one in by_azimuth} == {(2.0, 3.0)}


def test_parts_that_start_late_are_left_out_and_late_ends_are_cut() -> None:
    boxes, queue = np.zeros(box.BOXES_SIZE), queues.new_queue()
    queues.clear(queue)
    edge_search.set_box_at(Box(1.0, 0.25, 0.0, 1.0), 0, boxes)
    boxes[box.X_BY_TIME] = 1.0
    waiting = edge_search.add_parts(1, 0.5, boxes, 0, queue)
    assert waiting == 8
    count, waiting = edge_search.take_batch(0.3, boxes, waiting, queue)
    assert (count, waiting) == (5, 0)
    assert queue.state[queues.STACKS] == 0
    taken = [edge_search.box_at(i, boxes) for i in range(count)]
    assert [one.start for one in taken] == pytest.approx([0.0, 0.0625, 0.125, 0.1875, 0.25])
    assert taken[-1].end == 0.3


@pytest.mark.parametrize(
    ("start", "end", "left"),
    [
        (1.2, 1.8, None),
        (0.0, 1.5, (0.0, 1.0)),
        (1.5, 3.0, (2.0, 3.0)),
        (0.0, 3.0, (0.0, 3.0)),
        (0.0, 0.5, (0.0, 0.5)),
    ],
)
def test_of_a_box_in_a_region_only_other_times_are_left(
    start: float, end: float, left: tuple[float, float] | None
) -> None:
    regions = np.zeros((1 + edge_search.MAX_REGIONS, 4))
    regions[0, 0] = 1.0
    regions[1] = 0.5, 0.1, 1.0, 2.0
    found = edge_search.outside_regions(Box(0.55, 0.02, start, end), regions)
    assert ((found.start, found.end) if found.half > 0.0 else None) == left
    wide = Box(0.55, 0.06, start, end)
    assert edge_search.outside_regions(wide, regions) == wide


def test_an_onset_is_found_from_a_box_beside_it_and_kept_with_its_region() -> None:
    """The first span of this second turn has one contact, an onset on the bolt's edge."""
    work = stage.new_work()
    edge, _ = second_turn((2.0, -4.0, 3.0), work)
    wanted, found = wanted_of(work), np.empty((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE))
    count, evaluated, best, closed = edge_search.search_edge(0.0, 0.08, 0.08, edge, wanted, 0, found)
    assert (count, closed) == (1, 0.08)
    assert 0 < evaluated < 2500
    theta, kind = found[0, onset.C_THETA], float(found[0, onset.C_KIND])
    assert best == found[0, onset.C_TIME]

    jet = np.empty(onset.JET_SIZE)
    beside = Box(theta + 1.5e-6, 1e-6, best + 1e-9, best + 2e-9)
    place, t, tau = onset.newton_onset(kind, beside, edge, jet)
    assert place == onset.ROOT_BESIDE
    assert (t, tau) == pytest.approx((theta, best), abs=1e-13)
    assert edge_search.is_the_one(kind, beside, t, tau, edge, work.scratch)

    work.regions[0, 0] = 0.0
    edge_search.keep_region(kind, Box(theta, 1e-6, best - 1e-7, best + 1e-7), theta, best, edge, wanted)
    assert work.regions[0, 0] >= 1.0
    assert work.regions[1, 0] == theta
    region = Box(*work.regions[1].tolist())
    assert region.half >= 2e-6
    assert region.start < best < region.end
    assert edge_search.evaluate_box(region, edge, work.boxes) == kind


def test_an_onset_beside_a_box_by_less_than_its_round_off_is_not_certainly_beside_it() -> None:
    """An edge on an edge, 3e-3 rad from the earlier contact: its time is known to some 1e-11."""
    work = stage.new_work()
    edge, _ = second_turn((2.0, 4.0, 3.82646534708482), work)
    found = np.empty((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE))
    count, _, best, _ = edge_search.search_edge(0.07, 0.078, 0.078, edge, wanted_of(work), 0, found)
    assert count == 1
    assert found[0, onset.C_KIND] == box.ONE_EDGE
    theta, jet = found[0, onset.C_THETA], np.empty(onset.JET_SIZE)
    places = {onset.ROOT_AT_SIDE: best - 2e-12, onset.ROOT_BESIDE: best - 1e-7, onset.ROOT_INSIDE: best + 1e-7}
    for place, end in places.items():
        assert onset.newton_onset(box.ONE_EDGE, Box(theta, 1e-5, best - 1e-6, end), edge, jet)[0] == place


def test_an_onset_that_round_off_puts_beside_a_box_is_found_from_it() -> None:
    """From the neighbour round-off may put it into this one, so that both would leave it to the other."""
    work = stage.new_work()
    edge, _ = second_turn((2.0, 4.0, 3.82646534708482), work)
    wanted, found = wanted_of(work), np.empty((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE))
    _, _, best, _ = edge_search.search_edge(0.07, 0.078, 0.078, edge, wanted, 0, found)
    theta, kind = found[0, onset.C_THETA], found[0, onset.C_KIND]
    boxes = (
        (onset.ROOT_AT_SIDE, Box(theta, 1e-7, best - 1e-6, best - 2e-12), 1),
        (onset.ROOT_BESIDE, Box(theta, 1e-7, best - 1e-6, best - 1e-7), 0),
        (onset.NO_ROOT, Box(theta + 3e-8, 1e-8, best - 1e-8, best + 1e-8), 1),
    )
    for place, beside, count in boxes:
        assert onset.newton_onset(kind, beside, edge, work.jet)[0] == place
        work.regions[0, 0] = 0.0
        closed = edge_search.close_by_onset(kind, beside, 0.07, 0.078, edge, wanted, 0, found)
        assert closed == (True, count, pytest.approx(best if count else 0.078, abs=1e-10))
        assert (work.regions[0, 0] > 0.0) == (place == onset.ROOT_AT_SIDE)


def test_the_nuts_edge_beside_an_edge_contact_takes_few_boxes() -> None:
    """It runs 6e-7 in beside the contact at all times: a peak that is outside by hardly more than its bounds blur.

    Split by the longer side its boxes were 18,504 before the search gave up.
    """
    work = stage.new_work()
    _, edge = second_turn((2.0, -4.0, 27.984375), work)
    found = np.empty((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE))
    count, evaluated, _, closed = edge_search.search_edge(0.0, 0.0349, 0.0349, edge, wanted_of(work), 0, found)
    assert (count, closed) == (0, 0.0349)
    assert 0 < evaluated < 300


def test_a_search_that_gives_up_says_up_to_when_nothing_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Interpreted, with a limit of boxes that this search exceeds."""
    work = stage.new_work()
    edge, _ = second_turn((2.0, -4.0, 3.0), work)
    found = np.empty((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE))
    monkeypatch.setattr(edge_search, "MAX_BOXES", 400)
    _, evaluated, best, closed = edge_search.search_edge.py_func(0.0, 0.08, 0.08, edge, wanted_of(work), 0, found)
    assert evaluated == edge_search.OVERFLOW
    assert 0.0 < closed < best


@pytest.mark.parametrize(("closed", "since"), [(2e-3, [0.0, 2e-3]), (6e-3, [0.0, 0.0])])
def test_what_is_undecided_from_the_earliest_contact_on_is_searched_again(
    monkeypatch: pytest.MonkeyPatch, closed: float, since: list[float]
) -> None:
    """Interpreted, with a search that gives up once, after it has found a contact at 5e-3."""
    starts: list[float] = []

    def search(start: float, until: float, *_: object) -> tuple[int, int, float, float]:
        starts.append(start)
        return (0, edge_search.OVERFLOW, 5e-3, closed) if len(starts) <= 2 else (0, 8, 5e-3, until)

    monkeypatch.setattr(stage, "search_edge", search)
    work = stage.new_work()
    bolt_edge, nut_edge = second_turn((2.0, -4.0, 3.0), work)
    edges = refined_edges(bolt_edge, nut_edge, wide_motion(bolt_edge.motion))
    *_, best, _, status = stage.search_both_edges.py_func(
        0.0, 0.08, stage.FIRST_SPAN_TURN, True, *edges, wanted_of(work), work
    )
    assert (best, status) == (5e-3, stage.RESOLVED)
    assert starts[0:4:2] == since


def test_a_search_in_doubles_that_gives_up_goes_on_with_refined_edges_from_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Interpreted, with a search that gives up at 2e-3 in doubles; entries before that are kept."""
    searched: list[tuple[float, bool]] = []

    def search(start: float, until: float, _: float, edge: Edge, search: edge_search.EdgeSearch, *_rest: object) -> Any:
        searched.append((start, bool(is_refined(edge))))
        if is_refined(edge):
            return 0, 8, 0.08, until
        search.entries[0, 0], search.entries[1, edge_search.E_TIME] = 2, 3e-3
        search.entries[2, edge_search.E_TIME] = 1e-3
        return 0, edge_search.OVERFLOW, 0.08, 2e-3

    monkeypatch.setattr(stage, "search_edge", search)
    monkeypatch.setattr(stage, "search_threads", lambda *_: (0, 0))
    for name in ("search_both_edges", "contacts_of_edges"):
        monkeypatch.setattr(stage, name, getattr(stage, name).py_func)
    work = stage.new_work()
    second_turn((2.0, -4.0, 3.0), work)
    motion = work.bolt_motion
    known = np.empty((0, stage.CONTACT_SIZE))
    turn = stage.Stage(motion[:12].copy(), True, motion[13:16].copy(), motion[16:19].copy(), np.empty((0, 2)), known, 0)
    wanted = stage.Wanted(0.08, TIE, stage.RIDGES_ONLY)
    out = np.empty((stage.MAX_CONTACTS, stage.CONTACT_SIZE))
    assert stage.earliest.py_func(turn, wanted, False, BOLT, NUT, work, out) == (0, stage.RESOLVED, 0.08)
    assert searched[:2] == [(0.0, False), (0.0, False)]
    assert searched[2:4] == [(2e-3, True), (2e-3, True)]
    assert all(refined for _, refined in searched[4:])
    assert (work.entries[0, 0], work.entries[1, edge_search.E_TIME]) == (1, 1e-3)
