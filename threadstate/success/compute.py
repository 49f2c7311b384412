"""All that a success map holds of an orientation, computed."""

from __future__ import annotations

from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.model import OrientationMap
from threadstate.success.orientation_paths import OrientationPaths
from threadstate.success.search import mapped_cells
from threadstate.thread.pair import Pair


def computed_orientation(
    pair: Pair,
    device: Device,
    strategy: Strategy,
    grid: Grid,
    frictions: tuple[float, ...],
    phase_tolerance_deg: float,
    mu_tolerance: float,
    point_limit: int,
    index: int,
) -> OrientationMap:
    """The map of the orientation with this number in the grid; the arguments are those of ``SuccessInputs``.

    What this imports decides which map is which: see ``threadstate.success.inputs``.
    """
    orientation = grid.orientation(index)
    roll_deg, pitch_deg = orientation.roll_deg, orientation.pitch_deg
    phases_deg = grid.phases_deg
    paths = OrientationPaths(pair, device, strategy, roll_deg, pitch_deg, point_limit, len(phases_deg) > 1)
    cells, boundaries, critical = mapped_cells(
        paths.cell, paths.ends_alike, phases_deg, frictions, phase_tolerance_deg, mu_tolerance
    )
    return OrientationMap(index, roll_deg, pitch_deg, cells, boundaries, critical)
