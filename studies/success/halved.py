"""Boundaries of outcome confirmed from both sides, by paths of half the step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studies.success.study import StudiedMap
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.command import LONGEST_STEP_DEG, LONGEST_STEP_WITH_FRICTION_DEG
from threadstate.success.bounded import bounded_cell
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell
from threadstate.success.search import TURN_DEG


@dataclass(frozen=True)
class Side:
    """A path beside a boundary, as the map has it."""

    inputs: SuccessInputs
    roll_deg: float
    pitch_deg: float
    cell: Cell

    def halved(self) -> Cell:
        """The same path with half the step, and twice as many points allowed."""
        longest_deg = LONGEST_STEP_WITH_FRICTION_DEG if self.cell.mu > 0.0 else LONGEST_STEP_DEG
        inputs = self.inputs
        return bounded_cell(
            inputs.pair,
            inputs.device,
            inputs.strategy,
            (self.roll_deg, self.pitch_deg, self.cell.phase_deg),
            self.cell.mu,
            2 * inputs.point_limit,
            0.5 * longest_deg,
        )


@dataclass(frozen=True)
class Confirmed:
    """What half the step says of a map's boundaries.

    Attributes:
        boundaries: those with two certain outcomes.
        paths: the paths beside them, each counted once.
        changed: the paths that end otherwise, with the cell of half the step.
    """

    boundaries: int
    paths: int
    changed: tuple[tuple[Side, Cell], ...]


def sides(one: StudiedMap) -> list[Side]:
    """The paths on both sides of all boundaries with two certain outcomes, each once."""
    found: dict[tuple[int, float, float], Side] = {}
    for orientation in one.orientations:
        for boundary in orientation.boundaries:
            cells = [
                orientation.cell_at[boundary.mu, phase_deg % TURN_DEG]
                for phase_deg in (boundary.from_deg, boundary.to_deg)
            ]
            if all(cell.is_decided for cell in cells):
                for cell in cells:
                    key = (orientation.index, cell.mu, cell.phase_deg)
                    found[key] = Side(one.inputs, orientation.roll_deg, orientation.pitch_deg, cell)
    return list(found.values())


def halved(side: Side) -> Cell:
    """The path of a side with half the step, for processes to call."""
    return side.halved()


def confirmed(one: StudiedMap, beside: Sequence[Side], cells: Sequence[Cell]) -> Confirmed:
    """What the paths of half the step, in the order of the sides, say."""
    boundaries = sum(
        AssemblyOutcome.UNDECIDED not in (boundary.outcome_before, boundary.outcome_after)
        for orientation in one.orientations
        for boundary in orientation.boundaries
    )
    changed = tuple(
        (side, cell) for side, cell in zip(beside, cells, strict=True) if cell.outcome is not side.cell.outcome
    )
    return Confirmed(boundaries, len(beside), changed)
