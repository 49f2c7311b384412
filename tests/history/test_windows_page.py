"""The table of docs/windows.md against histories that are computed anew."""

from __future__ import annotations

from pathlib import Path

import pytest

from threadstate.history.build import history_of
from threadstate.history.window import windows_of
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
ORIENTATIONS = 81


def shown(page: str) -> list[list[str]]:
    """The rows of the table of windows, as they are written."""
    lines = page.partition("|---|")[2].partition("\n\n")[0].splitlines()[1:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_every_orientation_is_in_the_table(repository_root: Path) -> None:
    rows = shown((repository_root / "docs" / "windows.md").read_text())
    assert len({(row[0], row[1]) for row in rows}) == ORIENTATIONS


@pytest.mark.parametrize(("roll", "pitch"), [(0, -4), (4, 0), (-2, -3)])
def test_the_windows_shown_are_those_computed(repository_root: Path, roll: int, pitch: int) -> None:
    rows = shown((repository_root / "docs" / "windows.md").read_text())
    told = [row[2:] for row in rows if row[:2] == [str(roll), str(pitch)]]
    windows = windows_of(PAIR, history_of(PAIR, float(roll), float(pitch)))
    assert len(told) == len(windows)
    for (enter, leave, width, drop, climb, snap, fall), window in zip(told, windows, strict=True):
        assert float(enter) == pytest.approx(window.enter_deg, abs=2e-6)
        assert float(leave) == pytest.approx(window.leave_deg, abs=2e-6)
        assert float(width) == pytest.approx(window.width_deg, abs=6e-4)
        assert float(drop) == pytest.approx(abs(window.drop), abs=6e-7)
        assert float(climb) == pytest.approx(abs(window.climb), abs=6e-7)
        assert (snap == "") == (fall == "") == (window.snap is None)
        if window.snap is not None:
            assert float(snap) == pytest.approx(window.snap.phase_deg, abs=2e-6)
            assert float(fall) == pytest.approx(window.snap.fall, abs=6e-7)
