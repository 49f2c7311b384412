"""Triangles between two rows of vertices that run beside each other."""

from __future__ import annotations

from threadstate.mesh.solid import Floats


def strip(low: Floats, high: Floats, first_low: int, first_high: int) -> list[tuple[int, int, int]]:
    """Triangles between two rows, whose vertices are numbered from ``first_low`` and ``first_high`` on.

    ``low`` and ``high`` say where each vertex lies along its row, ascending; the row that lags behind goes on. Seen
    with ``high`` to the right of ``low`` and both running up, triangles are counter-clockwise.
    """
    triangles = []
    i, j = 0, 0
    last_i, last_j = len(low) - 1, len(high) - 1
    along_low, along_high = low.tolist(), high.tolist()
    while i < last_i or j < last_j:
        if j == last_j or (i < last_i and along_low[i + 1] <= along_high[j + 1]):
            triangles.append((first_low + i, first_high + j, first_low + i + 1))
            i += 1
        else:
            triangles.append((first_low + i, first_high + j, first_high + j + 1))
            j += 1
    return triangles
