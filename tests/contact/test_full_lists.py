"""Lists of limited length hold what is earliest, and report where something may have been dropped."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from threadstate.contact import _edge_search_kernel as edge_search
from threadstate.contact import _record_kernel as record
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._box_kernel import ONE_EDGE
from threadstate.contact._geometry_kernel import M_SIGMA, MOTION_SIZE
from threadstate.contact._onset_kernel import CANDIDATE_SIZE, JET_SIZE, Candidate, insert_candidate
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed


def around(i: int) -> tuple[float, float]:
    return 0.12 * math.cos(0.3 * i), 0.12 * math.sin(0.3 * i)


def test_a_full_list_of_contacts_drops_the_latest() -> None:
    listed = np.full((stage.MAX_CONTACTS, stage.CONTACT_SIZE), math.nan)
    times = np.random.default_rng(81).permutation(stage.MAX_CONTACTS + 5).astype(float).tolist()
    count = 0
    for i, time in enumerate(times):
        one = stage.Contact(time, stage.EDGE_EDGE, 0.0, 0.0, *around(i), 0.0)
        count = stage.insert_contact(one, count, listed)
    assert count == stage.MAX_CONTACTS
    assert listed[:, stage.K_TIME].tolist() == sorted(times)[: stage.MAX_CONTACTS]


def test_a_full_list_of_entries_drops_the_latest() -> None:
    entries = np.zeros((1 + edge_search.MAX_ENTRIES, edge_search.ENTRY_SIZE))
    motion = np.zeros(MOTION_SIZE)
    motion[M_SIGMA] = 1.0
    times = np.random.default_rng(82).permutation(edge_search.MAX_ENTRIES + 5).astype(float).tolist()
    for time in times:
        edge_search.insert_entry(time, 0.5, motion, np.zeros(JET_SIZE), entries)
    assert entries[0, 0] == edge_search.MAX_ENTRIES
    assert sorted(entries[1:, edge_search.E_TIME]) == sorted(times)[: edge_search.MAX_ENTRIES]


@pytest.mark.parametrize(("apart", "status"), [(1e-3, stage.RESOLVED), (1e-15, stage.UNRESOLVED)])
def test_more_contacts_at_once_than_there_is_room_for_are_unresolved(
    monkeypatch: pytest.MonkeyPatch, apart: float, status: int
) -> None:
    """``earliest`` interpreted, with an edge search that fills its list of candidates, so far apart in time."""

    def crowded_search(*arguments: Any) -> tuple[int, int, float, float]:
        count, found = arguments[5:]
        assert found.shape[1] == CANDIDATE_SIZE
        for i in range(len(found)):
            one = Candidate(1e-4 + apart * i, int(ONE_EDGE), 0.3 * i, 0.3 * i, *around(i), 0.0)
            count = insert_candidate(one, count, found)
        return count, 1, 1e-4, 1e-4

    monkeypatch.setattr(stage, "search_edge", crowded_search)
    for name in ("search_both_edges", "contacts_of_edges"):
        monkeypatch.setattr(stage, name, getattr(stage, name).py_func)
    pose, out = np.zeros(12), np.empty((stage.MAX_CONTACTS, stage.CONTACT_SIZE))
    stage.rotation(0.05, 0.02, 1.0, pose)
    pose[11] = 0.01
    wanted = stage.Wanted(0.02, 1e-12, stage.RIDGES_ONLY)
    down = np.array([0.0, 0.0, -1.0])
    way_down = stage.Stage(pose, False, down, down, np.empty((0, 2)), np.empty((0, stage.CONTACT_SIZE)), 0)
    count, found_status, _ = stage.earliest.py_func(way_down, wanted, False, BOLT, NUT, stage.new_work(), out)
    assert (count, found_status) == (stage.MAX_CONTACTS, status)


def test_a_record_without_room_for_a_contact_is_unresolved() -> None:
    pose, row = np.zeros(12), np.zeros(record.RECORD_SIZE)
    stage.rotation(0.05, 0.02, 1.0, pose)
    for i in range(record.MAX_RECORD_CONTACTS):
        contact = np.array([0.0, stage.EDGE_EDGE, 0.3 * i, 0.3 * i, *around(i), 0.0])
        record.append_contact(3, contact, pose, BOLT, NUT, row)
    assert (row[record.O_CONTACTS], row[record.O_STATUS]) == (record.MAX_RECORD_CONTACTS, stage.RESOLVED)
    record.append_contact(3, contact, pose, BOLT, NUT, row)
    assert row[record.O_STATUS] == stage.UNRESOLVED
    row[record.O_STATUS] = stage.RESOLVED
    record.append_flush_point(3, 0.5, False, *around(1), BOLT, NUT, row)
    assert row[record.O_STATUS] == stage.UNRESOLVED
