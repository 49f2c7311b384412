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
from threadstate.state.flat_base import require_flat_base
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from threadstate.thread.profile import outline_is_convex

Floats = NDArray[np.float64]

LEVEL_TILT_DEG = 1e-9
"""Below this roll and pitch a pose is level: its contact is a patch to the last digits of a double."""


def solve_records(
    pair: Pair,
    options: SolveOptions,
    poses_deg: Floats,
    *,
    first_contact_only: bool = False,
    beside: Floats = sk.NONE_BESIDE,
) -> Floats:
    """Records of shape (n, RECORD_SIZE) of valid poses of shape (n, 3): roll, pitch, phase in degrees.

    Their layout is that of ``threadstate.contact._record_kernel``. The same pose gives the same bits whatever the
    others are. With ``first_contact_only`` no more than the first contact counts and what follows it may be left out:
    it takes an eighth of the time.

    Contacts of poses next to one are looked for first, of which those that begin later need not be told apart: of the
    pose before it in ``poses_deg``, or of those whose records are in ``beside``, shape (n, 2, RECORD_SIZE). They say
    how long a solution takes, and nothing else (docs/decisions/0082-contacts-of-the-pose-beside.md).

    Raises:
        InvalidValueError: the flanks of the pair are too flat, or its bolt has a chamfer.
    """
    packed = packed_options(pair, options, first_contact_only=first_contact_only)
    records = np.empty((len(poses_deg), rk.RECORD_SIZE))
    level = (np.abs(poses_deg[:, 0]) < LEVEL_TILT_DEG) & (np.abs(poses_deg[:, 1]) < LEVEL_TILT_DEG)
    if not level.any():
        sk.solve_rows(poses_deg * (math.pi / 180.0), packed, pair.bolt.packed, pair.nut.packed, beside, records)
        return records
    if not level.all():
        records[~level] = solve_records(
            pair,
            options,
            poses_deg[~level],
            first_contact_only=first_contact_only,
            beside=beside[~level] if len(beside) else beside,
        )
    for i in np.flatnonzero(level):
        solve_level(pair, math.radians(poses_deg[i, 2]), records[i])
    return records


def first_heights(pair: Pair, rotations: Floats) -> Floats:
    """The heights of the bolt's origin at the first contacts of bolts that are not level, shape (n,); NaN where one is
    not certain. The tie tolerance is that of the default options.

    Args:
        pair: the pair.
        rotations: the bolts' rotations by rows, shape (n, 9); they come down the nut's axis.
    """
    heights = np.empty((len(rotations), 1))
    packed = packed_options(pair, SolveOptions())
    sk.solve_rows(rotations, packed, pair.bolt.packed, pair.nut.packed, sk.NONE_BESIDE, heights)
    return heights[:, 0]


LEAST_FLANK_HALF_ANGLE_DEG = 7.0
"""Of flatter flanks overlaps of thread with thread are too narrow for the search: embedments of 3 deg were too small by
up to 2e-4 thread pitches."""

LARGEST_TILT_DEG = 14.2
"""Roll and pitch of 10 deg each tilt the bolt by 14.11 deg. Flatter flanks can meet the nut's surface first."""


@lru_cache(maxsize=64)
def packed_options(pair: Pair, options: SolveOptions, *, first_contact_only: bool = False) -> Floats:
    """Options as the kernels take them, in their order, read-only.

    Raises:
        InvalidValueError: the flanks of the pair are too flat, or its bolt has a chamfer.
    """
    require_flat_base(pair, "the exact method")
    for name in ("flank_half_angle_deg", "flank_half_angle_neg_deg"):
        half_angle = getattr(pair.form, name)
        if half_angle is not None and half_angle < LEAST_FLANK_HALF_ANGLE_DEG:
            least = number_text(LEAST_FLANK_HALF_ANGLE_DEG)
            raise InvalidValueError(
                name, half_angle, f"at least {least} deg for the exact method; `mesh` takes flatter flanks"
            )
    # Surfaces that face down are positive flanks.
    convex = (
        pair.form.flank_half_angle_deg > LARGEST_TILT_DEG
        and outline_is_convex(pair.bolt)
        and outline_is_convex(pair.nut)
    )
    packed = np.zeros(sk.OPTIONS_SIZE)
    packed[sk.S_TURN_LIMIT] = math.radians(options.turn_limit_deg)
    packed[sk.S_TIE] = options.tie_tolerance * pair.thread_pitch
    packed[sk.S_CONVEX] = float(convex)
    packed[sk.S_FIRST_ONLY] = float(first_contact_only)
    packed.setflags(write=False)
    return packed
