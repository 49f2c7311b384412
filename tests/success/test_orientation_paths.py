"""Paths of an orientation: others go on as one of them does only if that ends alike with half the step."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.branches import Followed
from threadstate.device.model import SettledFlag, default_device
from threadstate.device.strategy import Strategy
from threadstate.success import orientation_paths
from threadstate.success.model import Cell
from threadstate.success.orientation_paths import OrientationPaths
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR, DEVICE = quarter_twenty_unc(), default_device()
ENGAGED, NO_SNAP, UNDECIDED = AssemblyOutcome.ENGAGED, AssemblyOutcome.NO_SNAP, AssemblyOutcome.UNDECIDED


class Paths:
    """Stands for the paths that are followed: those from one phase end otherwise with half the step."""

    def __init__(self, otherwise_deg: float | None = None) -> None:
        self.otherwise_deg = otherwise_deg
        self.asked: list[tuple[float, float | None, int, int | None]] = []
        self.now = 0.0

    def __call__(self, *given: Any) -> Cell:
        pose_deg, mu, point_limit, longest_step_deg, known, _ = given[3:]
        self.asked.append((pose_deg[2], longest_step_deg, point_limit, None if known is None else len(known)))
        self.now += 1.0
        is_half = longest_step_deg is not None
        outcome = NO_SNAP if is_half and pose_deg[2] == self.otherwise_deg else ENGAGED
        if known is not None and not known:
            known.add(Followed([[]], True, 1), outcome)
        return Cell(pose_deg[2], mu, outcome, (), False, None, None, None, None)


def paths_of(monkeypatch: pytest.MonkeyPatch, followed: Paths, *, has_several: bool = True) -> OrientationPaths:
    """The paths of an orientation as the stand-in has them."""
    monkeypatch.setattr(orientation_paths, "bounded_cell", followed)
    monkeypatch.setattr(orientation_paths, "time", SimpleNamespace(monotonic=lambda: followed.now))
    return OrientationPaths(PAIR, DEVICE, Strategy.CW, 1.0, 2.0, 900, has_several)


def test_a_path_that_others_may_go_on_as_is_followed_once_more_with_half_the_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    followed = Paths()
    paths = paths_of(monkeypatch, followed)
    cells = [paths.cell(phase_deg, 0.3) for phase_deg in (0.0, 30.0)]
    assert [cell.outcome for cell in cells] == [ENGAGED, ENGAGED]
    assert followed.asked == [(0.0, None, 900, 0), (0.0, 0.5, 1800, None), (30.0, None, 900, 1)]
    # A boundary asks for it again.
    assert paths.ends_alike(cells[0])
    assert len(followed.asked) == 3


def test_one_that_ends_otherwise_is_undecided_and_no_other_goes_on_as_it(monkeypatch: pytest.MonkeyPatch) -> None:
    followed = Paths(otherwise_deg=0.0)
    paths = paths_of(monkeypatch, followed)
    first, second, third = (paths.cell(phase_deg, 0.3) for phase_deg in (0.0, 30.0, 60.0))
    assert (first.outcome, first.flags) == (UNDECIDED, (SettledFlag.STEP_DEPENDENT,))
    assert (second.outcome, third.outcome) == (ENGAGED, ENGAGED)
    assert [known for _, step, _, known in followed.asked if step is None] == [0, 0, 1]


def test_each_friction_has_its_own_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    followed = Paths()
    paths = paths_of(monkeypatch, followed)
    for mu in (0.1, 0.2):
        paths.cell(0.0, mu)
    assert [known for _, step, _, known in followed.asked if step is None] == [0, 0]


def test_a_single_path_is_followed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    followed = Paths(otherwise_deg=0.0)
    assert paths_of(monkeypatch, followed, has_several=False).cell(0.0, 0.3).outcome is ENGAGED
    assert followed.asked == [(0.0, None, 900, None)]


@pytest.mark.parametrize("otherwise_deg", [None, 0.0])
def test_without_time_for_half_the_step_no_other_goes_on_as_it(
    otherwise_deg: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    followed = Paths(otherwise_deg)
    paths = paths_of(monkeypatch, followed)
    assert paths.cell(0.0, 0.3, 1.5).outcome is ENGAGED
    assert paths.cell(30.0, 0.3, 9.0).outcome is ENGAGED
    assert [known for _, step, _, known in followed.asked if step is None] == [0, 0]


@pytest.mark.slow
def test_paths_of_an_orientation_end_alike() -> None:
    """From roll -4, pitch -4, phase 0 the bolt engaged with steps of 1 deg alone, by a jump (decision 52)."""
    paths = OrientationPaths(PAIR, DEVICE, Strategy.CCW_THEN_CW, -4.0, -4.0, 1000, has_several=True)
    first, second = (paths.cell(phase_deg, 0.3) for phase_deg in (0.0, 60.0))
    assert (first.outcome, first.flags) == (NO_SNAP, ())
    assert (second.outcome, second.flags) == (NO_SNAP, ())


@pytest.mark.slow
def test_a_single_path_that_snaps_as_its_turn_ends_is_undecided_if_half_the_step_does_not_snap() -> None:
    """From roll 3, pitch -3, phase 0 steps of 1 deg snap at 359.975 deg, and shorter ones not within the turn."""
    of = (PAIR, DEVICE, Strategy.CCW_THEN_CW, 3.0, -3.0, 1000)
    cell = OrientationPaths(*of, has_several=False).cell(0.0, 0.3)
    assert (cell.outcome, cell.flags) == (UNDECIDED, (SettledFlag.STEP_DEPENDENT,))
    farther = replace(DEVICE, ccw_turn_deg=390.0)
    cell = OrientationPaths(PAIR, farther, *of[2:], has_several=False).cell(0.0, 0.3)
    assert (cell.outcome, cell.flags) == (ENGAGED, ())
