"""All that is stored of an orientation's settled states, computed."""

from __future__ import annotations

from threadstate.device.model import Device
from threadstate.device.settle import settle_poses
from threadstate.library.grid import Grid
from threadstate.settled.rows import SettledRows, settled_rows
from threadstate.thread.pair import Pair


def computed_rows(pair: Pair, grid: Grid, device: Device, index: int) -> SettledRows:
    """The settled states of all poses of an orientation, as rows.

    What this imports decides which library is which: see ``threadstate.settled.inputs``.
    """
    states = settle_poses(pair, grid.poses(index), device)
    return settled_rows(grid.orientation(index), grid.first_ordinal(index), states)
