"""The study of paths with friction, of a few short ones: energy, half the step, and its page."""

from __future__ import annotations

import pytest

from studies.paths.page import page
from studies.paths.study import ACCURACY, Compared, Followed, Found, done

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
    paths = [path for one in found.paths for path in (one.whole, one.half) if path is not None]
    assert len(paths) == 2 * len(NUMBERS)
    for path in paths:
        assert abs(path.balance) < 1e-4
        assert path.least_loss > -1e-9
        assert path.friction > 0.0


def test_half_the_step_ends_at_the_same_place(found: Found) -> None:
    ended = [one for one in found.paths if one.is_ended]
    assert len(ended) == len(NUMBERS)
    assert all(one.moved < ACCURACY for one in ended)


def test_the_page_lists_what_half_the_step_moves() -> None:
    path = Followed("turned", 1e-5, 0.1, 0.0, 0.0, (10.0,), (0.0, 0.0, -0.1), ambiguous=False, seconds=1.0)
    other = Followed("jammed", 1e-5, 0.1, 0.0, 0.0, (10.5,), (0.0, 0.0, -0.2), ambiguous=False, seconds=1.0)
    found = Found(TURN_DEG)
    found.add(Compared("the same", "settled", "settled", path, path))
    found.add(Compared("another", "settled", "settled", path, other))
    found.add(Compared("flush", "undecided, flush", "undecided, flush"))
    text = page(found)
    assert "Of the 2 paths" in text
    assert "## Other outcomes with half the step\n\n- another\n" in text
    assert "- the same" not in text
    assert "| undecided, flush | 1 |" in text
