"""What the solver does for a pose, and the least that it could do: to verify contacts that are known."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from benchmarks._work_kernel import follow_known
from benchmarks.sample import Poses
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.state.options import SolveOptions
from threadstate.state.records import LEVEL_TILT_DEG, packed_options
from threadstate.thread.pair import Pair

PASSES = 3


@dataclass(frozen=True)
class Work:
    """Of tilted poses: how many, the boxes of edges that one takes on average, and times a pose on one core.

    ``without_third`` of them have no third contact, and take so many boxes. ``solving_us`` is the time of the solver,
    ``following_us`` that of Newton's method on the contacts that the solver found, stage after stage, without a search.
    """

    poses: int
    boxes: float
    without_third: int
    boxes_without_third: float
    solving_us: float
    following_us: float

    @property
    def times_the_floor(self) -> float:
        """How many times the time of verifying known contacts the solver takes."""
        return self.solving_us / self.following_us


def work_of(pair: Pair, poses: Poses) -> Work:
    """What the tilted ones of the poses take, of shape (n, 3): roll, pitch, phase in degrees."""
    tilted = poses[(np.abs(poses[:, :2]) >= LEVEL_TILT_DEG).any(axis=1)] * (math.pi / 180.0)
    options, parts = packed_options(pair, SolveOptions()), (pair.bolt.packed, pair.nut.packed)
    records, followed = (np.empty((len(tilted), rk.RECORD_SIZE)) for _ in range(2))
    turn_limit = float(options[sk.S_TURN_LIMIT])
    follow_known(tilted[:0], records, turn_limit, *parts, followed)
    boxes, solving, following = 0, math.inf, math.inf
    for _ in range(PASSES):
        start = time.perf_counter()
        boxes = sk.solve_rows(tilted, options, *parts, sk.NONE_BESIDE, records)
        solved = time.perf_counter()
        follow_known(tilted, records, turn_limit, *parts, followed)
        following = min(following, time.perf_counter() - solved)
        solving = min(solving, solved - start)
    last = tilted[(records[:, rk.O_FLAGS].astype(np.int64) & rk.FLAG_NO_THIRD) != 0]
    boxes_of_last = sk.solve_rows(last, options, *parts, sk.NONE_BESIDE, records[: len(last)])
    return Work(
        len(tilted),
        boxes / max(len(tilted), 1),
        len(last),
        boxes_of_last / max(len(last), 1),
        1e6 * solving / max(len(tilted), 1),
        1e6 * following / max(len(tilted), 1),
    )
