"""The numbers of one state's contacts under a load."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate.statics import _numbers_kernel as nk

Floats = NDArray[np.float64]


class ContactNumbers(NamedTuple):
    """A row of numbers as ``_numbers_kernel`` lays them out, zero where they were not wanted, and of the holding
    friction the forces (k, 3) that balance the load and the motion (6) that no contact withstands.
    """

    row: Floats
    forces: Floats
    twist: Floats


def contact_numbers(wanted: int, load: Floats, points: Floats, normals: Floats) -> ContactNumbers:
    """What is ``wanted`` of contacts at points (k, 3) with normals (k, 3) under a load (6): lengths over the radius."""
    rows, forces, twists = np.zeros((1, nk.NUMBERS_SIZE)), np.zeros(points.size), np.zeros((1, 6))
    ends = np.array([len(points)], np.intp)
    nk.contact_rows(wanted, load[np.newaxis], points, normals, ends, forces, twists, rows)
    return ContactNumbers(rows[0], forces.reshape(-1, 3), twists[0])
