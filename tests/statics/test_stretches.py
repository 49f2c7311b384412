"""Stretches of the phase under a load, beside the verdict of poses between which they were not looked for."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from threadstate.history.build import histories_of
from threadstate.network.cells import CIRCLE_DEG
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.statics.load import Load
from threadstate.statics.solve import statics_of
from threadstate.statics.stretches import LoadedOrientation
from threadstate.statics.verdict import Verdict
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
TILT_DEG = (0.0, -4.0)
ACROSS = Load(force=(0.2, 0.1, -1.0), moment=(0.0, 0.005, 0.0))


@pytest.fixture(scope="module")
def intervals() -> list[tuple[float, float]]:
    (history,) = histories_of(PAIR, [TILT_DEG], SolveOptions())
    return [(one.start_deg, one.end_deg) for one in history.intervals]


@pytest.mark.parametrize("load", [None, ACROSS])
@pytest.mark.parametrize("mu", [0.2, 1.0, 3.0])
def test_the_verdict_is_that_of_every_phase(intervals: list[tuple[float, float]], load: Load | None, mu: float) -> None:
    stretches = LoadedOrientation(PAIR, SolveOptions(), *TILT_DEG, load).stretches(intervals, mu)
    assert [(of[0].start_deg, of[-1].end_deg) for of in stretches] == intervals
    found = [one for of_interval in stretches for one in of_interval]
    assert all(one.end_deg == following.start_deg for one, following in pairwise(found))
    starts = [one.start_deg for one in found]
    phases = np.random.default_rng(8).uniform(starts[0], starts[0] + CIRCLE_DEG, 400)
    seen = LoadedOrientation(PAIR, SolveOptions(), *TILT_DEG, load).verdicts(phases.tolist(), mu)
    expected = [found[place - 1].verdict for place in np.searchsorted(starts, phases, side="right")]
    assert seen == expected
    assert len(set(expected)) > 1


def test_where_a_verdict_begins_is_solved(intervals: list[tuple[float, float]]) -> None:
    """The least friction is the one asked for, or jumps past it; it does so between two looks of a degree."""
    mu, crossed = 0.2, 0
    solved = LoadedOrientation(PAIR, SolveOptions(), *TILT_DEG, ACROSS)
    for before, after in (two for of_interval in solved.stretches(intervals, mu) for two in pairwise(of_interval)):
        assert after.uncertainty_deg < 1e-7
        aside = after.uncertainty_deg + 1e-8
        beside = [after.start_deg - aside, after.start_deg + aside]
        assert solved.verdicts(beside, mu) == [before.verdict, after.verdict]
        statics = statics_of(PAIR, solve_pose(PAIR, *TILT_DEG, after.start_deg % CIRCLE_DEG), ACROSS)
        crossed += abs(statics.hold.upper - mu) < 1e-8
    assert crossed > 0


def test_a_friction_touched_at_an_extremum_is_found(intervals: list[tuple[float, float]]) -> None:
    """Just above the least value that the holding friction has in an interval it holds over a short stretch."""
    solved = LoadedOrientation(PAIR, SolveOptions(), *TILT_DEG, ACROSS)
    lowest = None
    for start, end in intervals:
        phases = np.linspace(start + 1e-3, end - 1e-3, 200)
        hold = solved.rows(phases.tolist())[:, 3]
        place = int(np.argmin(hold))
        if 0 < place < len(hold) - 1 and np.isfinite(hold).all() and hold[0] > hold[place] < hold[-1]:
            lowest = (start, end), float(phases[place]), float(hold[place])
            break
    assert lowest is not None
    (start, end), phase, least = lowest
    fresh = LoadedOrientation(PAIR, SolveOptions(), *TILT_DEG, ACROSS)
    (found,) = fresh.stretches([(start, end)], least + 1e-7)
    held = [one for one in found if one.verdict is Verdict.CAN_STAY and one.start_deg <= phase <= one.end_deg]
    assert len(held) == 1
    assert held[0].end_deg - held[0].start_deg < 1.0
