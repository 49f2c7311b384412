"""Labels beside contacts close to each other are steady."""

from __future__ import annotations

import numpy as np
import pytest

from studies.history.steadiness import check_steadiness
from threadstate.contact import _record_kernel as rk
from threadstate.history.build import history_of
from threadstate.history.records import Floats, RecordStore
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()


def test_labels_do_not_change_beside_close_contacts() -> None:
    check = check_steadiness(PAIR, [history_of(PAIR, -4.0, -3.0)], 40)
    assert check.boundaries >= 2
    assert check.phases >= 40 * check.boundaries
    assert check.changes == ()


def test_a_contact_that_is_missed_at_one_phase_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    history = history_of(PAIR, -4.0, -3.0)
    solved = RecordStore.records

    def missing(store: RecordStore, poses_deg: Floats) -> Floats:
        records = solved(store, poses_deg).copy()
        records[len(records) // 2, rk.O_FLAGS] += rk.FLAG_GRAZING
        return records

    monkeypatch.setattr(RecordStore, "records", missing)
    check = check_steadiness(PAIR, [history], 9)
    assert len(check.changes) == 2 * check.phases // 9
    assert all(np.isclose(one.high_deg - one.low_deg, 0.02 / 8, rtol=0.01) for one in check.changes[:2])
