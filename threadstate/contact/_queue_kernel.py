"""Boxes of azimuth and time that wait to be looked at, the earliest start first: an early contact spares later ones.

Of boxes that start together the one that came last, in the last row, is the first. What comes next hangs on the boxes
alone, so that the same search goes the same way.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._edge_kernel import Box

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

ROOM = 8192

STACKS, USED, FREE = range(3)


class Queue(NamedTuple):
    """Boxes that wait, in stacks of those that start together.

    Attributes:
        boxes: rows of the fields of ``Box``.
        before: of each row the one that was added before it to the same stack, -1: none; of a free one the next free.
        starts: the start of each stack, the latest first.
        tops: the row of each stack that was added last.
        state: the number of stacks, that of rows that were ever used, and the first of those that are free.
    """

    boxes: Array
    before: Rows
    starts: Array
    tops: Rows
    state: Rows


@kernel(allocates=True)
def new_queue() -> Queue:
    """A queue with room for so many boxes."""
    return Queue(
        np.empty((ROOM, 4)),
        np.empty(ROOM, np.int64),
        np.empty(ROOM),
        np.empty(ROOM, np.int64),
        np.empty(3, np.int64),
    )


@kernel(forceinline=True)
def clear(queue: Queue) -> None:
    """Removes all boxes."""
    queue.state[STACKS], queue.state[USED], queue.state[FREE] = 0, 0, -1


@kernel(forceinline=True)
def set_row(box: Box, i: int, queue: Queue) -> None:
    """Sets the box in a row."""
    queue.boxes[i, 0], queue.boxes[i, 1], queue.boxes[i, 2], queue.boxes[i, 3] = box


@kernel(forceinline=True)
def row(i: int, queue: Queue) -> Box:
    """The box in a row."""
    return Box(queue.boxes[i, 0], queue.boxes[i, 1], queue.boxes[i, 2], queue.boxes[i, 3])


@kernel(forceinline=True)
def add(box: Box, queue: Queue) -> None:
    """Adds a box to a queue that has room.

    The parts of the earliest boxes start about as early, so that few stacks are to be passed.
    """
    _, before, starts, tops, state = queue
    stack = state[STACKS]
    while stack > 0 and starts[stack - 1] < box.start:
        stack -= 1
    if stack > 0 and starts[stack - 1] == box.start:
        stack -= 1
    else:
        for i in range(state[STACKS], stack, -1):
            starts[i], tops[i] = starts[i - 1], tops[i - 1]
        starts[stack], tops[stack] = box.start, -1
        state[STACKS] += 1
    place = state[FREE]
    if place >= 0:
        state[FREE] = before[place]
    else:
        place = state[USED]
        state[USED] += 1
    set_row(box, place, queue)
    before[place] = tops[stack]
    tops[stack] = place


@kernel(forceinline=True)
def first(queue: Queue) -> Box:
    """The first box of a queue that has one."""
    return row(queue.tops[queue.state[STACKS] - 1], queue)


@kernel(forceinline=True)
def remove_first(queue: Queue) -> None:
    """Removes the first box of a queue that has one."""
    _, before, _, tops, state = queue
    stack = state[STACKS] - 1
    place = tops[stack]
    tops[stack] = before[place]
    if tops[stack] < 0:
        state[STACKS] = stack
    before[place], state[FREE] = state[FREE], place
