"""A cache of the kernels' records: each pose is solved once."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import MutableMapping

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class RecordStore:
    """The records of one pair's poses, as ``threadstate.state.records.solve_records`` gives them for these options."""

    def __init__(self, pair: Pair, options: SolveOptions) -> None:
        self._pair = pair
        self._options = options
        self._rows: MutableMapping[bytes, Floats] = {}

    def records(self, poses_deg: Floats) -> Floats:
        """Records of shape (n, RECORD_SIZE) of valid poses of shape (n, 3)."""
        keys = _keys(poses_deg)
        new = {key: i for i, key in enumerate(keys) if key not in self._rows}
        if new:
            found = self._solved(poses_deg[list(new.values())])
            if len(new) == len(keys):
                self._rows.update(zip(keys, found, strict=True))
                return found
            self._rows.update(zip(new, found, strict=True))
        records = np.empty((len(keys), rk.RECORD_SIZE))
        for i, key in enumerate(keys):
            records[i] = self._rows[key]
        return records

    def _solved(self, poses_deg: Floats) -> Floats:
        return solve_records(self._pair, self._options, poses_deg)


class FirstContactStore(RecordStore):
    """Records of which the first contact alone counts: whole ones where ``whole`` has them, else what is solved here.

    A record has a first contact if it has a pose: whether later ones are undecided is no matter.
    """

    def __init__(self, pair: Pair, options: SolveOptions, whole: RecordStore) -> None:
        super().__init__(pair, options)
        self._rows = ChainMap({}, whole._rows)

    def _solved(self, poses_deg: Floats) -> Floats:
        return solve_records(self._pair, self._options, poses_deg, first_contact_only=True)


def _keys(poses_deg: Floats) -> list[bytes]:
    """One key for every pose, the same where the bits are."""
    rows = np.ascontiguousarray(poses_deg)
    return [key.tobytes() for key in rows.view(np.dtype((np.void, rows.itemsize * 3))).ravel()]
