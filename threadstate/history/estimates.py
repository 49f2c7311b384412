"""Where labels of an orientation change, estimated from two of its states by following their contacts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import Ahead, ahead
from threadstate.history import _change_kernel as ck
from threadstate.history.codes import HEIGHT_JUMP, PLACE_JUMP
from threadstate.history.model import CIRCLE_DEG
from threadstate.history.records import RecordStore
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

MOVED_SHARE = 0.5
"""A contact that is farther off than this share of a jump is another one."""

STEADY_SHARE = 0.01
"""One that moves by less of it, within so small a stretch as a change is estimated to, does not jump."""


class ChangeEstimates:
    """Estimates phases at which labels change; with ``first_contact_only`` those of the first contact."""

    def __init__(
        self, pair: Pair, options: SolveOptions, store: RecordStore, *, first_contact_only: bool = False
    ) -> None:
        self._pair = pair
        self._store = store
        self._first_contact_only = first_contact_only
        limits = np.zeros(ck.LIMITS_SIZE)
        limits[ck.L_TURN_LIMIT] = math.radians(options.turn_limit_deg)
        limits[ck.L_EMBEDMENT] = options.embedment_tolerance * pair.thread_pitch
        limits[ck.L_PIVOT] = options.quasi_stable_fraction * pair.nominal_diameter / 2.0
        limits[ck.L_PLACE] = MOVED_SHARE * PLACE_JUMP * pair.thread_pitch
        limits[ck.L_STEADY_PLACE] = STEADY_SHARE * PLACE_JUMP * pair.thread_pitch
        limits[ck.L_STEADY_HEIGHT] = MOVED_SHARE * HEIGHT_JUMP * pair.thread_pitch
        self._limits = limits

    def places(self, orientations_deg: Floats, low_deg: Floats, high_deg: Floats, within_deg: Floats) -> Floats:
        """Phases, in degrees, at which labels change between two decided ones; NaN where none is found, infinite where
        the contacts of one are those of the other, so that nothing changes between.

        Orientations, roll and pitch in degrees, are of shape (n, 2), all else of shape (n,). ``within_deg`` is how
        near an estimate is to be to where what is followed changes.
        """
        places = np.empty(len(low_deg))
        ck.places_of_changes(
            orientations_deg * (math.pi / 180.0),
            low_deg,
            high_deg,
            within_deg,
            self._records(orientations_deg, low_deg),
            self._records(orientations_deg, high_deg),
            self._first_contact_only,
            self._limits,
            self._pair.bolt.packed,
            self._pair.nut.packed,
            places,
        )
        return places

    def _records(self, orientations_deg: Floats, phases_deg: Floats) -> Floats:
        return self._store.records(np.column_stack([orientations_deg, phases_deg % CIRCLE_DEG]))


def load_estimates(pair: Pair) -> None:
    """Load the kernels, compiling those that the cache lacks: for no stretch no pose is solved."""
    options, none = SolveOptions(), np.empty(0)
    ChangeEstimates(pair, options, RecordStore(pair, options)).places(np.empty((0, 2)), none, none, none)


def estimates_ahead(pair: Pair) -> Ahead:
    """The kernel that is to be compiled."""
    row, rows = np.empty(0), np.empty((0, 0))
    both = pair.bolt.packed, pair.nut.packed
    return ahead(ck.places_of_changes, rows, row, row, row, rows, rows, False, row, *both, row)
