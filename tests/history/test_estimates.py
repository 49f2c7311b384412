"""Where labels change as contacts that are followed have it, beside whole solves that are bisected."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from threadstate.history.brackets import Bracket, brackets_of
from threadstate.history.build import RESOLUTION, history_of
from threadstate.history.changes import changes_on_circles
from threadstate.history.codes import LabelCodes
from threadstate.history.estimates import ChangeEstimates
from threadstate.history.fold import fold_near
from threadstate.history.model import CIRCLE_DEG, POINT_DEG
from threadstate.history.records import RecordStore
from threadstate.history.stretches import Floats, Integers, Samples
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
OPTIONS = SolveOptions()
TILTS = [
    (0.0, -4.0),
    (-2.0, 1.0),
    (3.0, 3.0),
    *map(tuple, np.random.default_rng(17).uniform(-4.0, 4.0, (2, 2)).tolist()),
]

SPREAD_DEG = 2e-6
"""So far round-off moves where a region of a flush patch changes, or a contact beside an earlier one begins."""


@cache
def _searched(tilt: tuple[float, float], *, with_estimates: bool) -> tuple[list[Bracket], int]:
    """The brackets of an orientation, and how many poses were solved for them."""
    store = RecordStore(PAIR, OPTIONS)
    codes, estimates = LabelCodes(PAIR, OPTIONS, store), ChangeEstimates(PAIR, OPTIONS, store)

    def sample(line: Integers, phases: Floats) -> Samples:
        return codes.samples(np.column_stack([np.full((len(line), 2), tilt), phases]))

    def estimate(_: Integers, low: Floats, high: Floats, within: Floats) -> Floats:
        return estimates.places(np.full((len(low), 2), tilt), low, high, within)

    changes = changes_on_circles(sample, 1, CIRCLE_DEG, RESOLUTION, estimate if with_estimates else None)
    return [one for one in brackets_of(changes, 0) if one.decided], int(changes.sample_counts[0])


@pytest.mark.parametrize("tilt", TILTS)
def test_brackets_are_those_of_bisected_whole_solves(tilt: tuple[float, float]) -> None:
    # The history's, which are wider where round-off decides.
    found = [Bracket(one.low_deg, one.high_deg, 0, 0) for one in history_of(PAIR, *tilt).boundaries if one.decided]
    sharp = [one for one in found if one.width <= POINT_DEG]
    bisected, _ = _searched(tilt, with_estimates=False)
    assert len(sharp) > 15
    assert max(_apart(one, bisected) for one in sharp) <= SPREAD_DEG
    assert max(_apart(one, found) for one in bisected) <= SPREAD_DEG


def test_estimates_spare_half_of_the_whole_solves() -> None:
    aimed = [_searched(tilt, with_estimates=True) for tilt in TILTS]
    bisected = [_searched(tilt, with_estimates=False) for tilt in TILTS]
    assert max(one.width for found, _ in aimed for one in found) <= POINT_DEG
    start = CIRCLE_DEG / RESOLUTION.step
    counts, usual_counts = ([count - start for _, count in searched] for searched in (aimed, bisected))
    assert all(count < usual for count, usual in zip(counts, usual_counts, strict=True))
    assert sum(counts) < 0.5 * sum(usual_counts)


def _apart(bracket: Bracket, others: list[Bracket]) -> float:
    """How far the nearest of others is from a bracket."""
    return min(max(one.low - bracket.high, bracket.low - one.high) for one in others)


def test_a_jump_is_estimated_at_its_fold() -> None:
    low, high = 357.3805, 357.3815
    first = solve_pose(PAIR, 0.0, -4.0, low).contacts[0]
    fold = fold_near(PAIR, 0.0, -4.0, low, math.atan2(first.point_bolt[1], first.point_bolt[0]))
    assert fold is not None
    assert low < fold.phase_deg < high
    estimates = ChangeEstimates(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS), first_contact_only=True)
    (place,) = estimates.places(np.array([[0.0, -4.0]]), np.array([low]), np.array([high]), np.array([1e-10]))
    assert place == pytest.approx(fold.phase_deg, abs=2e-10)


def test_one_contact_throughout_is_said_to_be_one() -> None:
    estimates = ChangeEstimates(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS))
    state, other = (solve_pose(PAIR, 2.0, 3.0, phase) for phase in (40.0, 40.5))
    assert [contact.features for contact in state.contacts] == [contact.features for contact in other.contacts]
    (place,) = estimates.places(np.array([[2.0, 3.0]]), np.array([40.0]), np.array([40.5]), np.array([1e-9]))
    assert place == np.inf


def test_there_is_no_estimate_where_a_contact_is_a_patch() -> None:
    estimates = ChangeEstimates(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS))
    (place,) = estimates.places(np.zeros((1, 2)), np.array([0.5]), np.array([90.0]), np.array([1e-9]))
    assert np.isnan(place)
