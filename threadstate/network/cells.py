"""The cells of a library: for every orientation of its grid the phase circle, cut where a label changes."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, pairwise
from typing import NamedTuple

from threadstate.errors import InvalidValueError
from threadstate.network.formation import Formation
from threadstate.network.moves import Move
from threadstate.numbers import number_text
from threadstate.state.model import Flag
from threadstate.statics.verdict import Verdict

CIRCLE_DEG = 360.0

ROUNDING_DEG = 1e-9
"""By how much the end of a cell may differ from the start of the next one."""


@dataclass(frozen=True, slots=True)
class Cell:
    """An interval of phase of one orientation over which every label is constant.

    ``orientation`` is the orientation's number, ``position`` the cell's place (from 0) in its orientation, in order of
    phase. The cell is [``start_deg``, ``end_deg``), with ``start_deg`` in [0, 360) and ``end_deg`` above 360 where it
    holds phase 0. ``margin`` is the smallest margin of class and regions half way, a length; None where undecided.
    ``in_window`` says whether the bolt has fallen into the clearance window there. ``verdict`` is what a load does at a
    friction, None where cells are not those of a load.
    """

    orientation: int
    position: int
    start_deg: float
    end_deg: float
    formation: Formation
    flags: tuple[Flag, ...]
    margin: float | None
    in_window: bool
    verdict: Verdict | None = None

    @property
    def width_deg(self) -> float:
        """How much phase the cell covers."""
        return self.end_deg - self.start_deg


class Crossing(NamedTuple):
    """A stretch of phase in which a tilt leads from one cell to another.

    ``low_deg`` and ``high_deg`` lie between the start and the end of the former; 360 * ``lap`` deg less, they lie
    between those of the latter, whose number is ``target``.
    """

    move: Move
    target: int
    low_deg: float
    high_deg: float
    lap: int


@dataclass(frozen=True)
class CellMap:
    """All cells: ``cells[k]`` are those of orientation ``k = i_roll * n + i_pitch`` in order of phase.

    ``tilts_deg`` are the n values of roll, and of pitch, ascending. A cell ends where the next one begins; ends are
    made to do so exactly, and equal formations to be one object.

    Raises:
        InvalidValueError: tilts that do not ascend, not n * n orientations, cells that do not follow upon each
            other or do not close the circle.
    """

    tilts_deg: tuple[float, ...]
    cells: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        tilts = self.tilts_deg
        if not tilts or any(low >= high for low, high in pairwise(tilts)):
            raise InvalidValueError("tilts", tilts, "at least one, ascending")
        if len(self.cells) != len(tilts) ** 2:
            raise InvalidValueError("number of orientations", len(self.cells), f"{len(tilts) ** 2}")
        formations: dict[Formation, Formation] = {}
        joined = tuple(_joined(number, cells, formations) for number, cells in enumerate(self.cells))
        object.__setattr__(self, "cells", joined)

    @property
    def orientation_count(self) -> int:
        """How many pairs of roll and pitch there are."""
        return len(self.cells)

    @property
    def total_deg(self) -> float:
        """The phase of all orientations together."""
        return CIRCLE_DEG * len(self.cells)

    @cached_property
    def formations(self) -> tuple[Formation, ...]:
        """All formations, in order of their keys.

        Raises:
            InvalidValueError: two formations have the same key.
        """
        formations = sorted({cell.formation for cell in self.all_cells}, key=lambda formation: formation.key)
        for one, other in pairwise(formations):
            if one.key == other.key:
                raise InvalidValueError("key of a formation", other.text, f"another one than that of {one.text}")
        return tuple(formations)

    @cached_property
    def all_cells(self) -> tuple[Cell, ...]:
        """All cells by orientation and phase; a cell's place here is its number."""
        return tuple(cell for cells in self.cells for cell in cells)

    def number(self, cell: Cell) -> int:
        """The number of a cell."""
        return self._first_numbers[cell.orientation] + cell.position

    def tilt_deg(self, orientation: int) -> tuple[float, float]:
        """Roll and pitch of an orientation."""
        i_roll, i_pitch = divmod(orientation, len(self.tilts_deg))
        return self.tilts_deg[i_roll], self.tilts_deg[i_pitch]

    def orientation(self, roll_deg: float, pitch_deg: float) -> int:
        """The number of an orientation.

        Raises:
            InvalidValueError: roll or pitch is not one of the tilts.
        """
        for name, value in (("roll", roll_deg), ("pitch", pitch_deg)):
            if value not in self.tilts_deg:
                raise InvalidValueError(name, value, f"one of {', '.join(map(number_text, self.tilts_deg))} deg")
        return self.tilts_deg.index(roll_deg) * len(self.tilts_deg) + self.tilts_deg.index(pitch_deg)

    def at(self, roll_deg: float, pitch_deg: float, phase_deg: float) -> Cell:
        """The cell of a pose; any phase, in degrees.

        Raises:
            InvalidValueError: roll or pitch is not one of the tilts.
        """
        return self.at_phase(self.orientation(roll_deg, pitch_deg), phase_deg)

    def at_phase(self, orientation: int, phase_deg: float) -> Cell:
        """The cell of an orientation that holds a phase."""
        cells = self.cells[orientation]
        return cells[bisect_right(self._starts[orientation], phase_deg % CIRCLE_DEG) - 1]

    def after(self, cell: Cell) -> Cell:
        """The cell that follows as phase grows: the cell itself where it is the only one of its orientation."""
        cells = self.cells[cell.orientation]
        return cells[(cell.position + 1) % len(cells)]

    def neighbours(self, orientation: int) -> tuple[tuple[Move, int], ...]:
        """The tilts that lead from an orientation to those beside it in the grid, and to which."""
        return self._neighbours[orientation]

    @cached_property
    def crossings(self) -> tuple[tuple[Crossing, ...], ...]:
        """For every cell, by number, where tilts lead from it: by move, then in order of growing phase."""
        return tuple(
            tuple(
                crossing
                for move, beside in self._neighbours[cell.orientation]
                for crossing in self._crossings(cell, move, beside)
            )
            for cell in self.all_cells
        )

    def _crossings(self, cell: Cell, move: Move, beside: int) -> Iterator[Crossing]:
        starts, first = self._starts[beside], self._first_numbers[beside]
        low, end = cell.start_deg, cell.end_deg
        lap, place = 0, bisect_right(starts, low) - 1
        if place < 0:
            lap, place = -1, len(starts) - 1
        while low < end:
            target, target_lap = first + place, lap
            place += 1
            if place == len(starts):
                lap, place = lap + 1, 0
            high = min(starts[place] + CIRCLE_DEG * lap, end)
            yield Crossing(move, target, low, high, target_lap)
            low = high

    @cached_property
    def _first_numbers(self) -> list[int]:
        return [0, *accumulate(len(cells) for cells in self.cells)]

    @cached_property
    def _starts(self) -> tuple[list[float], ...]:
        return tuple([cell.start_deg for cell in cells] for cells in self.cells)

    @cached_property
    def _neighbours(self) -> tuple[tuple[tuple[Move, int], ...], ...]:
        return tuple(_neighbours(number, len(self.tilts_deg)) for number in range(len(self.cells)))


def _neighbours(orientation: int, count: int) -> tuple[tuple[Move, int], ...]:
    i_roll, i_pitch = divmod(orientation, count)
    beside = (
        (Move.ROLL_UP, i_roll + 1, i_pitch),
        (Move.ROLL_DOWN, i_roll - 1, i_pitch),
        (Move.PITCH_UP, i_roll, i_pitch + 1),
        (Move.PITCH_DOWN, i_roll, i_pitch - 1),
    )
    return tuple((move, i * count + j) for move, i, j in beside if 0 <= i < count and 0 <= j < count)


def _joined(orientation: int, cells: Sequence[Cell], formations: dict[Formation, Formation]) -> tuple[Cell, ...]:
    """The cells of an orientation, each with the start of the next one for its end and the first equal formation."""
    if [(cell.orientation, cell.position) for cell in cells] != [(orientation, i) for i in range(len(cells))]:
        raise InvalidValueError("cells", f"those of orientation {orientation}", "numbered by orientation and position")
    if not cells or not 0.0 <= cells[0].start_deg <= cells[-1].start_deg < CIRCLE_DEG:
        raise InvalidValueError("cells", f"those of orientation {orientation}", "at least one, with starts in [0, 360)")
    ends = [*(cell.start_deg for cell in cells[1:]), cells[0].start_deg + CIRCLE_DEG]
    for cell, end in zip(cells, ends, strict=True):
        if not (cell.start_deg < end and abs(cell.end_deg - end) <= ROUNDING_DEG):
            raise InvalidValueError(
                "end of a cell", cell.end_deg, f"{end!r}, where the next one begins, and after its start"
            )
    return tuple(
        replace(cell, end_deg=end, formation=formations.setdefault(cell.formation, cell.formation))
        for cell, end in zip(cells, ends, strict=True)
    )
