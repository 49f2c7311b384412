"""The kernels' records of poses, in which an undecided pose has a status instead of raising an error."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.contact.level import solve_level
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from threadstate.thread.profile import outline_is_convex

Floats = NDArray[np.float64]

LEVEL_TILT_DEG = 1e-9
"""Below this roll and pitch a pose is level: its contact is a patch to the last digits of a double."""


def solve_records(pair: Pair, options: SolveOptions, poses_deg: Floats) -> Floats:
    """Records of shape (n, RECORD_SIZE) of valid poses of shape (n, 3): roll, pitch, phase in degrees.

    Their layout is that of ``threadstate.contact._record_kernel``. The same pose gives the same bits whatever the
    others are.

    Raises:
        InvalidValueError: a fillet of the pair is smaller than the search resolves.
    """
    packed = _packed(pair, options)
    records = np.empty((len(poses_deg), rk.RECORD_SIZE))
    level = (np.abs(poses_deg[:, 0]) < LEVEL_TILT_DEG) & (np.abs(poses_deg[:, 1]) < LEVEL_TILT_DEG)
    if not level.any():
        sk.solve_rows(poses_deg * (math.pi / 180.0), packed, pair.bolt.packed, pair.nut.packed, records)
        return records
    if not level.all():
        records[~level] = solve_records(pair, options, poses_deg[~level])
    for i in np.flatnonzero(level):
        solve_level(pair, math.radians(poses_deg[i, 2]), records[i])
    return records


LEAST_CREST_FILLET, LEAST_ROOT_FILLET = 0.005, 0.001
"""Over the thread pitch. Smaller ones are kinks to the search for contacts of thread with thread: it may miss one."""


@lru_cache(maxsize=64)
def _packed(pair: Pair, options: SolveOptions) -> Floats:
    for name in ("bolt_root_fillet", "bolt_crest_fillet", "nut_root_fillet", "nut_crest_fillet"):
        value = getattr(pair.form, name)
        least = LEAST_CREST_FILLET if "crest" in name else LEAST_ROOT_FILLET
        if value < least:
            valid = (
                f"at least {number_text(least)} of the thread pitch for the exact method; `mesh` takes sharp corners"
            )
            raise InvalidValueError(name, value, valid)
    convex = outline_is_convex(pair.bolt) and outline_is_convex(pair.nut)
    packed = np.zeros(4)
    packed[sk.S_TURN_LIMIT] = math.radians(options.turn_limit_deg)
    packed[sk.S_TIE] = options.tie_tolerance * pair.thread_pitch
    packed[sk.S_CONVEX] = float(convex)
    packed.setflags(write=False)
    return packed
