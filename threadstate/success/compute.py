"""All that a success map holds of an orientation, computed."""

from __future__ import annotations

from collections import defaultdict

from threadstate.device.branches import KnownPaths
from threadstate.device.command import LONGEST_STEP_DEG, LONGEST_STEP_WITH_FRICTION_DEG
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.bounded import bounded_cell
from threadstate.success.model import Cell, OrientationMap
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
    known: defaultdict[float, KnownPaths] = defaultdict(KnownPaths)

    def compute(phase_deg: float, mu: float) -> Cell:
        pose_deg = (orientation.roll_deg, orientation.pitch_deg, phase_deg)
        return bounded_cell(pair, device, strategy, pose_deg, mu, point_limit, known=known[mu])

    def ends_alike(cell: Cell) -> bool:
        pose_deg = (orientation.roll_deg, orientation.pitch_deg, cell.phase_deg)
        longest_deg = LONGEST_STEP_WITH_FRICTION_DEG if cell.mu > 0.0 else LONGEST_STEP_DEG
        again = bounded_cell(pair, device, strategy, pose_deg, cell.mu, 2 * point_limit, 0.5 * longest_deg)
        return again.outcome is cell.outcome

    cells, boundaries, critical = mapped_cells(
        compute, ends_alike, grid.phases_deg, frictions, phase_tolerance_deg, mu_tolerance
    )
    return OrientationMap(index, orientation.roll_deg, orientation.pitch_deg, cells, boundaries, critical)
