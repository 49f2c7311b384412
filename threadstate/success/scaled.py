"""Success maps in another unit of length."""

from __future__ import annotations

from dataclasses import replace

from threadstate.success.model import OrientationMap
from threadstate.units import scale_length


def scaled_orientation(found: OrientationMap, factor: float) -> OrientationMap:
    """The map of an orientation with its lengths, and its torques in N times a length, multiplied by ``factor``."""
    if factor == 1.0:
        return found
    return replace(
        found,
        cells=tuple(
            replace(cell, torque=scale_length(cell.torque, factor), shift=scale_length(cell.shift, factor))
            for cell in found.cells
        ),
    )
