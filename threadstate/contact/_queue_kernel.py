"""Boxes of azimuth and time that wait to be looked at, the earliest start first: an early contact spares later ones.

Of boxes that start together the one that came last, in the last row, is the first. What comes next hangs on the boxes
alone, so that the same search goes the same way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._edge_kernel import Box

Array = NDArray[np.float64]

ROOM = 8192

# A queue: rows of the fields of ``Box`` and of the row that was added before it with the same start, -1: none. Such
# rows are a stack, and the stacks are sorted, the latest start first: in their own columns of the first rows the start
# of each and its top. One more row has the number of stacks, that of rows that were ever used, and the first of those
# that are free, each of which names the next.
Q_THETA, Q_HALF, Q_START, Q_END, Q_NEXT, Q_STACK_START, Q_TOP = range(7)
STATE = ROOM
S_STACKS, S_USED, S_FREE = range(3)


@kernel(allocates=True)
def new_queue() -> Array:
    """A queue with room for so many boxes, each row of the length of a cache line."""
    return np.empty((ROOM + 1, 8))


@kernel(forceinline=True)
def clear(queue: Array) -> None:
    """Removes all boxes."""
    queue[STATE, S_STACKS], queue[STATE, S_USED], queue[STATE, S_FREE] = 0.0, 0.0, -1.0


@kernel(forceinline=True)
def set_row(box: Box, i: int, queue: Array) -> None:
    """Sets the box in a row."""
    queue[i, Q_THETA], queue[i, Q_HALF], queue[i, Q_START], queue[i, Q_END] = box


@kernel(forceinline=True)
def row(i: int, queue: Array) -> Box:
    """The box in a row."""
    return Box(queue[i, Q_THETA], queue[i, Q_HALF], queue[i, Q_START], queue[i, Q_END])


@kernel(forceinline=True)
def add(box: Box, queue: Array) -> None:
    """Adds a box to a queue that has room.

    The parts of the earliest boxes start about as early, so that few stacks are to be passed.
    """
    count = int(queue[STATE, S_STACKS])
    stack = count
    while stack > 0 and queue[stack - 1, Q_STACK_START] < box.start:
        stack -= 1
    if stack > 0 and queue[stack - 1, Q_STACK_START] == box.start:
        stack -= 1
    else:
        for i in range(count, stack, -1):
            queue[i, Q_STACK_START], queue[i, Q_TOP] = queue[i - 1, Q_STACK_START], queue[i - 1, Q_TOP]
        queue[stack, Q_STACK_START], queue[stack, Q_TOP] = box.start, -1.0
        queue[STATE, S_STACKS] += 1.0
    place = int(queue[STATE, S_FREE])
    if place >= 0:
        queue[STATE, S_FREE] = queue[place, Q_NEXT]
    else:
        place = int(queue[STATE, S_USED])
        queue[STATE, S_USED] += 1.0
    set_row(box, place, queue)
    queue[place, Q_NEXT] = queue[stack, Q_TOP]
    queue[stack, Q_TOP] = place


@kernel(forceinline=True)
def first(queue: Array) -> Box:
    """The first box of a queue that has one."""
    return row(int(queue[int(queue[STATE, S_STACKS]) - 1, Q_TOP]), queue)


@kernel(forceinline=True)
def remove_first(queue: Array) -> None:
    """Removes the first box of a queue that has one."""
    stack = int(queue[STATE, S_STACKS]) - 1
    place = int(queue[stack, Q_TOP])
    queue[stack, Q_TOP] = queue[place, Q_NEXT]
    if queue[stack, Q_TOP] < 0.0:
        queue[STATE, S_STACKS] = stack
    queue[place, Q_NEXT], queue[STATE, S_FREE] = queue[STATE, S_FREE], place
