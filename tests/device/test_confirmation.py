"""Paths confirmed by half the step: what is flagged, and what is not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from threadstate.device import assemble
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, PathEvent, PathEventKind
from threadstate.device.confirmation import confirmed, have_same_falls, heavy_falls
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

UNC = quarter_twenty_unc()
CALM = (1.0, -2.0, 10.0)
FALLING = (1.2777020959327414, 2.484915940493546, -168.16116983823713)
"""With friction 0.2, turned clockwise, it falls."""


def test_a_path_that_half_the_step_does_not_change_is_as_it_is_alone() -> None:
    of = (UNC, *CALM, None, Strategy.CW)
    assert assemble_pose(*of, mu=0.1, confirm=True) == assemble_pose(*of, mu=0.1)


@pytest.mark.parametrize("kind", [PathEventKind.FALL, PathEventKind.GAINED])
def test_with_friction_an_event_that_half_the_step_moves_is_flagged_beside_the_outcome(kind: PathEventKind) -> None:
    """Where it moves it by more than the longest step."""
    path = assemble_pose(UNC, *FALLING, strategy=Strategy.CW, mu=0.2)
    at = max((i for i, event in enumerate(path.events) if event.kind is kind), key=lambda i: path.events[i].energy or 0)
    for moved_deg, flags in ((0.9, ()), (1.1, (SettledFlag.STEP_DEPENDENT,))):
        event = replace(path.events[at], phase_deg=path.events[at].phase_deg + moved_deg)
        half = replace(path, events=(*path.events[:at], event, *path.events[at + 1 :]))
        found = confirmed(path, half, 1.0, 1.0)
        assert (found.outcome, found.flags) == (path.outcome, (*path.flags, *flags))
    assert path.outcome is not AssemblyOutcome.UNDECIDED


def test_another_outcome_with_half_the_step_is_undecided() -> None:
    path = assemble_pose(UNC, *CALM, strategy=Strategy.CW)
    found = confirmed(path, replace(path, outcome=AssemblyOutcome.JAMMED), 2.0, 1.0)
    assert (found.outcome, found.flags) == (AssemblyOutcome.UNDECIDED, (SettledFlag.STEP_DEPENDENT,))
    assert found.points == path.points


def test_an_undecided_path_is_not_followed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    undecided = replace(assemble_pose(UNC, *CALM, strategy=Strategy.CW), outcome=AssemblyOutcome.UNDECIDED)
    answers = [undecided]
    monkeypatch.setattr(assemble, "_followed", lambda *_: answers.pop())
    assert assemble_pose(UNC, *CALM, confirm=True) is undecided


def test_without_friction_a_contact_that_half_the_step_moves_is_flagged() -> None:
    path = assemble_pose(UNC, *CALM, strategy=Strategy.CW)
    at = next(i for i, event in enumerate(path.events) if event.kind is PathEventKind.GAINED)
    for moved_deg, flags in ((0.02, ()), (0.1, (SettledFlag.STEP_DEPENDENT,))):
        event = replace(path.events[at], phase_deg=path.events[at].phase_deg + moved_deg)
        half = replace(path, events=(*path.events[:at], event, *path.events[at + 1 :]))
        found = confirmed(path, half, 2.0, 1.0)
        assert (found.outcome, found.flags) == (path.outcome, flags)


@pytest.mark.parametrize("step", [0.25, 0.49, 2.1])
def test_a_step_of_which_no_half_can_be_followed_names_the_valid_range(step: float) -> None:
    with pytest.raises(InvalidValueError, match=r"longest_step is .*; valid: 0\.5 to 2 deg with `confirm`"):
        assemble_pose(UNC, *CALM, longest_step=step, confirm=True)


def test_falls_within_a_step_are_one_and_light_ones_are_left_out() -> None:
    falls = [(10.0, 8e-4), (9.0, 4e-4), (4.0, 9e-4), (1.0, 2e-3)]
    assert heavy_falls(falls, 1.0, 1e-3) == (10.0, 1.0)
    assert heavy_falls(falls, 0.5, 1e-3) == (1.0,)


def test_snaps_are_compared_and_light_falls_are_not() -> None:
    path = replace(assemble_pose(UNC, *CALM, strategy=Strategy.CW), events=())
    snap = PathEvent(PathEventKind.SNAP, 350.0, 350.0)
    light, heavy = (PathEvent(PathEventKind.FALL, 340.0, 340.0, energy=energy) for energy in (1e-5, 1.0))
    snaps = replace(path, events=(snap,))
    assert have_same_falls(snaps, replace(path, events=(light, replace(snap, phase_deg=350.9))), 1.0, 1e-3)
    assert not have_same_falls(snaps, replace(path, events=(replace(snap, phase_deg=351.1),)), 1.0, 1e-3)
    assert not have_same_falls(snaps, replace(path, events=(heavy, snap)), 1.0, 1e-3)
