"""Two states of an orientation followed towards each other, to where their labels part: an estimate without a search.

The contacts of both are guesses (``_follow_kernel``). Two contacts at one time, a contact that ends at a fold, the
border of a region and the threshold of a class are where the labels of what is followed change, and the phase of that
is bisected at little cost. A contact that neither state has is not known here: whole solves confirm what is found.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _record_kernel as rk
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._guess_kernel import (
    GUESS_SIZE,
    GUESSES,
    Work,
    clear_guesses,
    new_work,
    set_guesses,
)
from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.contact._stage_kernel import FLUSH
from threadstate.history._follow_kernel import follow_pose

Array = NDArray[np.float64]

# What decides on labels beside contacts: the limit of a turn (rad), the tolerance of embedments and the threshold of
# pivot offsets, the distance at which a contact is another one, and those by which contacts and the bolt's origin may
# move within the last stretch where nothing jumps.
L_TURN_LIMIT, L_EMBEDMENT, L_PIVOT, L_PLACE, L_STEADY_PLACE, L_STEADY_HEIGHT = range(6)
LIMITS_SIZE = 6

COMPARED_FLAGS = rk.FLAG_FLUSH | rk.FLAG_GRAZING | rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD
"""The others are those of single phases, or of ties, which are not followed."""

MOST_STEPS = 200
MOST_DOUBTFUL = 64
"""Most poses that are followed for an estimate, and most phases at which labels were seen to be others from far."""


@kernel()
def class_number(record: Array, embedment: float, limits: Array) -> int:
    """A number of its own for each class of a record with this embedment (method, section 5)."""
    if int(record[rk.O_FLAGS]) & rk.FLAG_FLUSH:
        return 0
    if math.isnan(record[rk.O_MU]):
        return 2
    if embedment > limits[L_EMBEDMENT] and record[rk.O_DROP] <= embedment:
        return 2
    return 1 if record[rk.O_PIVOT] <= limits[L_PIVOT] else 0


@kernel()
def labels_agree(one: Array, other: Array, first_only: bool) -> bool:
    """Whether the contacts of two records have the same labels, and the compared flags are the same.

    Of stage 1 alone with ``first_only``.
    """
    if not first_only:
        if (int(one[rk.O_FLAGS]) ^ int(other[rk.O_FLAGS])) & COMPARED_FLAGS:
            return False
        if one[rk.O_CONTACTS] != other[rk.O_CONTACTS]:
            return False
    for i in range(int(one[rk.O_CONTACTS])):
        c = rk.O_CONTACT + rk.POINT_SIZE * i
        if first_only and (i >= int(other[rk.O_CONTACTS]) or one[c + rk.P_STAGE] > 1.0):
            break
        for column in (rk.P_STAGE, rk.P_PAIR, rk.P_BOLT_REGION, rk.P_NUT_REGION):
            if one[c + column] != other[c + column]:
                return False
    return True


@kernel()
def most_apart(one: Array, other: Array, first_only: bool) -> float:
    """How far apart contacts of two records of the same labels are at most, corners of patches left out."""
    most = 0.0
    for i in range(int(one[rk.O_CONTACTS])):
        c = rk.O_CONTACT + rk.POINT_SIZE * i
        if int(one[c + rk.P_PAIR]) == FLUSH or (first_only and one[c + rk.P_STAGE] > 1.0):
            continue
        apart = 0.0
        for j in range(c + rk.P_POINT, c + rk.P_POINT + 3):
            apart += (one[j] - other[j]) ** 2
        most = max(most, math.sqrt(apart))
    return most


@kernel()
def most_fallen(one: Array, other: Array, first_only: bool) -> float:
    """How far apart heights of the bolt's origin are at most, in poses that two records of the same labels have."""
    most = 0.0
    for i in range(1 if first_only else int(one[rk.O_POSES])):
        z = rk.O_POSE + 12 * i + 11
        most = max(most, abs(one[z] - other[z]))
    return most


@kernel()
def is_near(one: Array, other: Array, first_only: bool, limits: Array) -> bool:
    """Whether two records have the same labels, and contacts and heights no farther apart than if nothing jumps."""
    return (
        labels_agree(one, other, first_only)
        and most_apart(one, other, first_only) < limits[L_STEADY_PLACE]
        and most_fallen(one, other, first_only) < limits[L_STEADY_HEIGHT]
    )


@kernel()
def is_one_throughout(
    roll: float,
    pitch: float,
    low: float,
    high: float,
    low_record: Array,
    high_record: Array,
    first_only: bool,
    limits: Array,
    guesses: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    record: Array,
) -> bool:
    """Whether the state at either end of a stretch, followed alone, is that at the other; in the middle they meet."""
    clear_guesses(guesses)
    middle = scratch(RECORD_SIZE)
    turn_limit = limits[L_TURN_LIMIT]
    of_one = guesses[: rk.MAX_RECORD_CONTACTS]
    for step in range(2):
        end, other_record = (high, high_record) if step == 0 else (low, low_record)
        set_guesses(low_record if step == 0 else high_record, of_one)
        half_way = math.radians(0.5 * (low + high))
        if not follow_pose(roll, pitch, half_way, turn_limit, guesses, bolt, nut, work, record):
            return False
        if step == 0:
            copy_numbers(record, middle)
        elif not is_near(record, middle, first_only, limits):
            return False
        if not follow_pose(roll, pitch, math.radians(end), turn_limit, guesses, bolt, nut, work, record):
            return False
        if not is_near(record, other_record, first_only, limits):
            return False
    return True


@kernel()
def place_of_change(
    roll: float,
    pitch: float,
    low: float,
    high: float,
    width: float,
    low_record: Array,
    high_record: Array,
    first_only: bool,
    limits: Array,
    guesses: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    record: Array,
) -> float:
    """The phase between two (deg) at which what is followed from both records (at roll and pitch in rad) ceases to have
    the low one's labels, or jumps. NaN where it cannot be followed, infinite where it is one and the same throughout.

    It is certain, of what is followed, to ``width``.
    """
    e_low, e_high = low_record[rk.O_EMBEDMENT], high_record[rk.O_EMBEDMENT]
    low_class = class_number(low_record, e_low, limits)
    # Where contacts have the same labels on both sides, the class alone may differ, or a contact be another one.
    by_place = labels_agree(low_record, high_record, first_only)
    by_class = by_place and not first_only and low_class != class_number(high_record, e_high, limits)
    by_place = by_place and not by_class
    if by_place and is_one_throughout(
        roll, pitch, low, high, low_record, high_record, first_only, limits, guesses, bolt, nut, work, record
    ):
        return math.inf
    of_low, of_high = guesses[: rk.MAX_RECORD_CONTACTS], guesses[rk.MAX_RECORD_CONTACTS :]
    set_guesses(low_record, of_low)
    set_guesses(high_record, of_high)
    low_side, high_side = scratch(RECORD_SIZE), scratch(RECORD_SIZE)
    copy_numbers(low_record, low_side)
    copy_numbers(high_record, high_side)
    a = low
    # Phases at which the labels were others, the nearest last: seen from far, where a contact may have been lost.
    others = scratch(MOST_DOUBTFUL)
    others[0] = high
    count = 1
    for step in range(MOST_STEPS):
        again = step > 0 and others[count - 1] - a <= width
        if again and by_place:
            break
        phase = low if step == 0 else others[count - 1] if again else 0.5 * (a + others[count - 1])
        followed = follow_pose(roll, pitch, math.radians(phase), limits[L_TURN_LIMIT], guesses, bolt, nut, work, record)
        like = followed and labels_agree(record, low_record, first_only)
        if like and by_class:
            share = (phase - low) / (high - low)
            e = e_low if math.isnan(e_high) else e_high if math.isnan(e_low) else e_low + share * (e_high - e_low)
            like = class_number(record, e, limits) == low_class
        if like and by_place:
            like = most_apart(record, low_side, first_only) <= most_apart(record, high_side, first_only)
        if step == 0 and not like:
            return math.nan
        if like:
            a = phase
            copy_numbers(record, low_side)
            set_guesses(record, of_low)
            if again:
                count -= 1
            if count == 0:
                break
        else:
            if followed and labels_agree(record, high_record, first_only):
                copy_numbers(record, high_side)
                set_guesses(record, of_high)
            if again or count == MOST_DOUBTFUL:
                break
            others[count] = phase
            count += 1
    if count == 0:
        return math.nan
    if by_place:
        if is_near(low_side, high_side, first_only, limits):
            return math.inf
        jumps = most_fallen(low_side, high_side, first_only) > 2.0 * limits[L_STEADY_HEIGHT]
        if not jumps and most_apart(low_side, high_side, first_only) < limits[L_PLACE]:
            return math.nan
    return 0.5 * (a + others[count - 1])


@kernel(nogil=True, allocates=True)
def places_of_changes(
    orientations: Array,
    low: Array,
    high: Array,
    widths: Array,
    low_records: Array,
    high_records: Array,
    first_only: bool,
    limits: Array,
    bolt: Array,
    nut: Array,
    places: Array,
) -> None:
    """Sets :func:`place_of_change` of n stretches: orientations of shape (n, 2), in rad, and phases, in deg."""
    guesses = np.empty((GUESSES, GUESS_SIZE))
    record = np.empty(rk.RECORD_SIZE)
    work = new_work()
    for i in range(low.shape[0]):
        places[i] = place_of_change(
            orientations[i, 0],
            orientations[i, 1],
            low[i],
            high[i],
            widths[i],
            low_records[i],
            high_records[i],
            first_only,
            limits,
            guesses,
            bolt,
            nut,
            work,
            record,
        )
