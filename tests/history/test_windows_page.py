"""The tables of docs/windows.md against falls and histories that are computed again."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.falls_page import falls_shown, table, text_of
from threadstate.history.build import history_of
from threadstate.history.descents import falls_of
from threadstate.history.falls import SNAP_PITCHES
from threadstate.history.height_curve import height_curve
from threadstate.history.window import windows_of
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
ORIENTATIONS = 81
FALLS, WINDOWS, JUMPS = range(3)
"""The page's tables."""


def number(cell: str) -> float | None:
    """A cell's number; None where it is empty."""
    return float(cell) if cell else None


def test_every_orientation_is_in_the_tables(repository_root: Path) -> None:
    page = text_of(repository_root)
    tilts = [(str(roll), str(pitch)) for roll in range(-4, 5) for pitch in range(-4, 5)]
    assert [tuple(row[:2]) for row in table(page, FALLS)] == tilts
    assert {tuple(row[:2]) for row in table(page, WINDOWS)} == set(tilts)
    assert len(tilts) == ORIENTATIONS


@pytest.mark.parametrize(
    ("roll", "pitch"), [(0, -4), (-4, -4), (-3, -4), (-1, -4), (4, 0), (-2, -3), (4, -1), (0, 0), (-4, 2), (2, 4)]
)
def test_the_falls_shown_are_those_computed(repository_root: Path, roll: int, pitch: int) -> None:
    shown = falls_shown(repository_root)[roll, pitch]
    falls = falls_of(height_curve(PAIR, float(roll), float(pitch)), PAIR.thread_pitch)
    assert falls.steepest is not None
    assert number(shown.steepest) == pytest.approx(falls.steepest.fall, abs=6e-7)
    assert number(shown.steepest_from) == pytest.approx(falls.steepest.start_deg, abs=2e-6)
    snap = falls.snap(SNAP_PITCHES * PAIR.thread_pitch)
    assert shown.snaps == (snap is not None)
    if snap is not None:
        jump = snap.largest_jump
        assert number(shown.snap_from) == pytest.approx(snap.start_deg, abs=2e-6)
        assert number(shown.snap_to) == pytest.approx(snap.end_deg, abs=2e-6)
        assert number(shown.fall) == pytest.approx(snap.fall, abs=6e-7)
        assert number(shown.jump) == pytest.approx(jump.fall if jump else 0.0, abs=6e-7)
        assert number(shown.jump_at) == (pytest.approx(jump.phase_deg, abs=2e-6) if jump else None)
    jumps = [row[2:] for row in table(text_of(repository_root), JUMPS) if row[:2] == [str(roll), str(pitch)]]
    computed = [jump for descent in falls.descents for jump in descent.jumps]
    assert len(jumps) == len(computed)
    for (phase, error, before, behind, height_error, fall), jump in zip(jumps, computed, strict=True):
        assert float(phase) == pytest.approx(jump.phase_deg, abs=2.0 * float(error) + 2e-10)
        assert float(before) == pytest.approx(jump.height_before, abs=2.0 * float(height_error) + 2e-12)
        assert float(behind) == pytest.approx(jump.height_after, abs=2.0 * float(height_error) + 2e-12)
        assert float(fall) == pytest.approx(jump.fall, abs=6e-7)


@pytest.mark.parametrize(("roll", "pitch"), [(0, -4), (4, 0), (-2, -4)])
def test_the_windows_shown_are_those_computed(repository_root: Path, roll: int, pitch: int) -> None:
    rows = [row[2:] for row in table(text_of(repository_root), WINDOWS) if row[:2] == [str(roll), str(pitch)]]
    windows = windows_of(PAIR, history_of(PAIR, float(roll), float(pitch)))
    assert len(rows) == len(windows)
    for (enter, leave, width, climb), window in zip(rows, windows, strict=True):
        assert float(enter) == pytest.approx(window.enter_deg, abs=2e-6)
        assert float(leave) == pytest.approx(window.leave_deg, abs=2e-6)
        assert float(width) == pytest.approx(window.width_deg, abs=6e-4)
        assert float(climb) == pytest.approx(abs(window.climb), abs=6e-7)
