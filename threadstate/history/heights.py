"""The height of the bolt against its phase, exact at every phase (the paper's figures 7 to 10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.history.model import CIRCLE_DEG, History
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Heights:
    """Arrays of shape (n,), read-only: phases in degrees, ascending, and heights of the bolt's origin there.

    ``first`` is the height at first contact, ``last`` that in the last pose, in the pair's unit; NaN where undecided.
    """

    phases_deg: Floats
    first: Floats
    last: Floats


def heights_of(pair: Pair, history: History, step_deg: float, options: SolveOptions | None = None) -> Heights:
    """Heights at even steps from 0 to 360 deg and at both sides of every boundary of the pair's history.

    A jump shows as two heights at phases as near each other as the boundary's bracket is narrow.
    """
    even = np.linspace(0.0, CIRCLE_DEG, 1 + round(CIRCLE_DEG / step_deg))
    sides = [phase % CIRCLE_DEG for b in history.boundaries for phase in (b.low_deg, b.high_deg)]
    phases = np.unique(np.concatenate([even, sides]))
    poses = np.column_stack([np.full((len(phases), 2), (history.roll_deg, history.pitch_deg)), phases])
    records = solve_records(pair, options or SolveOptions(), poses)
    heights = records[:, rk.O_POSE + 11 : rk.O_CONTACT : 12]
    last = heights[np.arange(len(heights)), np.maximum(records[:, rk.O_POSES].astype(np.intp) - 1, 0)]
    undecided = records[:, rk.O_STATUS] != 0.0
    columns = phases, np.where(undecided, np.nan, heights[:, 0]), np.where(undecided, np.nan, last)
    for column in columns:
        column.setflags(write=False)
    return Heights(*columns)
