"""A published library of settled states of the default pair."""

from __future__ import annotations

from threadstate.device.model import Device, SettledState, default_device
from threadstate.device.settle import settle_poses
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.rows import settled_rows
from threadstate.settled.write import open_settled, publish_settled, write_settled
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
LEVEL = Grid(0.0, 1.0, 90.0)
"""The level orientation at four phases."""


def store_settled(database: str, grid: Grid = LEVEL, device: Device | None = None) -> list[SettledState]:
    """Publish the library of a grid and a device (None: the default one) in a migrated database.

    Returns:
        Its states, in order.
    """
    inputs = SettledInputs(PAIR, grid, device or default_device())
    states: list[SettledState] = []
    with writing(database) as engine:
        library_id = open_settled(engine, inputs)
        for index in range(grid.orientation_count):
            found = settle_poses(PAIR, grid.poses(index), inputs.device)
            rows = settled_rows(grid.orientation(index), grid.first_ordinal(index), found)
            write_settled(engine, library_id, rows)
            states += found
        publish_settled(engine, library_id, grid)
    return states
