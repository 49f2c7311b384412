"""Where labels change as contacts that are followed have it, beside whole solves that are bisected."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.history.brackets import Bracket, brackets_of
from threadstate.history.build import RESOLUTION, histories_of
from threadstate.history.changes import Floats, Integers, Samples, changes_on_circles
from threadstate.history.codes import LabelCodes
from threadstate.history.estimates import ChangeEstimates
from threadstate.history.fold import fold_near
from threadstate.history.model import CIRCLE_DEG, POINT_DEG
from threadstate.history.records import RecordStore
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
OPTIONS = SolveOptions()
TILTS = [(0.0, -4.0), (-2.0, 1.0), (3.0, 3.0), *np.random.default_rng(17).uniform(-4.0, 4.0, (2, 2)).tolist()]

SPREAD_DEG = 2e-6
"""So far round-off moves where a region of a flush patch changes, or a contact beside an earlier one begins."""


def _bisected(tilt: tuple[float, float], *, first_contact_only: bool = False) -> tuple[list[Bracket], Integers]:
    """The brackets of an orientation as bisecting whole solves alone has them, and how many were solved."""
    codes = LabelCodes(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS), first_contact_only=first_contact_only)

    def sample(line: Integers, phases: Floats) -> Samples:
        return codes.samples(np.column_stack([np.full((len(line), 2), tilt), phases]))

    changes = changes_on_circles(sample, 1, CIRCLE_DEG, RESOLUTION)
    return brackets_of(changes, 0), changes.sample_counts


@pytest.mark.parametrize("tilt", TILTS)
def test_brackets_are_those_of_bisected_whole_solves(tilt: tuple[float, float]) -> None:
    (history,) = histories_of(PAIR, [(tilt[0], tilt[1])])
    brackets, (count,) = _bisected(tilt)
    found = [Bracket(one.low_deg, one.high_deg, 0, 0) for one in history.boundaries if one.decided]
    narrow = [one for one in found if one.width <= POINT_DEG]
    usual = [one for one in brackets if one.decided]
    assert len(narrow) > 15
    assert max(_apart(one, usual) for one in narrow) <= SPREAD_DEG
    assert max(_apart(one, found) for one in usual) <= SPREAD_DEG
    assert history.solve_count - 360 < 0.6 * (count - 360)


def _apart(bracket: Bracket, others: list[Bracket]) -> float:
    """How far the nearest of others is from a bracket."""
    return min(max(one.low - bracket.high, bracket.low - one.high) for one in others)


def test_a_jump_is_estimated_at_its_fold() -> None:
    low, high = 357.0, 358.0
    first = solve_pose(PAIR, 0.0, -4.0, low).contacts[0]
    azimuth = float(np.arctan2(first.point_bolt[1], first.point_bolt[0]))
    fold = fold_near(PAIR, 0.0, -4.0, low, azimuth)
    assert fold is not None
    estimates = ChangeEstimates(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS), first_contact_only=True)
    (place,) = estimates.places(np.array([[0.0, -4.0]]), np.array([low]), np.array([high]), np.array([1e-9]))
    assert place == pytest.approx(fold.phase_deg, abs=2e-9)


def test_there_is_no_estimate_where_nothing_changes_and_where_a_contact_is_a_patch() -> None:
    estimates = ChangeEstimates(PAIR, OPTIONS, RecordStore(PAIR, OPTIONS))
    orientations = np.array([[2.0, 3.0], [0.0, 0.0]])
    places = estimates.places(orientations, np.array([40.0, 0.0]), np.array([40.0, 90.0]), np.full(2, 1e-9))
    assert np.isnan(places).all()
