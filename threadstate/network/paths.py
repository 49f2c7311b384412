"""Paths from a formation to the clearance window, the best by one of three objectives."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise

from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.moves import SNAP_SEARCH, Move, in_order
from threadstate.network.search import Label, Objective, Search, known_margin
from threadstate.statics.verdict import Verdict

TURNING_LIMIT_DEG = 720.0


@dataclass(frozen=True, slots=True)
class Step:
    """A cell, the ``move`` that enters it (None: the start), at which phase in [0, 360), and the turning until then."""

    move: Move | None
    cell: Cell
    phase_deg: float
    turning_deg: float


@dataclass(frozen=True, slots=True)
class Path:
    """Steps from a cell of the start formation to the first cell in the window."""

    objective: Objective
    steps: tuple[Step, ...]

    @property
    def turning_deg(self) -> float:
        """How far the bolt is turned."""
        return self.steps[-1].turning_deg

    @property
    def transitions(self) -> int:
        """How often the formation changes."""
        return sum(one.cell.formation != other.cell.formation for one, other in pairwise(self.steps))

    @property
    def worst_margin(self) -> float:
        """The smallest margin of its cells, a length; an undecided cell counts as 0."""
        return min(known_margin(step.cell) for step in self.steps)


def best_path(
    cell_map: CellMap,
    formation: Formation,
    objective: Objective = Objective.TURNING,
    moves: Collection[Move] = SNAP_SEARCH,
    *,
    orientation: int | None = None,
    phase_deg: float | None = None,
    limit_deg: float = TURNING_LIMIT_DEG,
    avoid: frozenset[Verdict] = frozenset(),
) -> Path | None:
    """The best path to the window from any occurrence of a formation; None if no path keeps to the limit.

    The bolt turns counter-clockwise and never back; a tilt, where ``moves`` allow it, is made at any phase at which
    both cells hold, and costs no turning. Without ``phase_deg`` a path begins at the start of a cell: its turning is
    the most that is needed from anywhere in it; cells in the window are no start then, unless there are no others.
    Without ``orientation`` all occurrences compete. Of cells of a load none is left whose verdict is in ``avoid``.
    Why no path is better: :class:`threadstate.network.search.Search`.

    Raises:
        InvalidValueError: moves that are empty, turn clockwise or do not turn at all; a formation that does not hold
            at the orientation and phase; a phase or limit that is not finite, a limit that is negative.
        NotFoundError: the formation does not occur.
    """
    if Move.CLOCKWISE in moves or Move.COUNTER_CLOCKWISE not in moves:
        raise InvalidValueError("moves", in_order(moves), f"{Move.COUNTER_CLOCKWISE}, and tilts beside it")
    if phase_deg is not None and not math.isfinite(phase_deg):
        raise InvalidValueError("phase", phase_deg, "a finite number of degrees")
    if not (math.isfinite(limit_deg) and limit_deg >= 0.0):
        raise InvalidValueError("limit", limit_deg, "a finite number of degrees, at least 0")
    tilts = frozenset(move for move in moves if not move.turns)
    search = Search(cell_map, objective, tilts, limit_deg, avoid)
    for cell, phase in _starts(cell_map, formation, orientation, phase_deg):
        search.begin(cell, phase)
    last = search.run()
    return None if last is None else Path(objective, tuple(_steps(cell_map, last)))


def _starts(
    cell_map: CellMap, formation: Formation, orientation: int | None, phase_deg: float | None
) -> list[tuple[Cell, float]]:
    """The cells in which a path may begin, each with the phase, between its start and end, at which it does."""
    occurrences = [cell for cell in cell_map.all_cells if cell.formation == formation]
    if not occurrences:
        raise NotFoundError(f"no formation {formation.key} among those of this network")
    if orientation is not None and not 0 <= orientation < cell_map.orientation_count:
        raise InvalidValueError("orientation", orientation, f"0 to {cell_map.orientation_count - 1}")
    starts = []
    for cell in occurrences:
        if orientation in (None, cell.orientation):
            ahead = 0.0 if phase_deg is None else (phase_deg - cell.start_deg) % CIRCLE_DEG
            if ahead < cell.width_deg:
                starts.append((cell, cell.start_deg + ahead))
    if not starts:
        raise InvalidValueError(
            "formation", formation.key, "a formation that occurs at the given orientation and phase"
        )
    outside = [(cell, phase) for cell, phase in starts if not cell.in_window]
    return outside if outside and phase_deg is None else starts


def _steps(cell_map: CellMap, last: Label) -> list[Step]:
    steps = []
    label: Label | None = last
    while label is not None:
        cell = cell_map.all_cells[label.number]
        steps.append(Step(label.move, cell, label.phase % CIRCLE_DEG, label.turning))
        label = label.parent
    return steps[::-1]
