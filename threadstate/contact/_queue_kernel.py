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

# A queue: rows of the fields of ``Box``, the latest start first; their number is kept beside it.
Q_THETA, Q_HALF, Q_START, Q_END = range(4)


@kernel(allocates=True)
def new_queue() -> Array:
    """A queue with room for so many boxes."""
    return np.empty((ROOM, 4))


@kernel(forceinline=True)
def set_row(box: Box, i: int, queue: Array) -> None:
    """Sets the box in a row."""
    queue[i, Q_THETA], queue[i, Q_HALF], queue[i, Q_START], queue[i, Q_END] = box


@kernel(forceinline=True)
def row(i: int, queue: Array) -> Box:
    """The box in a row."""
    return Box(queue[i, Q_THETA], queue[i, Q_HALF], queue[i, Q_START], queue[i, Q_END])


@kernel(forceinline=True)
def add(box: Box, count: int, queue: Array) -> int:
    """Adds a box to the ``count`` in a queue that has room; returns their number then.

    The parts of the earliest boxes start about as early, so that few are to be passed.
    """
    i = count
    while i > 0 and queue[i - 1, Q_START] < box.start:
        for j in range(4):
            queue[i, j] = queue[i - 1, j]
        i -= 1
    set_row(box, i, queue)
    return count + 1
