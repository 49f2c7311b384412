"""Paths with friction that come to those of other starting phases, beside the same paths followed to their own ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _friction_kernel as fk
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath
from threadstate.device.branches import Followed, FollowedLeg, KnownPaths
from threadstate.device.friction import FrictionLeg, FrictionPath
from threadstate.device.model import Outcome
from threadstate.device.settle import settle_pose
from threadstate.device.strategy import Strategy
from threadstate.success.bounded import cell_of
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()


def assert_alike(with_known: AssemblyPath, alone: AssemblyPath) -> None:
    """Both end alike, at the same phase, and ask the same of the device."""
    found, wanted = cell_of(with_known), cell_of(alone)
    assert (found.outcome, found.flags) == (wanted.outcome, wanted.flags)
    assert found.end_deg == pytest.approx(wanted.end_deg, abs=0.1)
    assert found.torque == pytest.approx(wanted.torque, rel=5e-3)
    assert found.tilt_deg == pytest.approx(wanted.tilt_deg, abs=5e-3)
    assert found.shift == pytest.approx(wanted.shift, rel=5e-3, abs=1e-5)


@pytest.mark.parametrize(
    ("pair", "roll", "pitch", "mu", "strategy", "outcomes"),
    [
        (UNC, 3.0, -3.0, 0.2, Strategy.CW, {AssemblyOutcome.ENGAGED, AssemblyOutcome.IDLE}),
        (UNC, 0.0, -4.0, 0.1, Strategy.CCW_THEN_CW, {AssemblyOutcome.ENGAGED}),
        (UNC, 2.0, 2.0, 0.2, Strategy.CCW_THEN_CW, {AssemblyOutcome.NO_SNAP}),
        (pair_by_designation("1/4-20 UNC-2A/2B LH"), 1.0, -3.0, 0.1, Strategy.CW, None),
    ],
)
def test_a_path_that_comes_to_a_known_one_ends_as_it_does_alone(
    pair: Pair, roll: float, pitch: float, mu: float, strategy: Strategy, outcomes: set[AssemblyOutcome] | None
) -> None:
    known = KnownPaths()
    found = set()
    for phase in (0.0, 75.0, 345.0):
        path = assemble_pose(pair, roll, pitch, phase, strategy=strategy, mu=mu, known=known)
        alone = assemble_pose(pair, roll, pitch, phase, strategy=strategy, mu=mu)
        assert_alike(path, alone)
        found.add(path.outcome)
    assert outcomes is None or found == outcomes


def test_a_path_that_ends_at_an_overlap_of_a_known_one_is_followed_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A step may leave overlaps that no end may have, of which the known path's is no end."""
    known = KnownPaths()
    assemble_pose(UNC, 2.0, 1.0, 0.0, strategy=Strategy.CW, mu=0.3, known=known)
    alone = assemble_pose(UNC, 2.0, 1.0, 60.0, strategy=Strategy.CW, mu=0.3)
    assert assemble_pose(UNC, 2.0, 1.0, 60.0, strategy=Strategy.CW, mu=0.3, known=known) != alone
    is_free = FrictionPath.is_free
    asked: list[Floats] = []

    def is_free_but_at_the_first_end(path: FrictionPath, row: Floats) -> bool:
        asked.append(row)
        return len(asked) > 1 and is_free(path, row)

    monkeypatch.setattr(FrictionPath, "is_free", is_free_but_at_the_first_end)
    assert assemble_pose(UNC, 2.0, 1.0, 60.0, strategy=Strategy.CW, mu=0.3, known=known) == alone
    assert len(asked) == 2


def test_what_a_path_takes_from_a_known_one_are_its_points_whole_turns_later() -> None:
    known = KnownPaths()
    first = assemble_pose(UNC, 1.0, -3.0, 0.0, mu=0.2, known=known)
    late = assemble_pose(UNC, 1.0, -3.0, 330.0, mu=0.2, known=known)
    assert (first.outcome, late.outcome) == (AssemblyOutcome.ENGAGED, AssemblyOutcome.ENGAGED)
    assert late.points[0].phase_deg == pytest.approx(330.0)
    phases = np.array([point.phase_deg for point in late.points])
    turning = phases[: int(np.argmax(phases)) + 1]
    assert (np.diff(turning) > 0.0).all()
    poses = {point.pose for point in first.points}
    taken = [point.pose in poses for point in late.points]
    start = taken.index(True)
    assert 0 < start < len(taken) // 2
    assert all(taken[start:])


def test_the_step_after_a_fall_begins_where_the_fall_ended() -> None:
    """One edge slides and one holds as the push grows; each of the shortest steps would fall, by next to nothing."""
    state = settle_pose(UNC, -4.0, -3.0, 150.0, mu=0.1)
    assert state.outcome is Outcome.SETTLED
    assert len(state.path) < 100


def test_the_order_in_which_paths_become_known_moves_no_outcome() -> None:
    phases = (0.0, 90.0, 180.0, 270.0)
    by_order = []
    for ordered in (phases, phases[::-1]):
        known = KnownPaths()
        paths = {
            phase: assemble_pose(UNC, 3.0, -3.0, phase, strategy=Strategy.CW, mu=0.1, known=known) for phase in ordered
        }
        by_order.append([paths[phase].outcome for phase in phases])
    assert by_order[0] == by_order[1]


def path_of(*legs: FollowedLeg) -> Followed:
    """The only path of a start."""
    return Followed([list(legs)], True, 1)


LEG = FollowedLeg(FrictionLeg(0, np.zeros((2, fk.POINT_SIZE)), np.zeros((2, 8, 18)), (), has_more=False), [], [])


def test_neither_several_paths_nor_an_undecided_one_become_known() -> None:
    known = KnownPaths()
    known.add(Followed([[LEG], [LEG]], True, 2), AssemblyOutcome.ENGAGED)
    known.add(replace(path_of(LEG), is_whole=False), AssemblyOutcome.ENGAGED)
    known.add(path_of(LEG), AssemblyOutcome.UNDECIDED)
    assert len(known) == 0
    known.add(path_of(LEG), AssemblyOutcome.ENGAGED)
    assert len(known) == 1
    unsettled = KnownPaths()
    # Its paths end unlike one another.
    path = assemble_pose(UNC, 4.0, 2.0, 0.0, strategy=Strategy.CW, mu=0.02, known=unsettled)
    assert path.outcome is AssemblyOutcome.UNDECIDED
    assert len(unsettled) == 0


def test_a_path_that_has_come_to_a_known_one_becomes_known_if_it_ends_otherwise() -> None:
    """The turn from phase 0 ends before the snap; 90 goes on as it does, then snaps; 180 has nothing to add."""
    known = KnownPaths()
    found = []
    for phase in (0.0, 90.0, 180.0):
        path = assemble_pose(UNC, 2.0, -1.0, phase, mu=0.3, known=known)
        found.append((path.outcome, len(known)))
    no_snap, engaged = AssemblyOutcome.NO_SNAP, AssemblyOutcome.ENGAGED
    assert found == [(no_snap, 1), (engaged, 2), (engaged, 2)]
    known.forget_last()
    assert len(known) == 1
