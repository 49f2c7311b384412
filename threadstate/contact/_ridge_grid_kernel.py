"""Where ridges of phi cross the azimuths of the bolt's thread, in loops that the compiler can vectorise.

The grid covers the thread from the base plane up to the nut's surface: columns of constant azimuth, each divided into
the same number of pieces. Grid and list of crossings are flat arrays, block after block: within a loop every operand is
at a fixed distance from the next. Nothing in the loops branches or calls a library.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._lane_kernel import profile_numbers, radius_and_slope
from threadstate.contact._slope_kernel import slopes, standing_numbers
from threadstate.contact._tangency_kernel import S_OFF, S_ROT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LANES = 8
"""Columns are done in groups of so many."""
MOST_AZIMUTHS = 256
MOST_PIECES = 16
STRIDE = 2 * MOST_AZIMUTHS + LANES
"""Columns go round more than twice, so that any part of the circumference lies in one piece."""

# Blocks of the grid: the columns' cosines and sines, the base's radius there, the z at which the nut's surface is
# reached; then B, row after row.
G_COS = 0
G_SIN = STRIDE
G_BASE = 2 * STRIDE
G_TOP = 3 * STRIDE
G_B = 4 * STRIDE
GRID_SIZE = G_B + (MOST_PIECES + 1) * STRIDE

MOST_RIDGES = 4
"""So many ridges are looked for on one azimuth."""
BATCH = 2 * LANES
"""Crossings are found in batches of so many: two vectors hide each other's delays."""
MOST_CROSSINGS = MOST_RIDGES * (MOST_AZIMUTHS + 1) + BATCH

# Where ridges cross azimuths: a block for each of theta, its cosine and sine, the column, z and the slope A there; then
# the z between which it lies with the slopes B (lessened where the end has stayed), the side of the last step, and phi.
C_THETA = 0
C_COS = MOST_CROSSINGS
C_SIN = 2 * MOST_CROSSINGS
C_COLUMN = 3 * MOST_CROSSINGS
C_Z = 4 * MOST_CROSSINGS
C_A = 5 * MOST_CROSSINGS
C_LOW = 6 * MOST_CROSSINGS
C_HIGH = 7 * MOST_CROSSINGS
C_B_LOW = 8 * MOST_CROSSINGS
C_B_HIGH = 9 * MOST_CROSSINGS
C_SIDE = 10 * MOST_CROSSINGS
C_PHI = 11 * MOST_CROSSINGS
CROSSINGS_SIZE = 12 * MOST_CROSSINGS
MOST_STEPS = 16
NARROW = 1e-4
"""A crossing is known to this part of a pitch, or B is less than ``FLAT`` there."""
FLAT = 1e-6

STEEP = 0.1
"""Less than this is taken for the cosine of the tilt at no time."""


@kernel()
def set_columns(azimuths: int, bolt: Array, grid: Array) -> None:
    """Cosines, sines and radii of the base of all columns, ``TWO_PI / azimuths`` apart."""
    step = TWO_PI / azimuths
    for j in range(LANES):
        grid[G_COS + j] = math.cos(step * j)
        grid[G_SIN + j] = math.sin(step * j)
    c = math.cos(step * LANES)
    s = math.sin(step * LANES)
    columns = 2 * azimuths + LANES
    for j in range(LANES, columns):
        x = grid[G_COS + j - LANES]
        y = grid[G_SIN + j - LANES]
        grid[G_COS + j] = x * c - y * s
        grid[G_SIN + j] = x * s + y * c
    lead = bolt[pk.P] / azimuths
    numbers = profile_numbers(bolt)
    for j in range(columns):
        r, _, _ = radius_and_slope(-lead * j, numbers)
        grid[G_BASE + j] = r


@kernel()
def set_tops(first: int, lanes: int, standing: Array, bolt: Array, grid: Array) -> float:
    """Up to which z the columns from ``first`` on are below the nut's surface, p at the most; returns the largest."""
    x, y, up = standing[S_ROT + 6], standing[S_ROT + 7], standing[S_ROT + 8]
    p = bolt[pk.P]
    per_up = 1.0 / up if up > STEEP else 1.0 / STEEP
    highest = 0.0
    view = grid[first:]
    for j in range(lanes):
        depth = -standing[S_OFF + 2] - view[G_BASE + j] * (x * view[G_COS + j] + y * view[G_SIN + j])
        top = depth * per_up
        top = top if top < p else p
        view[G_TOP + j] = top
        highest = top if top > highest else highest
    return highest


@kernel(contract=True)
def set_slopes(
    pieces: int, first: int, lanes: int, azimuths: int, standing: Array, bolt: Array, nut: Array, grid: Array
) -> None:
    """B at all ends of ``pieces`` pieces, ``lanes`` columns from ``first`` on."""
    k = bolt[pk.P] / TWO_PI
    lead = bolt[pk.P] / azimuths
    bolt_numbers = profile_numbers(bolt)
    nut_numbers = profile_numbers(nut)
    place = standing_numbers(standing)
    view = grid[first:]
    for m in range(pieces + 1):
        row = view[m * STRIDE :]
        part = m / pieces
        for j in range(lanes):
            cos = view[G_COS + j]
            sin = view[G_SIN + j]
            z = part * view[G_TOP + j]
            r, slope, _ = radius_and_slope(z - lead * (first + j), bolt_numbers)
            _, _, b = slopes(r * cos, r * sin, z, slope * cos, slope * sin, k, place, nut_numbers)
            row[G_B + j] = b


@kernel()
def list_crossings(first: int, columns: int, pieces: int, azimuths: int, grid: Array, crossings: Array) -> int:
    """Lists the pieces of columns in which B falls through zero, by column and then from the base up."""
    count = 0
    for j in range(first, first + columns):
        top = grid[G_TOP + j]
        if top <= 0.0:
            continue
        ridge = 0
        for m in range(pieces):
            b_low = grid[G_B + m * STRIDE + j]
            b_high = grid[G_B + (m + 1) * STRIDE + j]
            if b_low > 0.0 and b_high < 0.0:
                crossings[C_THETA + count] = TWO_PI * j / azimuths
                crossings[C_COS + count] = grid[G_COS + j]
                crossings[C_SIN + count] = grid[G_SIN + j]
                crossings[C_COLUMN + count] = j
                crossings[C_LOW + count] = top * m / pieces
                crossings[C_HIGH + count] = top * (m + 1) / pieces
                crossings[C_B_LOW + count] = b_low
                crossings[C_B_HIGH + count] = b_high
                crossings[C_SIDE + count] = 0.0
                count += 1
                ridge += 1
                if ridge == MOST_RIDGES:
                    break
    return count


@kernel(contract=True)
def set_crossings(count: int, standing: Array, bolt: Array, nut: Array, crossings: Array) -> None:
    """Finds where in their pieces the listed crossings are, and A there, by regula falsi.

    A slope at an end that stays is lessened as Anderson and Bjorck (1973) do, which keeps the steps fast.
    """
    k = bolt[pk.P] / TWO_PI
    bolt_numbers = profile_numbers(bolt)
    nut_numbers = profile_numbers(nut)
    place = standing_numbers(standing)
    for i in range(CROSSINGS_SIZE // MOST_CROSSINGS):
        for j in range(count, count + BATCH):
            crossings[i * MOST_CROSSINGS + j] = crossings[i * MOST_CROSSINGS]
    narrow = NARROW * bolt[pk.P]
    for first in range(0, count, BATCH):
        batch = crossings[first:]
        for _ in range(MOST_STEPS):
            unsettled = 0
            for j in range(BATCH):
                low = batch[C_LOW + j]
                high = batch[C_HIGH + j]
                b_low = batch[C_B_LOW + j]
                b_high = batch[C_B_HIGH + j]
                side = batch[C_SIDE + j]
                z = (low * b_high - high * b_low) / (b_high - b_low)
                r, slope, _ = radius_and_slope(z - k * batch[C_THETA + j], bolt_numbers)
                cos = batch[C_COS + j]
                sin = batch[C_SIN + j]
                phi, a, b = slopes(r * cos, r * sin, z, slope * cos, slope * sin, k, place, nut_numbers)
                up = b > 0.0
                left = 1.0 - b / (b_low if up else b_high)
                left = left if left > 0.0 else 0.5
                # Where a slope was zero to the last bit the next one divides by it.
                left = left if left <= 1.0 else 0.5
                batch[C_Z + j] = z
                batch[C_A + j] = a
                batch[C_PHI + j] = phi
                batch[C_LOW + j] = z if up else low
                batch[C_HIGH + j] = high if up else z
                kept_low = left * b_low if side > 0.0 else b_low
                kept_high = left * b_high if side < 0.0 else b_high
                batch[C_B_LOW + j] = b if up else kept_low
                batch[C_B_HIGH + j] = kept_high if up else b
                batch[C_SIDE + j] = -1.0 if up else 1.0
                wide = batch[C_HIGH + j] - batch[C_LOW + j] > narrow
                unsettled += 1 if wide and abs(b) > FLAT else 0
            if unsettled == 0:
                break


@kernel()
def list_maxima(
    count: int, lead: float, step: float, apart: float, aloft: float, crossings: Array, maxima: Array
) -> int:
    """About where (theta, z) phi is highest along the ridges, from their crossings; returns how many places.

    Columns are ``step`` (rad) apart, over which the helix climbs by ``lead``. Crossings of neighbouring columns that
    are more than ``apart`` from that, or in which phi differs by more than ``aloft`` and its slope, belong to two
    ridges. A maximum lies between two columns, or between a column and a ridge's end.
    """
    places = 0
    before = 0
    before_end = 0
    column = crossings[C_COLUMN]
    while before < count:
        # The crossings of one column, from ``before`` on, and of the next, from ``after`` on.
        after = before_end
        after_end = after
        while after_end < count and crossings[C_COLUMN + after_end] == column:
            after_end += 1
        column += 1.0
        while before < before_end or after < after_end:
            is_before = before < before_end
            is_after = after < after_end
            i, j = before, after
            if is_before and is_after:
                climb = crossings[C_Z + j] - crossings[C_Z + i] - lead
                rise = abs(crossings[C_PHI + j] - crossings[C_PHI + i])
                slope = 0.5 * (abs(crossings[C_A + i]) + abs(crossings[C_A + j]))
                near = apart if rise < aloft + slope * step else 0.0
                is_before = climb > -near or (near == 0.0 and climb == 0.0)
                is_after = climb < near
            before += 1 if is_before else 0
            after += 1 if is_after else 0
            if (is_before and not crossings[C_A + i] > 0.0) or (is_after and not crossings[C_A + j] < 0.0):
                continue
            w = 1.0 if is_after else 0.0
            if is_before and is_after:
                w = crossings[C_A + i] / (crossings[C_A + i] - crossings[C_A + j])
            if not is_before:
                i = j
            if not is_after:
                j = i
            maxima[places, 0] = crossings[C_THETA + i] + w * (crossings[C_THETA + j] - crossings[C_THETA + i])
            maxima[places, 1] = crossings[C_Z + i] + w * (crossings[C_Z + j] - crossings[C_Z + i])
            places += 1
        before = before_end
        before_end = after_end
    return places
