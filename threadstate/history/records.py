"""A cache of the kernels' records: each pose is solved once."""

from __future__ import annotations

import struct
from bisect import bisect, insort
from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.contact._solve_kernel import NONE_BESIDE
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


ORIENTATION_BYTES = 16
"""Of a pose's key those of roll and pitch."""


class RecordStore:
    """The records of one pair's poses, as ``threadstate.state.records.solve_records`` gives them for these options."""

    def __init__(self, pair: Pair, options: SolveOptions) -> None:
        self._pair = pair
        self._options = options
        self._rows: dict[bytes, Floats] = {}
        self._phases: defaultdict[bytes, list[float]] = defaultdict(list)

    def records(self, poses_deg: Floats) -> Floats:
        """Records of shape (n, RECORD_SIZE) of valid poses of shape (n, 3)."""
        keys = _keys(poses_deg)
        rows = self._stored(keys)
        new = {key: i for i, (key, row) in enumerate(zip(keys, rows, strict=True)) if row is None}
        if new:
            found = self._solved(poses_deg[list(new.values())])
            self._rows.update(zip(new, found, strict=True))
            if len(new) == len(keys):
                return found
            rows = self._stored(keys)
        records = np.empty((len(keys), rk.RECORD_SIZE))
        for i, row in enumerate(rows):
            records[i] = row
        return records

    def _stored(self, keys: list[bytes]) -> list[Floats | None]:
        """The records of poses; None of those that are not solved yet."""
        return list(map(self._rows.get, keys))

    def _solved(self, poses_deg: Floats) -> Floats:
        keys, phases = _keys(poses_deg), poses_deg[:, 2].tolist()
        found = solve_records(self._pair, self._options, poses_deg, beside=self._beside(keys, phases))
        for key, phase in zip(keys, phases, strict=True):
            insort(self._phases[key[:ORIENTATION_BYTES]], phase)
        return found

    def _beside(self, keys: list[bytes], phases: list[float]) -> Floats:
        """Of each pose the records of the two of its orientation next to it in phase, shape (n, 2, RECORD_SIZE)."""
        if not all(key[:ORIENTATION_BYTES] in self._phases for key in keys):
            return NONE_BESIDE
        beside = np.empty((len(keys), 2, rk.RECORD_SIZE))
        for i, (key, phase) in enumerate(zip(keys, phases, strict=True)):
            orientation = key[:ORIENTATION_BYTES]
            known = self._phases[orientation]
            place = bisect(known, phase)
            for j in range(2):
                beside[i, j] = self._rows[orientation + struct.pack("d", known[(place - 1 + j) % len(known)])]
        return beside


class FirstContactStore(RecordStore):
    """Records of which the first contact alone counts: whole ones where ``whole`` has them, else what is solved here.

    A record has a first contact if it has a pose: whether later ones are undecided is no matter.
    """

    def __init__(self, pair: Pair, options: SolveOptions, whole: RecordStore) -> None:
        super().__init__(pair, options)
        self._whole = whole

    def _stored(self, keys: list[bytes]) -> list[Floats | None]:
        of_whole = self._whole._rows.get
        return [of_whole(key) if row is None else row for key, row in zip(keys, super()._stored(keys), strict=True)]

    def _solved(self, poses_deg: Floats) -> Floats:
        return solve_records(self._pair, self._options, poses_deg, first_contact_only=True)


def _keys(poses_deg: Floats) -> list[bytes]:
    """One key for every pose, the same where the bits are."""
    rows, width = poses_deg.tobytes(), 3 * poses_deg.itemsize
    return [rows[start : start + width] for start in range(0, len(rows), width)]
