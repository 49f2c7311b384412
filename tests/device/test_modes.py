"""Modes that are given up before their equations are solved: those that converge to forces out of their cones."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.device._modes_kernel import OPENS, SLIPS, STICKS, leaves_cones

pytestmark = pytest.mark.slow

MU = 0.5


@pytest.mark.parametrize(
    ("modes", "forces", "expected"),
    [
        ((STICKS,), (1.0, 0.3, 0.4), False),
        ((STICKS,), (1.0, 0.6, 0.8), True),
        ((SLIPS,), (1.0, 0.6, 0.8), False),
        ((SLIPS,), (-0.2, 0.0, 0.1), True),
        ((SLIPS,), (-0.05, 0.0, 0.0), False),
        ((STICKS,), (1.0, 0.0, 0.55), False),
        ((OPENS, STICKS), (1.0, 0.3, 0.4), False),
        ((SLIPS, OPENS, STICKS), (1.0, 0.5, 0.0, 1.0, 0.6, 0.8), True),
    ],
)
def test_forces_leave_their_cones_by_more_than_what_is_left(
    modes: tuple[int, ...], forces: tuple[float, ...], expected: bool
) -> None:
    """Contacts that open have no forces; of those that slide the size of friction is one of their equations."""
    assert leaves_cones(np.array(modes), len(modes), MU, 0.1, np.array(forces)) is expected
