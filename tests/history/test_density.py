"""A denser start finds the same boundaries."""

from __future__ import annotations

import pytest

from studies.history.boundaries import check_density
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()

SPREAD_DEG = 2e-6
"""So far round-off moves where a region of a flush patch changes."""


@pytest.mark.parametrize("orientation_deg", [(0.0, -4.0), (2.0, 3.0)])
def test_ten_times_the_density_finds_nothing_new(orientation_deg: tuple[float, float]) -> None:
    check = check_density(PAIR, [orientation_deg], 10)
    assert check.dense_solves > 3 * check.solves
    assert check.boundaries > 20
    assert [one for one in check.unmatched if not one.undecided and one.nearest_deg > SPREAD_DEG] == []
