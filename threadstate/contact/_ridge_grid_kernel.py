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
from threadstate.contact._branchless_kernel import VECTOR_WIDTH, profile_numbers, radius_and_slope
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._slope_kernel import along, gradient_at, in_nut, placement_numbers, slopes
from threadstate.contact._tangency_kernel import PLACEMENT_OFF, PLACEMENT_ROT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

MAX_AZIMUTHS = 64
AROUND = 8
MAX_PIECES = 16
BLOCK_SIZE = 2 * MAX_AZIMUTHS + AROUND
"""Distance between blocks: the columns go round more than twice, so that every arc of columns is contiguous. From so
many columns around those after them are computed, one from the other."""

CELLS = (MAX_PIECES + 1) * (MAX_AZIMUTHS + VECTOR_WIDTH)
"""The most ends of pieces."""

# Blocks of the grid: the columns' cosines and sines, the base's radius there, the z at which the nut's surface is
# reached. Then blocks of the ends of pieces, row after row of the columns that are looked at: B, and what it is made
# of, the point and its derivative along the axis, in the nut's frame.
G_COS = 0
G_SIN = BLOCK_SIZE
G_BASE = 2 * BLOCK_SIZE
G_TOP = 3 * BLOCK_SIZE
G_B = 4 * BLOCK_SIZE
G_X, G_Y, G_Z = G_B + CELLS, G_B + 2 * CELLS, G_B + 3 * CELLS
G_DX, G_DY, G_DZ = G_B + 4 * CELLS, G_B + 5 * CELLS, G_B + 6 * CELLS
GRID_SIZE = G_B + 7 * CELLS

MAX_RIDGES = 4
"""Most ridges searched for on one azimuth."""
BATCH = 16
"""Crossings are located in batches of this size: two vectors hide each other's latency."""
MAX_CROSSINGS = MAX_RIDGES * (MAX_AZIMUTHS + 1) + BATCH

# Where ridges cross azimuths: a block for each of theta, its cosine and sine, the column, z and the slope A there; then
# the z between which it lies with the slopes B (reduced where an end was retained), the side of the last step, and phi.
CR_THETA = 0
CR_COS = MAX_CROSSINGS
CR_SIN = 2 * MAX_CROSSINGS
CR_COLUMN = 3 * MAX_CROSSINGS
CR_Z = 4 * MAX_CROSSINGS
CR_A = 5 * MAX_CROSSINGS
CR_LOW = 6 * MAX_CROSSINGS
CR_HIGH = 7 * MAX_CROSSINGS
CR_B_LOW = 8 * MAX_CROSSINGS
CR_B_HIGH = 9 * MAX_CROSSINGS
CR_SIDE = 10 * MAX_CROSSINGS
CR_PHI = 11 * MAX_CROSSINGS
CROSSINGS_SIZE = 12 * MAX_CROSSINGS
MAX_CROSSING_STEPS = 16
CROSSING_TOLERANCE = 1e-4
"""A crossing is located to this part of a pitch, or until B is less than ``SLOPE_TOLERANCE`` there."""
SLOPE_TOLERANCE = 1e-6

LEAST_TILT_COSINE = 0.1
"""The cosine of the tilt is taken as no less than this."""


@kernel()
def set_columns(azimuths: int, bolt: Array, grid: Array) -> None:
    """Cosines, sines and radii of the base of all columns, ``TWO_PI / azimuths`` apart."""
    step = TWO_PI / azimuths
    for j in range(AROUND):
        grid[G_COS + j] = math.cos(step * j)
        grid[G_SIN + j] = math.sin(step * j)
    c = math.cos(step * AROUND)
    s = math.sin(step * AROUND)
    columns = 2 * azimuths + AROUND
    for j in range(AROUND, columns):
        x = grid[G_COS + j - AROUND]
        y = grid[G_SIN + j - AROUND]
        grid[G_COS + j] = x * c - y * s
        grid[G_SIN + j] = x * s + y * c
    advance = bolt[pk.LEAD] / azimuths
    numbers = profile_numbers(bolt)
    for j in range(columns):
        r, _, _, _ = radius_and_slope(-advance * j, numbers)
        grid[G_BASE + j] = r


@kernel()
def set_tops(first: int, padded_columns: int, placement: Array, bolt: Array, grid: Array) -> float:
    """Sets up to which z, at most p, columns from ``first`` on are below the nut's surface; returns the largest."""
    x, y, up = placement[PLACEMENT_ROT + 6], placement[PLACEMENT_ROT + 7], placement[PLACEMENT_ROT + 8]
    p = bolt[pk.P]
    inverse_up = 1.0 / up if up > LEAST_TILT_COSINE else 1.0 / LEAST_TILT_COSINE
    highest = 0.0
    view = grid[first:]
    for j in range(padded_columns):
        depth = -placement[PLACEMENT_OFF + 2] - view[G_BASE + j] * (x * view[G_COS + j] + y * view[G_SIN + j])
        top = depth * inverse_up
        top = top if top < p else p
        view[G_TOP + j] = top
        highest = top if top > highest else highest
    return highest


@kernel(contract=True)
def set_slopes(
    pieces: int, first: int, padded_columns: int, azimuths: int, placement: Array, bolt: Array, nut: Array, grid: Array
) -> None:
    """Sets B at all ends of ``pieces`` pieces in ``padded_columns`` columns from ``first`` on.

    In two loops: the one chain of operations is as long as the other, and shorter ones overlap.
    """
    k = bolt[pk.LEAD] / TWO_PI
    advance = bolt[pk.LEAD] / azimuths
    bolt_numbers = profile_numbers(bolt)
    nut_numbers = profile_numbers(nut)
    numbers = placement_numbers(placement)
    view = grid[first:]
    for row in range(pieces + 1):
        cells = grid[row * padded_columns :]
        part = row / pieces
        for j in range(padded_columns):
            cos = view[G_COS + j]
            sin = view[G_SIN + j]
            z = part * view[G_TOP + j]
            r, slope, _, _ = radius_and_slope(z - advance * (first + j), bolt_numbers)
            x, y, height = in_nut(r * cos, r * sin, z, numbers)
            dx, dy, dz = in_nut(slope * cos, slope * sin, 1.0, numbers)
            cells[G_X + j], cells[G_Y + j], cells[G_Z + j] = x + numbers[9], y + numbers[10], height + numbers[11]
            cells[G_DX + j], cells[G_DY + j], cells[G_DZ + j] = dx, dy, dz
    for i in range((pieces + 1) * padded_columns):
        _, gradient = gradient_at((grid[G_X + i], grid[G_Y + i], grid[G_Z + i]), k, nut_numbers)
        grid[G_B + i] = along(gradient, (grid[G_DX + i], grid[G_DY + i], grid[G_DZ + i]))


@kernel()
def list_crossings(
    first: int, columns: int, padded_columns: int, pieces: int, azimuths: int, grid: Array, crossings: Array
) -> int:
    """Lists the pieces of columns in which B falls through zero, by column and then from the base up."""
    count = 0
    for j in range(first, first + columns):
        top = grid[G_TOP + j]
        if top <= 0.0:
            continue
        ridge = 0
        for m in range(pieces):
            cell = G_B + m * padded_columns + j - first
            b_low, b_high = grid[cell], grid[cell + padded_columns]
            if b_low > 0.0 and b_high < 0.0:
                crossings[CR_THETA + count] = TWO_PI * j / azimuths
                crossings[CR_COS + count] = grid[G_COS + j]
                crossings[CR_SIN + count] = grid[G_SIN + j]
                crossings[CR_COLUMN + count] = j
                crossings[CR_LOW + count] = top * m / pieces
                crossings[CR_HIGH + count] = top * (m + 1) / pieces
                crossings[CR_B_LOW + count] = b_low
                crossings[CR_B_HIGH + count] = b_high
                crossings[CR_SIDE + count] = 0.0
                count += 1
                ridge += 1
                if ridge == MAX_RIDGES:
                    break
    return count


@kernel(contract=True)
def locate_crossings(count: int, placement: Array, bolt: Array, nut: Array, crossings: Array) -> None:
    """Locates the listed crossings in their pieces by regula falsi, and sets A and phi there.

    The slope at a retained end is reduced as Anderson and Bjorck (1973) do, for superlinear convergence.
    """
    k = bolt[pk.LEAD] / TWO_PI
    bolt_numbers = profile_numbers(bolt)
    nut_numbers = profile_numbers(nut)
    placement_values = placement_numbers(placement)
    for i in range(CROSSINGS_SIZE // MAX_CROSSINGS):
        for j in range(count, count + BATCH):
            crossings[i * MAX_CROSSINGS + j] = crossings[i * MAX_CROSSINGS]
    narrow = CROSSING_TOLERANCE * bolt[pk.P]
    for first in range(0, count, BATCH):
        batch = crossings[first:]
        for _ in range(MAX_CROSSING_STEPS):
            unconverged = 0
            for j in range(BATCH):
                low = batch[CR_LOW + j]
                high = batch[CR_HIGH + j]
                b_low = batch[CR_B_LOW + j]
                b_high = batch[CR_B_HIGH + j]
                side = batch[CR_SIDE + j]
                z = (low * b_high - high * b_low) / (b_high - b_low)
                r, slope, _, _ = radius_and_slope(z - k * batch[CR_THETA + j], bolt_numbers)
                cos = batch[CR_COS + j]
                sin = batch[CR_SIN + j]
                phi, a, b = slopes(r * cos, r * sin, z, slope * cos, slope * sin, k, placement_values, nut_numbers)
                up = b > 0.0
                factor = 1.0 - b / (b_low if up else b_high)
                factor = factor if factor > 0.0 else 0.5
                # Where a slope was exactly zero the next one is divided by it.
                factor = factor if factor <= 1.0 else 0.5
                batch[CR_Z + j] = z
                batch[CR_A + j] = a
                batch[CR_PHI + j] = phi
                batch[CR_LOW + j] = z if up else low
                batch[CR_HIGH + j] = high if up else z
                reduced_low = factor * b_low if side > 0.0 else b_low
                reduced_high = factor * b_high if side < 0.0 else b_high
                batch[CR_B_LOW + j] = b if up else reduced_low
                batch[CR_B_HIGH + j] = reduced_high if up else b
                batch[CR_SIDE + j] = -1.0 if up else 1.0
                wide = batch[CR_HIGH + j] - batch[CR_LOW + j] > narrow
                unconverged += 1 if wide and abs(b) > SLOPE_TOLERANCE else 0
            if unconverged == 0:
                break


@kernel()
def list_maxima(
    count: int, advance: float, step: float, max_z_gap: float, max_phi_gap: float, crossings: Array, maxima: Array
) -> int:
    """Estimates where (theta, z) phi is highest along the ridges, from their crossings; returns the number of maxima.

    Columns are ``step`` (rad) apart, over which the helix advances by ``advance``. Crossings of neighbouring columns
    belong to two ridges if their z differ by more than ``max_z_gap`` from that, or phi by more than ``max_phi_gap`` and
    what its slope explains. A maximum lies between two columns, or between a column and a ridge's end.
    """
    places = 0
    before = 0
    before_end = 0
    column = crossings[CR_COLUMN]
    while before < count:
        # The crossings of one column, from ``before`` on, and of the next, from ``after`` on.
        after = before_end
        after_end = after
        while after_end < count and crossings[CR_COLUMN + after_end] == column:
            after_end += 1
        column += 1.0
        while before < before_end or after < after_end:
            is_before = before < before_end
            is_after = after < after_end
            i, j = before, after
            if is_before and is_after:
                z_excess = crossings[CR_Z + j] - crossings[CR_Z + i] - advance
                rise = abs(crossings[CR_PHI + j] - crossings[CR_PHI + i])
                slope = 0.5 * (abs(crossings[CR_A + i]) + abs(crossings[CR_A + j]))
                z_gap = max_z_gap if rise < max_phi_gap + slope * step else 0.0
                is_before = z_excess > -z_gap or (z_gap == 0.0 and z_excess == 0.0)
                is_after = z_excess < z_gap
            before += 1 if is_before else 0
            after += 1 if is_after else 0
            if (is_before and not crossings[CR_A + i] > 0.0) or (is_after and not crossings[CR_A + j] < 0.0):
                continue
            w = 1.0 if is_after else 0.0
            if is_before and is_after:
                w = crossings[CR_A + i] / (crossings[CR_A + i] - crossings[CR_A + j])
            if not is_before:
                i = j
            if not is_after:
                j = i
            maxima[places, 0] = crossings[CR_THETA + i] + w * (crossings[CR_THETA + j] - crossings[CR_THETA + i])
            maxima[places, 1] = crossings[CR_Z + i] + w * (crossings[CR_Z + j] - crossings[CR_Z + i])
            places += 1
        before = before_end
        before_end = after_end
    return places
