"""Records of first contacts alone: they have the bits of the whole ones, and are not solved where these are known."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.contact import _record_kernel as rk
from threadstate.history import records as store
from threadstate.state.options import SolveOptions
from threadstate.state.records import Floats, solve_records
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
OPTIONS = SolveOptions()
FIRST = slice(rk.O_POSE, rk.O_POSE + 12), slice(rk.O_CONTACT, rk.O_CONTACT + rk.POINT_SIZE)


def poses(count: int) -> Floats:
    """Poses of every tilt: level, all but level, and of some degrees."""
    rng = np.random.default_rng(76)
    tilts = 10.0 ** rng.uniform(-10.0, 0.6, (count, 1)) * rng.uniform(-1.0, 1.0, (count, 2))
    return np.vstack([[0.0, 0.0, 12.0], np.column_stack([tilts, rng.uniform(0.0, 360.0, count)])])


def test_the_first_contact_alone_has_the_bits_that_the_whole_record_has() -> None:
    chosen = poses(200)
    whole = solve_records(PAIR, OPTIONS, chosen)
    first = solve_records(PAIR, OPTIONS, chosen, first_contact_only=True)
    for columns in FIRST:
        assert whole[:, columns].tobytes() == first[:, columns].tobytes()
    assert (first[:, rk.O_POSES] > 0.0).all()
    # Below that a tie within the tolerance may be none within a smaller one.
    tilted = np.abs(chosen[:, :2]).max(axis=1) > 0.05
    assert (first[tilted, rk.O_POSES] == 1.0).all()
    assert (whole[tilted, rk.O_POSES] > 1.0).any()
    assert tilted.sum() > 20


def test_whole_records_are_taken_where_they_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = store.RecordStore(PAIR, OPTIONS)
    first = store.FirstContactStore(PAIR, OPTIONS, whole)
    chosen = poses(6)
    known = whole.records(chosen[:4])
    solved: list[int] = []

    def counted(*arguments: object, first_contact_only: bool = False) -> Floats:
        assert first_contact_only
        solved.append(len(arguments[2]))  # type: ignore[arg-type]
        return solve_records(*arguments, first_contact_only=first_contact_only)  # type: ignore[arg-type]

    monkeypatch.setattr(store, "solve_records", counted)
    found = first.records(chosen)
    assert solved == [3]
    assert found[:4].tobytes() == known.tobytes()
    assert first.records(chosen).tobytes() == found.tobytes()
    assert solved == [3]
    # What a store of whole records lacks it does not take from here.
    monkeypatch.undo()
    later = whole.records(chosen[4:])
    assert (later[:, rk.O_POSES] > 1.0).any()
