"""Contacts gained and lost on a path hang on the bolt, not on how long its steps are."""

from __future__ import annotations

import math

import pytest

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, PathEvent, PathEventKind
from threadstate.device.contact_changes import (
    RESOLVED_WITH_FRICTION_DEG,
    Comparison,
    ContactChange,
    compare_changes,
    contact_changes,
)
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

UNC = quarter_twenty_unc()
RESOLVED_DEG = 0.02
GAINED, LOST, MOVED = PathEventKind.GAINED, PathEventKind.LOST, PathEventKind.MOVED
EDGE, THREAD = FeaturePair.EDGE_THREAD, FeaturePair.THREAD_EDGE

CASES = {
    "two are gained and lost within a step": (-2.742742707226993, -2.095902380267738, 39.94111007208528),
    "another one of the same features beside it": (-2.3755744498838967, -3.933979517669963, 30.061295091703684),
    "lost and gained elsewhere": (-0.026066807652257218, 3.3674105523929265, 151.238672917897),
    "a maximum just within the edge": (-3.2353832990191798, -2.7722516343658636, 314.9378386975877),
    "one that the search finds late": (-2.4330366425938035, -0.2752182220840833, 144.57426944382783),
    "two that take turns, found late": (-2.5226962823772787, -0.34513829936476537, 84.66576680915735),
    "a minimum that ends in a fold": (-3.640821439054138, -3.154783963693709, 9.401046893915268),
    "a maximum within the edge across a fillet": (-3.497266487385609, -2.610932743904799, 234.493434238989),
}
FINER_CASES = {
    "two beside each other on an edge": (-0.48918406288286764, -3.419574175448245, 136.10249608017332),
    "into the threads and back within a step": (-1.4251443118400662, -0.10705262631250356, 92.22327816760749),
    "from a flank to the fillet beside it": (-2.2826547470836775, 0.508422275923138, 173.66104075000817),
}
STEPS = {name: (pose, 2.0) for name, pose in CASES.items()} | {name: (pose, 1.0) for name, pose in FINER_CASES.items()}


@pytest.mark.parametrize(("pose_deg", "longest_step"), STEPS.values(), ids=STEPS.keys())
def test_half_the_step_neither_adds_nor_moves_a_change(
    pose_deg: tuple[float, float, float], longest_step: float
) -> None:
    path, half = (assemble_pose(UNC, *pose_deg, longest_step=step) for step in (longest_step, 0.5 * longest_step))
    assert half.outcome is path.outcome is not AssemblyOutcome.UNDECIDED
    found = compare_changes(contact_changes(path.events), contact_changes(half.events), RESOLVED_DEG)
    assert found.is_alike
    assert len(found.apart_deg) > 5


@pytest.mark.parametrize(
    ("pose_deg", "mu"),
    [
        ((1.425362758167977, -2.1924088902434304, 83.25319090770529), 0.02),
        ((2.5403161557957556, -2.683617268277298, 47.96295857821963), 0.05),
        ((-1.5843338859349023, -2.846421054112774, 69.43697983638071), 0.05),
    ],
)
def test_with_friction_a_contact_that_a_like_one_takes_over_from_is_told_alike_with_half_the_step(
    pose_deg: tuple[float, float, float], mu: float
) -> None:
    """Both are there for less than a step, and of the same features."""
    path, half = (assemble_pose(UNC, *pose_deg, mu=mu, strategy=Strategy.CW, longest_step=step) for step in (1.0, 0.5))
    assert half.outcome is path.outcome is not AssemblyOutcome.UNDECIDED
    changes, halved = contact_changes(path.events), contact_changes(half.events)
    found = compare_changes(changes, halved, 0.5, RESOLVED_WITH_FRICTION_DEG)
    assert found.is_alike
    assert len(found.apart_deg) > 5


def test_changes_are_told_within_a_small_step() -> None:
    path = assemble_pose(UNC, *CASES["two are gained and lost within a step"])
    widths = [abs(event.phase_deg - event.from_deg) for event in path.events if event.kind in (GAINED, LOST, MOVED)]
    assert max(widths) <= 0.005 * (1.0 + 1e-6)
    assert all(math.isfinite(width) for width in widths)


def test_a_path_goes_on_where_a_contact_crosses_a_crease() -> None:
    """Either side of the crease leads to the other: a step of the descent has to make it smaller."""
    path = assemble_pose(UNC, -1.8661314301860763, -2.320878958908146, 101.22638943044477)
    assert (path.outcome, path.flags) == (AssemblyOutcome.ENGAGED, ())
    assert not any(event.kind is PathEventKind.BRIDGED for event in path.events)


def test_a_bolt_at_a_minimum_beside_the_level_pose_is_not_laid_flush() -> None:
    """It lies 0.2 deg from level, 0.014 F r above the level pose, and stays until its minimum ends."""
    falls = []
    for step in (2.0, 1.0, 0.5):
        path = assemble_pose(UNC, 1.0750206613707132, 2.4776256623959982, 156.51845546785984, longest_step=step)
        falls.append([event.phase_deg for event in path.events if event.kind is PathEventKind.FALL])
    assert falls[0] == pytest.approx(falls[1], abs=RESOLVED_DEG)
    assert falls[0] == pytest.approx(falls[2], abs=RESOLVED_DEG)
    assert falls[0][-1] == pytest.approx(391.18, abs=RESOLVED_DEG)


def test_a_fall_that_hangs_on_its_steps_ends_as_with_shorter_ones_and_is_flagged() -> None:
    """Beside where descents part long steps end 5e-4 F r deeper, in another minimum."""
    paths = [
        assemble_pose(UNC, 1.3929979516302895, 0.722072336985554, 278.86500036401236, longest_step=step)
        for step in (2.0, 1.0)
    ]
    falls = [[event.energy for event in path.events if event.kind is PathEventKind.FALL] for path in paths]
    assert falls[0] == pytest.approx(falls[1], rel=2e-2)
    assert any(SettledFlag.STEP_DEPENDENT in path.flags for path in paths)


def test_a_contact_that_moves_is_lost_and_gained() -> None:
    moved = PathEvent(MOVED, 10.0, 10.0, EDGE, THREAD)
    assert contact_changes([moved]) == (ContactChange(GAINED, THREAD, 10.0), ContactChange(LOST, EDGE, 10.0))


def test_changes_that_one_path_has_alone_are_told() -> None:
    one = (ContactChange(GAINED, EDGE, 10.0), ContactChange(LOST, EDGE, 5.0))
    other = (ContactChange(GAINED, EDGE, 10.25), ContactChange(LOST, EDGE, 3.0))
    alone = ((ContactChange(LOST, EDGE, 5.0),), (ContactChange(LOST, EDGE, 3.0),))
    assert compare_changes(one, other, 1.0) == Comparison((0.25,), *alone)


def test_an_exchange_for_one_of_the_same_features_is_left_out() -> None:
    gained = ContactChange(GAINED, EDGE, 10.0)
    assert compare_changes((gained, ContactChange(LOST, EDGE, 9.995)), (), 1.0).is_alike
    assert not compare_changes((gained, ContactChange(LOST, EDGE, 9.9)), (), 1.0).is_alike
    assert not compare_changes((gained, ContactChange(LOST, THREAD, 10.0)), (), 1.0).is_alike
