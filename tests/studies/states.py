"""Exact answers for the tests of the studies."""

from __future__ import annotations

from functools import cache

from studies.methods import Case, ExactMethod
from studies.stability.change import SolvedCase
from threadstate.state.model import ContactState
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
EXACT = ExactMethod()

THREE_POINT = (1.0, -2.0, 10.0)
FLUSH = (4.0, 0.0, 185.0)


@cache
def answered(pose_deg: tuple[float, float, float]) -> SolvedCase:
    """The exact answer for a pose of 1/4-20 UNC."""
    case = Case(PAIR, pose_deg)
    (state,) = EXACT.answers([case])
    assert isinstance(state, ContactState)
    return SolvedCase(case, state)
