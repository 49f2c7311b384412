"""The numbers of states under loads: their margin and least frictions, for many states at once (forces, section 3)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import zeros
from threadstate.contact._record_kernel import FLAG_FLUSH, O_CONTACTS, O_FLAGS, O_POSE, O_POSES
from threadstate.statics._friction_kernel import OPEN, hold_friction, wedge_friction
from threadstate.statics._last_pose_kernel import set_contacts
from threadstate.statics._patch_kernel import OUTLINE_SAMPLES, hull_with, set_outline
from threadstate.statics._support_kernel import patch_margin, support_margin

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

# A row of numbers: what became of the state, the margin, and the bounds of both least frictions.
N_STATUS, N_MARGIN, N_HOLD, N_WEDGE = 0, 1, 2, 4
NUMBERS_SIZE = 6

# What became of it: all numbers found; a patch whose holding friction is open; no hull; a contact without a normal.
DONE, OPEN_PATCH, NO_HULL, NO_NORMAL = range(4)

# What is wanted of contacts.
EVERY_NUMBER, MARGIN_ALONE, HOLD_ALONE = range(3)


@kernel()
def set_bounds(status: int, lower: float, upper: float, bounds: Array) -> None:
    """Sets two bounds of a least friction; zero and infinity where nothing was found and nothing proved."""
    bounds[0] = 0.0 if status == OPEN else lower
    bounds[1] = math.inf if status == OPEN else upper


@kernel(allocates=True)
def set_numbers(
    wanted: int, load: Array, points: Array, normals: Array, forces: Array, twist: Array, numbers: Array
) -> None:
    """Sets what is ``wanted`` of the margin and the bounds of both least frictions of contacts at points (k, 3) with
    normals (k, 3).

    ``forces`` (3 k) and ``twist`` (6) are set to those of the holding friction, where that is looked for: without the
    wedging one if it alone is wanted.
    """
    wedging, opening, upper = np.zeros(3 * points.shape[0]), zeros(6), math.inf
    if wanted == EVERY_NUMBER:
        status, lower, upper = wedge_friction(points, normals, wedging, opening)
        set_bounds(status, lower, upper, numbers[N_WEDGE:])
    if wanted != HOLD_ALONE:
        numbers[N_MARGIN] = support_margin(load, points, normals)
        if wanted == MARGIN_ALONE:
            return
        if numbers[N_MARGIN] >= 0.0:
            numbers[N_HOLD], numbers[N_HOLD + 1] = 0.0, 0.0
            return
    status, lower, upper = hold_friction(load, points, normals, upper, wedging, opening, forces, twist)
    set_bounds(status, lower, upper, numbers[N_HOLD:])


@kernel(nogil=True)
def contact_rows(
    wanted: int, loads: Array, points: Array, normals: Array, ends: Integers, forces: Array, twists: Array, rows: Array
) -> None:
    """Sets what is ``wanted`` of the rows (n, NUMBERS_SIZE) of states under loads (n, 6).

    The points (m, 3) and normals (m, 3) of all their contacts follow each other; where those of each end is in ``ends``
    (n). A state without one is left as it is. ``forces`` (3 m) and ``twists`` (n, 6) are as :func:`set_numbers` has
    them.
    """
    first = 0
    for i in range(ends.shape[0]):
        end = ends[i]
        if end > first:
            set_numbers(
                wanted,
                loads[i],
                points[first:end],
                normals[first:end],
                forces[3 * first : 3 * end],
                twists[i],
                rows[i],
            )
        first = end


@kernel()
def patch_numbers(load: Array, hull: Array, numbers: Array) -> None:
    """Sets the numbers of a level patch with that hull (n, 2); it never wedges.

    Outside of what the patch balances without friction, and without a force across or a moment about the axis, no
    friction helps. Else the holding friction is left open.
    """
    numbers[N_WEDGE], numbers[N_WEDGE + 1] = math.inf, math.inf
    numbers[N_MARGIN] = patch_margin(load, hull)
    numbers[N_HOLD], numbers[N_HOLD + 1] = 0.0, 0.0
    if numbers[N_MARGIN] < 0.0:
        numbers[N_HOLD], numbers[N_HOLD + 1] = math.inf, math.inf
        if load[2] != 0.0 or load[3] != 0.0 or load[4] != 0.0:
            numbers[N_STATUS] = OPEN_PATCH


@kernel(nogil=True, allocates=True)
def start_rows(
    records: Array,
    loads: Array,
    radius: float,
    bolt: Array,
    nut: Array,
    points: Array,
    normals: Array,
    ends: Integers,
    rows: Array,
) -> None:
    """Sets the rows (n, NUMBERS_SIZE) of decided records of a level patch, under loads (n, 6) about each bolt's origin.

    Those of others are set to no number, and their contacts listed one after the other in ``points`` and ``normals``,
    with where those of each record end, for :func:`contact_rows`. Points and the moments of the loads are over
    ``radius``.
    """
    hull, outline = np.empty((2 * OUTLINE_SAMPLES + 1, 2)), np.empty((OUTLINE_SAMPLES + 1, 2))
    set_outline(bolt, outline)
    listed = 0
    for i in range(records.shape[0]):
        record, row, load = records[i], rows[i], loads[i]
        row[:] = math.nan
        row[N_STATUS] = DONE
        ends[i] = listed
        poses = int(record[O_POSES])
        last = record[O_POSE + 12 * (poses - 1) : O_POSE + 12 * poses]
        if int(record[O_FLAGS]) & FLAG_FLUSH and not last[11] < 0.0:
            count = hull_with(last, outline, bolt, nut, hull)
            if count < 3:
                row[N_STATUS] = NO_HULL
                continue
            for m in range(count):
                for j in range(2):
                    hull[m, j] = (hull[m, j] - last[9 + j]) / radius
            patch_numbers(load, hull[:count], row)
            continue
        end = listed + int(record[O_CONTACTS])
        if set_contacts(record, bolt, nut, points[listed:end], normals[listed:end]) < end - listed:
            row[N_STATUS] = NO_NORMAL
            continue
        for m in range(listed, end):
            for j in range(3):
                points[m, j] /= radius
        ends[i] = listed = end
