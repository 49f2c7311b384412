"""What a success map says: shares, needs and critical frictions of orientations, and the tilts that all succeed."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import LARGEST_CCW_TURN_DEG, WHOLE_TURN_DEG
from threadstate.device.strategy import CLOCKWISE_DEG
from threadstate.library.grid import Grid
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap


@dataclass(frozen=True, slots=True)
class OrientationSummary:
    """An orientation at one friction, over the starting phases of the grid.

    ``engaged`` of ``phases`` end engaged, ``undecided`` without a certain outcome. ``torque``, ``tilt_deg`` and
    ``shift`` are the largest that those which engage ask of the device, None where none does. ``worst_phase_deg`` is
    the first phase with a certain outcome from which the bolt does not engage, else the first undecided one; where all
    engage, the one with the largest torque.
    """

    mu: float
    phases: int
    engaged: int
    undecided: int
    torque: float | None
    tilt_deg: float | None
    shift: float | None
    worst_phase_deg: float

    @property
    def share(self) -> float:
        """The part of the phases that engages, 0 to 1."""
        return self.engaged / self.phases

    @property
    def all_engage(self) -> bool:
        """Whether every phase engages."""
        return self.engaged == self.phases


@dataclass(frozen=True, slots=True)
class TiltArea:
    """The orientations of a grid that engage from every phase, at one friction.

    ``around_level`` of them are connected with the level one by neighbours in roll or pitch, 0 where that one does not
    engage; ``largest`` is the largest number that are connected at all. ``cell_deg2`` is the area of an orientation:
    the square of the grid's step, in square degrees; 0 for a grid of one orientation.
    """

    mu: float
    orientations: int
    engaged: int
    around_level: int
    largest: int
    cell_deg2: float


@dataclass(frozen=True, slots=True)
class MapCounts:
    """How the paths of a map end at one friction, those of the grid alone; ``bounded`` passed the limit of points."""

    mu: float
    outcomes: tuple[tuple[AssemblyOutcome, int], ...]
    flags: tuple[tuple[str, int], ...]
    bounded: int


@dataclass(frozen=True, slots=True)
class LateSnaps:
    """Paths of a map that end without a snap, though a hand that turns farther meets one at a friction.

    ``paths`` is how many: the bolt of the same orientation snaps from other starting phases, and engages, at a phase
    that a turn of at most 450 deg reaches. ``turn_deg`` reaches that of each of them, None where there are none. That
    the bolt of such a path would snap there as well is likely, not computed.
    """

    mu: float
    paths: int
    turn_deg: float | None


def orientation_summary(found: OrientationMap, grid: Grid, mu: float) -> OrientationSummary:
    """The summary of an orientation at a friction of the map."""
    cells = grid_cells(found, grid, mu)
    engaged = [cell for cell in cells if cell.engages]
    failed = sorted((cell for cell in cells if not cell.engages), key=lambda cell: not cell.is_decided)
    worst = failed[0] if failed else max(cells, key=lambda cell: cell.torque or 0.0)
    return OrientationSummary(
        mu,
        len(cells),
        len(engaged),
        sum(not cell.is_decided for cell in cells),
        max((cell.torque for cell in engaged if cell.torque is not None), default=None),
        max((cell.tilt_deg for cell in engaged if cell.tilt_deg is not None), default=None),
        max((cell.shift for cell in engaged if cell.shift is not None), default=None),
        worst.phase_deg,
    )


def tilt_area(orientations: Sequence[OrientationMap], grid: Grid, mu: float) -> TiltArea:
    """The tilts that engage from every phase at a friction of the map."""
    engaging = {
        divmod(one.index, grid.tilt_count) for one in orientations if orientation_summary(one, grid, mu).all_engage
    }
    sets = _connected(engaging)
    level = (grid.tilt_count // 2, grid.tilt_count // 2)
    around_level = next((len(one) for one in sets if level in one), 0)
    step_deg = grid.tilt_step_deg if grid.tilt_count > 1 else 0.0
    largest = max(map(len, sets), default=0)
    return TiltArea(mu, len(orientations), len(engaging), around_level, largest, step_deg**2)


def map_counts(orientations: Sequence[OrientationMap], grid: Grid, mu: float) -> MapCounts:
    """How the paths of the grid end at a friction of the map."""
    cells = [cell for one in orientations for cell in grid_cells(one, grid, mu)]
    outcomes = Counter(cell.outcome for cell in cells)
    flags = Counter(flag.value for cell in cells for flag in cell.flags)
    return MapCounts(
        mu,
        tuple((outcome, outcomes[outcome]) for outcome in AssemblyOutcome if outcomes[outcome]),
        tuple(sorted(flags.items())),
        sum(cell.is_bounded for cell in cells),
    )


def late_snaps(orientations: Sequence[OrientationMap], inputs: SuccessInputs, mu: float) -> LateSnaps:
    """The paths of the grid that end soon before a snap, at a friction of a map by ``ccw_then_cw``."""
    hand = math.copysign(1.0, inputs.pair.lead)
    turns_deg = []
    for found in orientations:
        cells = grid_cells(found, inputs.grid, mu)
        snaps_deg = [one.end_deg + CLOCKWISE_DEG * hand for one in cells if one.engages and one.end_deg is not None]
        for one in cells:
            if one.outcome is AssemblyOutcome.NO_SNAP and snaps_deg:
                turn_deg = inputs.device.ccw_turn_deg
                beyond = min((hand * (snap_deg - one.phase_deg) - turn_deg) % WHOLE_TURN_DEG for snap_deg in snaps_deg)
                turns_deg.append(turn_deg + beyond)
    reached = [turn_deg for turn_deg in turns_deg if turn_deg <= LARGEST_CCW_TURN_DEG]
    return LateSnaps(mu, len(reached), max(reached, default=None))


def grid_cells(found: OrientationMap, grid: Grid, mu: float) -> list[Cell]:
    """The cells of an orientation at a friction of the map, from the starting phases of the grid."""
    return [found.cell_at[mu, phase_deg] for phase_deg in grid.phases_deg]


def _connected(places: Collection[tuple[int, int]]) -> list[set[tuple[int, int]]]:
    """The sets of places that are connected by neighbours in one of both numbers."""
    left = set(places)
    sets = []
    while left:
        found = {left.pop()}
        new = set(found)
        while new:
            i, j = new.pop()
            near = {(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)} & left
            left -= near
            found |= near
            new |= near
        sets.append(found)
    return sets
