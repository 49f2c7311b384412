"""The margin and the least frictions of many states at once."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.state.encode import geometry_records
from threadstate.state.flat_base import require_flat_base
from threadstate.state.model import Answer, ContactState
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics.load import Load
from threadstate.statics.solve import statics_of
from threadstate.statics.stored import StoredStatics
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


def statics_rows(pair: Pair, records: Floats, load: Load | None = None) -> Floats:
    """Rows of shape (n, NUMBERS_SIZE), as ``_numbers_kernel`` lays them out, of decided records under one load.

    Each has the same bits whatever the others are. A patch under a load with a part across it has its holding friction
    open (``OPEN_PATCH``), and so has a strip of flank, whose margin here is that of its corners alone:
    :func:`threadstate.statics.solve.statics_of` finds them.

    Raises:
        InvalidValueError: the pair's bolt has a chamfer.
    """
    require_flat_base(pair, "statics")
    rows = np.empty((len(records), nk.NUMBERS_SIZE))
    radius = pair.nominal_diameter / 2.0
    loads = loads_about(origins(records), load or Load())
    loads[:, :3] /= radius
    count = int(records[:, rk.O_CONTACTS].sum())
    points, normals, ends = np.empty((count, 3)), np.empty((count, 3)), np.empty(len(records), np.intp)
    nk.start_rows(records, loads, radius, pair.bolt.packed, pair.nut.packed, points, normals, ends, rows)
    forces, twists = np.zeros(3 * count), np.zeros((len(records), 6))
    nk.contact_rows(nk.EVERY_NUMBER, loads, points, normals, ends, forces, twists, rows)
    rows[on_strips(records), nk.N_STATUS] = nk.OPEN_PATCH
    return rows


def on_strips(records: Floats) -> NDArray[np.bool_]:
    """Which records are of a bolt that lies on a strip of flank."""
    flush = records[:, rk.O_FLAGS].astype(np.intp) & rk.FLAG_FLUSH != 0
    return np.asarray(flush & (origins(records)[:, 2] < 0.0))


def origins(records: Floats) -> Floats:
    """The bolt's origin in the last pose of records, shape (n, 3), in the nut's frame."""
    last = rk.O_POSE + 12 * (records[:, rk.O_POSES].astype(np.intp) - 1) + 9
    return np.take_along_axis(records, last[:, np.newaxis] + np.arange(3), axis=1)


def loads_about(points: Floats, load: Load) -> Floats:
    """The wrenches (moment, force) of a load about points (n, 3) of the nut's frame: shape (n, 6)."""
    force = np.array(load.force)
    arms = np.zeros_like(points) if load.point is None else np.array(load.point) - points
    return np.hstack([np.array(load.moment) + np.cross(arms, force), np.broadcast_to(force, points.shape)])


def stored_statics(
    pair: Pair, states: Sequence[ContactState], records: Floats | None = None
) -> list[StoredStatics | None]:
    """The statics of states that a library stores, in their order; None where a contact has no certain normal.

    ``records`` are those that the states were decoded from, where they are at hand.
    """
    records = geometry_records(states) if records is None else records
    found: list[StoredStatics | None] = []
    for status, margin, _, hold, _, wedge in statics_rows(pair, records).tolist():
        certain = status in (nk.DONE, nk.OPEN_PATCH)
        found.append(StoredStatics(margin + 0.0, _finite(hold), _finite(wedge)) if certain else None)
    for number in np.flatnonzero(on_strips(records)).tolist():
        whole = statics_of(pair, states[number])
        found[number] = StoredStatics(whole.support_margin + 0.0, _finite(whole.hold.upper), _finite(whole.wedge.upper))
    return found


def statics_by_ordinal(
    pair: Pair, first: int, answers: Sequence[Answer], records: Floats | None = None
) -> dict[int, StoredStatics | None]:
    """:func:`stored_statics` of the states among answers whose ordinals begin with ``first``, by ordinal.

    ``records`` are those of all answers, undecided ones too.
    """
    states = {ordinal: one for ordinal, one in enumerate(answers, first) if isinstance(one, ContactState)}
    of_states = None if records is None else records[np.array(list(states), dtype=np.intp) - first]
    return dict(zip(states, stored_statics(pair, list(states.values()), of_states), strict=True))


def _finite(friction: float) -> float | None:
    return friction + 0.0 if friction < math.inf else None
