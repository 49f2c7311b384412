"""The study of paths with friction, of a few short ones: energy, halves of the step, and its page."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studies.paths.changes import Halves, Pose, Turned, turned
from studies.paths.changes_section import changes_section
from studies.paths.page import page
from studies.paths.study import ACCURACY, STEPS_DEG, Compared, Followed, Found, done
from threadstate.device.assembly_model import AssemblyOutcome, PathEventKind
from threadstate.device.contact_changes import Comparison, ContactChange
from threadstate.state.model import FeaturePair

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


def test_the_section_without_friction_counts_what_one_step_tells_alone() -> None:
    engaged, bridged = Turned(AssemblyOutcome.ENGAGED, False, 0), Turned(AssemblyOutcome.ENGAGED, True, 2)
    undecided = Turned(AssemblyOutcome.UNDECIDED, False, 0)
    gained = ContactChange(PathEventKind.GAINED, FeaturePair.EDGE_THREAD, 12.345)
    alike, unlike = Comparison((0.001, 0.003), (), ()), Comparison((), (gained,), ())
    same, other = Halves(alike, True), Halves(unlike, False)
    text = changes_section(
        [
            Pose("the same", (engaged, engaged, engaged), (same, same)),
            Pose("another", (bridged, engaged, engaged), (other, same)),
            Pose("undecided", (undecided, undecided, engaged), (same, same)),
            Pose("idle", (replace(engaged, outcome=AssemblyOutcome.IDLE), engaged, undecided), (same, same)),
        ]
    )
    assert "| 2, 1 | 3 | 1 | 1 | 1 | 4 | 2.0e-03, 3.0e-03, 3.0e-03 |" in text
    assert "| 1, 0.5 | 2 | 0 | 0 | 0 | 4 |" in text
    assert "1 of the paths are bridged somewhere, and 1 flagged" in text
    assert "- another: gained edge-thread at 12.35 by the first\n" in text
    assert "### Other outcomes, steps of 2, 1 deg\n\n- idle\n" in text


def test_the_page_lists_what_half_the_step_moves() -> None:
    path = Followed("turned", 1e-5, 0.1, 0.0, 0.0, (10.0,), (), (0.0, 0.0, -0.1), ambiguous=False, seconds=1.0)
    beside = replace(path, falls_deg=(10.9,))
    other = replace(path, end="jammed", falls_deg=(11.5,), place=(0.0, 0.0, -0.2))
    gained = ContactChange(PathEventKind.GAINED, FeaturePair.EDGE_THREAD, 3.0)
    fewer = replace(path, falls_deg=(), changes=(gained,))
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
    assert "## Other contacts, steps of 0.5 and 0.25 deg\n\n- fewer: 0 and 1 alone\n" in text
    assert "| undecided, flush | 1 |" in text


def test_paths_without_friction_change_alike_with_half_the_step() -> None:
    poses = [turned(number) for number in range(3)]
    for pose in poses:
        assert pose.is_decided(0)
        assert pose.is_decided(1)
        assert all(half.changes.is_alike and half.same_falls for half in pose.halves)
