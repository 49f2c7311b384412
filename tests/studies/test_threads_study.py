"""The study of threads: what is looked at of a pair, and the page of it."""

from __future__ import annotations

import pytest

from studies.threads.page import page, play_picture
from studies.threads.study import CLASSES, FITS, FORMS, SIZES, Thread, looked_at, orientations
from threadstate.responses.histories import computed_history
from threadstate.thread.catalogue import pair_by_designation

pytestmark = pytest.mark.slow


def made_up(designation: str) -> Thread:
    """A pair whose numbers are told apart on the page."""
    play = 0.01 + len(designation) / 1000.0
    return Thread(designation, designation.split()[-1], play, (10.0, 1000.0 * play, 99.5), (0.02, 2.0 * play, 0.33))


def test_windows_and_falls_are_those_of_the_histories() -> None:
    pair = pair_by_designation("M6 at minimum material")
    found = looked_at("m6 at minimum", (2.0,))
    history = computed_history(pair, 2.0, 2.0)
    assert found.designation == pair.designation
    assert found.windows_deg == (sum(window.width_deg for window in history.windows),)
    assert history.falls.steepest is not None
    assert found.falls == (history.falls.steepest.fall / pair.thread_pitch,)
    assert found.window_deg == found.windows_deg[0] > 0.0
    assert found.snaps == (found.fall > 0.05)


def test_the_level_orientation_is_left_out() -> None:
    assert orientations((-1.0, 0.0, 1.0)) == [(r, p) for r in (-1.0, 0.0, 1.0) for p in (-1.0, 0.0, 1.0) if r or p]


def test_every_pair_of_the_study_is_on_the_page_by_the_name_of_the_catalogue() -> None:
    names = list(dict.fromkeys([*CLASSES, *FORMS, *FITS, *SIZES]))
    found = {name: made_up(name) for name in names}
    text = page(found)
    for name, one in found.items():
        assert f"| {name} | {100 * one.play:.1f} | {one.window_deg:.1f} | 99.5 | {100 * one.fall:.1f} | 33.0 | " in text
        assert pair_by_designation(name).designation in (name, "1/4-20 UNC"), name
    drawn = play_picture(list(found.values()))
    assert drawn == play_picture(list(found.values()))
    assert "axial play" in drawn
