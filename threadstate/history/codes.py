"""Labels of many records at once as integers that are equal where the labels are, and the numbers that may jump."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.contact._stage_kernel import FLUSH
from threadstate.history.records import Floats, Integers, RecordStore
from threadstate.history.stretches import UNDECIDED_CODE, Samples
from threadstate.state.classify import classify
from threadstate.state.model import StateClass
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

BATCH = 4096
"""Poses that are solved in one call: their records take 8 MB."""

_CLASSES = tuple(StateClass)
_LABEL_COLUMNS = (rk.P_STAGE, rk.P_PAIR, rk.P_BOLT_REGION, rk.P_NUT_REGION)
_VALUE_COUNT = 3 + 3 * rk.MAX_RECORD_CONTACTS

HEIGHT_JUMP = 2e-4
"""The least change of a height, in thread pitches, that is a jump."""

PLACE_JUMP = 0.1
"""The least distance along an axis, in thread pitches, by which a contact jumps elsewhere.

Where edges graze, a contact runs along them so fast that shorter jumps cannot be distinguished from it.
"""


class LabelCodes:
    """Samples poses; a code numbers the distinct labels in the order in which they were found.

    Codes differ between two objects of this class, whether two of them are equal does not. With ``first_contact_only``
    labels and numbers are those of the first contact; class and flags of the state are ignored.
    """

    def __init__(
        self, pair: Pair, options: SolveOptions, store: RecordStore, *, first_contact_only: bool = False
    ) -> None:
        self._pair = pair
        self._store = store
        self._options = options
        self._first_contact_only = first_contact_only
        self._codes: dict[bytes, int] = {}
        self._classes_by_criteria: dict[int, int] = {}

    def samples(self, poses_deg: Floats) -> Samples:
        """Codes and numbers of poses of shape (n, 3): roll, pitch, phase in degrees.

        The code of an undecided pose is UNDECIDED_CODE. The numbers are the heights of the bolt's origin in its three
        poses, as multiples of a height's jump, and the coordinates in the nut's frame, as multiples of a place's jump,
        of all contacts but those of a patch, whose extreme points are no events.
        """
        if not len(poses_deg):
            return Samples(np.empty(0, dtype=np.int64), np.empty((0, _VALUE_COUNT)))
        parts = [self._batch(poses_deg[i : i + BATCH]) for i in range(0, len(poses_deg), BATCH)]
        return Samples(np.concatenate([p.codes for p in parts]), np.concatenate([p.values for p in parts]))

    def _batch(self, poses_deg: Floats) -> Samples:
        records = self._store.records(poses_deg)
        undecided = records[:, rk.O_STATUS] != 0.0
        contacts = records[:, rk.O_CONTACT :].reshape(-1, rk.MAX_RECORD_CONTACTS, rk.POINT_SIZE)
        used = np.arange(rk.MAX_RECORD_CONTACTS) < records[:, rk.O_CONTACTS, np.newaxis]
        used[undecided] = False
        labels = np.zeros((len(records), 3 + 4 * rk.MAX_RECORD_CONTACTS), dtype=np.uint8)
        pose_count = records[:, rk.O_POSES]
        if self._first_contact_only:
            used &= contacts[:, :, rk.P_STAGE] == 1.0
            pose_count = np.minimum(pose_count, 1.0)
        else:
            labels[:, 0] = self._classes(records)
            labels[:, 1] = records[:, rk.O_FLAGS]
        labels[:, 2] = used.sum(axis=1)
        named = contacts[:, :, _LABEL_COLUMNS]
        labels[:, 3:] = np.where(used[..., np.newaxis], named, 0.0).reshape(len(records), -1)

        values = np.full((len(records), _VALUE_COUNT), np.nan)
        heights = records[:, rk.O_POSE + 11 : rk.O_CONTACT : 12]
        reached = (np.arange(3) < pose_count[:, np.newaxis]) & ~undecided[:, np.newaxis]
        values[:, :3] = np.where(reached, heights / (HEIGHT_JUMP * self._pair.thread_pitch), np.nan)
        points = contacts[:, :, rk.P_POINT : rk.P_POINT + 3] / (PLACE_JUMP * self._pair.thread_pitch)
        placed = used & (contacts[:, :, rk.P_PAIR] != FLUSH)
        values[:, 3:] = np.where(placed[..., np.newaxis], points, np.nan).reshape(len(records), -1)
        return Samples(np.where(undecided, UNDECIDED_CODE, self._numbered(labels)), values)

    def _classes(self, records: Floats) -> NDArray[np.uint8]:
        """Index of every record's class.

        A class depends on which margins are present and on their signs: it is looked up by these.
        """
        flush = records[:, rk.O_FLAGS].astype(np.int64) & rk.FLAG_FLUSH
        third = ~np.isnan(records[:, rk.O_MU])
        drop, embedment, pivot = (records[:, i] for i in (rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT))
        pivot_threshold = self._options.quasi_stable_fraction * self._pair.nominal_diameter / 2.0
        embedment_tolerance = self._options.embedment_tolerance * self._pair.thread_pitch
        criteria = 2 * (flush != 0) + third
        for sign in (drop - embedment, embedment_tolerance - embedment, pivot - pivot_threshold):
            criteria = 4 * criteria + _sign(sign)
        for one in set(criteria.tolist()) - self._classes_by_criteria.keys():
            i = int(np.argmax(criteria == one))
            self._classes_by_criteria[one] = _CLASSES.index(
                classify(
                    flush=bool(flush[i]),
                    third=bool(third[i]),
                    drop=_present(drop[i]),
                    embedment=_present(embedment[i]),
                    pivot_offset=_present(pivot[i]),
                    pivot_threshold=pivot_threshold,
                    embedment_tolerance=embedment_tolerance,
                ).state_class
            )
        return np.array([self._classes_by_criteria[one] for one in criteria.tolist()], dtype=np.uint8)

    def _numbered(self, labels: NDArray[np.uint8]) -> Integers:
        """One integer for every row, the same where the rows are."""
        rows, width = labels.tobytes(), labels.shape[1]
        keys = [rows[start : start + width] for start in range(0, len(rows), width)]
        return np.array([self._codes.setdefault(key, len(self._codes)) for key in keys], dtype=np.int64)


def _sign(values: Floats) -> Integers:
    """0, 1 or 2 for a negative number, zero or a positive one; 3 for NaN."""
    return np.where(np.isnan(values), 3.0, np.sign(values) + 1.0).astype(np.int64)


def _present(value: float) -> float | None:
    return None if math.isnan(value) else float(value)
