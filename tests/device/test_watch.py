"""Paths that another thread watches, and stops."""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import pairwise

import pytest

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyPath
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathProgress, PathStoppedError, PathWatch
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

UNC = quarter_twenty_unc()
PAPER = (0.0, -4.0, 300.0)
LONGEST_S = 60.0
LOOK_S = 0.001


def watched(path: Future[AssemblyPath], watch: PathWatch) -> list[PathProgress]:
    """How far a path is, each time that this has changed, until it has ended."""
    seen = [watch.progress()]
    while not path.done():
        if (progress := watch.progress()) != seen[-1]:
            seen.append(progress)
        time.sleep(LOOK_S)
    return [*seen, watch.progress()]


def test_events_and_phases_are_those_of_the_path_in_their_order() -> None:
    watch = PathWatch()
    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(assemble_pose, UNC, *PAPER, watch=watch)
        seen = watched(running, watch)
    path = running.result()
    assert path == assemble_pose(UNC, *PAPER)
    assert (seen[-1].leg, seen[-1].events) == (2, path.events)
    phases = {point.phase_deg for point in path.points}
    for progress in seen:
        assert progress.events == path.events[: len(progress.events)]
        assert progress.phase_deg is None or progress.phase_deg in phases
    for before, after in pairwise(seen):
        assert before.leg <= after.leg
        assert len(before.events) <= len(after.events)
        assert before.leg < after.leg or before.points <= after.points or after.points == 0
    # Not all at once at the end.
    assert len({len(progress.events) for progress in seen}) > 3


def test_a_path_that_is_confirmed_shows_nothing_of_the_half_step_and_can_be_stopped() -> None:
    alone, watch = PathWatch(), PathWatch()
    assemble_pose(UNC, *PAPER, watch=alone)
    with ThreadPoolExecutor(1) as pool:
        seen = watched(pool.submit(assemble_pose, UNC, *PAPER, confirm=True, watch=watch), watch)
    assert seen[-1] == alone.progress()
    assert [progress.leg for progress in seen] == sorted(progress.leg for progress in seen)
    assert max(progress.leg for progress in seen) == 2
    watch.begin_confirmation()
    watch.stop()
    with pytest.raises(PathStoppedError):
        assemble_pose(UNC, *PAPER, confirm=True, watch=watch)


@pytest.mark.parametrize(("mu", "points"), [(0.0, 1), (0.02, 1), (0.02, 40)])
def test_a_path_ends_soon_after_it_is_stopped(mu: float, points: int) -> None:
    watch = PathWatch()
    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(assemble_pose, UNC, *PAPER, mu=mu, watch=watch)
        until = time.monotonic() + LONGEST_S
        while watch.progress().points < points:
            assert time.monotonic() < until
            time.sleep(LOOK_S)
        reached = watch.progress()
        while not running.done():
            watch.stop()
            time.sleep(LOOK_S)
        with pytest.raises(PathStoppedError):
            running.result()
    # Few points more of the hundreds of the whole path.
    assert watch.progress().leg == reached.leg
    assert watch.progress().points <= reached.points + 20


def test_a_path_that_is_stopped_before_it_begins_does_not() -> None:
    watch = PathWatch()
    watch.stop()
    with pytest.raises(PathStoppedError):
        assemble_pose(UNC, *PAPER, strategy=Strategy.CW, watch=watch)
    assert watch.progress() == PathProgress(1, 0, None, ())
