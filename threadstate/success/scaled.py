"""Success maps in another unit of length."""

from __future__ import annotations

from dataclasses import replace

from threadstate.success.model import Cell, OrientationMap
from threadstate.units import scale_length


def scaled_cell(cell: Cell, factor: float) -> Cell:
    """A path with its shift, and its torque in N times a length, multiplied by ``factor``."""
    return replace(cell, torque=scale_length(cell.torque, factor), shift=scale_length(cell.shift, factor))


def scaled_orientation(found: OrientationMap, factor: float) -> OrientationMap:
    """The map of an orientation with its paths so scaled."""
    if factor == 1.0:
        return found
    return replace(found, cells=tuple(scaled_cell(cell, factor) for cell in found.cells))
