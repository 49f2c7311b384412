"""The study of paths with friction, of a few short ones: energy, halves of the step, and its page."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studies.paths.page import page
from studies.paths.study import ACCURACY, STEPS_DEG, Compared, Followed, Found, done

pytestmark = pytest.mark.slow

TURN_DEG = 20.0
NUMBERS = (5, 7, 8, 13, 17, 18, 20)


@pytest.fixture(scope="module")
def found() -> Found:
    """Commands that settle, turned by 20 deg."""
    found = Found(TURN_DEG)
    for number in NUMBERS:
        found.add(done((number, TURN_DEG)))
    return found


def test_energy_is_balanced_and_no_step_gains_by_friction(found: Found) -> None:
    paths = [path for one in found.paths for path in one.paths if path is not None]
    assert len(paths) == len(STEPS_DEG) * len(NUMBERS)
    for path in paths:
        assert abs(path.balance) < 1e-4
        assert path.least_loss > -1e-9
        assert path.friction > 0.0


@pytest.mark.parametrize("number", [0, 1])
def test_half_the_step_ends_at_the_same_place(found: Found, number: int) -> None:
    both = [halved for one in found.paths if (halved := one.halved(number)) is not None]
    assert len(both) == len(NUMBERS)
    assert all(one.is_ended and one.moved < ACCURACY for one in both)


def test_the_page_lists_what_half_the_step_moves() -> None:
    path = Followed("turned", 1e-5, 0.1, 0.0, 0.0, (10.0,), (0.0, 0.0, -0.1), ambiguous=False, seconds=1.0)
    beside = replace(path, falls_deg=(10.9,))
    other = replace(path, end="jammed", falls_deg=(11.5,), place=(0.0, 0.0, -0.2))
    fewer = replace(path, falls_deg=())
    settled = ("settled",) * 3
    found = Found(TURN_DEG)
    found.add(Compared("the same", settled, (path, beside, path)))
    found.add(Compared("another", settled, (path, other, other)))
    found.add(Compared("fewer", settled, (path, path, fewer)))
    found.add(Compared("flush", ("undecided, flush",) * 3, (None, None, None)))
    text = page(found)
    assert "| 1, 0.5 | 3 | 1 | 1 |" in text
    assert "| 0.5, 0.25 | 3 | 0 | 2 |" in text
    assert "## Other outcomes, steps of 1 and 0.5 deg\n\n- another\n" in text
    assert "## Falls moved by more, steps of 1 and 0.5 deg\n\n- another: 1.50 deg\n" in text
    assert "## Falls moved by more, steps of 0.5 and 0.25 deg\n\n- the same: 0.90 deg\n- fewer: 1 and 0\n" in text
    assert "| undecided, flush | 1 |" in text
