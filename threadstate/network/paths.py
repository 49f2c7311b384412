"""Paths from a formation to the clearance window, the best by one of three objectives."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from enum import StrEnum
from heapq import heappop, heappush
from itertools import pairwise
from typing import NamedTuple

from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.moves import SNAP_SEARCH, Move, in_order

TURNING_LIMIT_DEG = 720.0


class Objective(StrEnum):
    """What makes one path better than another; the second criterion decides between equals."""

    TURNING = "turning"
    """Least turning, then fewest transitions."""
    TRANSITIONS = "transitions"
    """Fewest changes of formation, then least turning."""
    MARGIN = "margin"
    """Largest worst margin of all cells of the path, then least turning."""


@dataclass(frozen=True, slots=True)
class Step:
    """A cell, the ``move`` that enters it (None: the start), at which phase in [0, 360), and the turning until then."""

    move: Move | None
    cell: Cell
    phase_deg: float
    turning_deg: float


@dataclass(frozen=True, slots=True)
class Path:
    """Steps from a cell of the formation that was asked for to the first cell in the window."""

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
        return min(_margin(step.cell) for step in self.steps)


class _Label(NamedTuple):
    """A way to a cell, which it enters at ``phase``, between the cell's start and end.

    The way began at ``origin``; since then phase has grown to ``phase`` + ``lap`` * 360 deg. ``cost`` is the number of
    transitions or, for MARGIN, minus the worst margin.
    """

    cell: Cell
    phase: float
    lap: int
    origin: float
    cost: float
    moves: int
    move: Move | None
    parent: _Label | None

    @property
    def base(self) -> float:
        return CIRCLE_DEG * self.lap - self.origin

    @property
    def turning(self) -> float:
        return self.base + self.phase


def best_path(
    cell_map: CellMap,
    formation: Formation,
    objective: Objective = Objective.TURNING,
    moves: Collection[Move] = SNAP_SEARCH,
    *,
    orientation: int | None = None,
    phase_deg: float | None = None,
    limit_deg: float = TURNING_LIMIT_DEG,
) -> Path | None:
    """The best path to the window from any occurrence of a formation; None if no path keeps to the limit.

    The bolt turns counter-clockwise and never back; a tilt, where ``moves`` allow it, is made at any phase at which
    both cells hold, and costs no turning. Without ``phase_deg`` a path begins at the start of a cell: its turning is
    the most that is needed from anywhere in it. Without ``orientation`` all occurrences compete.

    The search is label-setting. A label is a way to a cell c: its cost (transitions, or minus the worst margin), the
    phase x at which c is entered, and b, the turning less x, so that c is left at a phase y >= x after a turning of
    b + y. Every step leaves cost and turning as they are or raises them, so that labels leave the heap in the
    objective's order, and the first one in the window is the best, unless one was dropped that had to be followed.

    A label is dropped if one that left the heap before at the same cell has no larger cost, b and x. That is safe. Let
    2 be the dropped label and 1 the other. Whatever way goes on from 2, leaving c at y >= x2 >= x1, goes on from 1
    as well: the bolt stays in c until y, which changes no formation and adds no margin. From there on the cells are
    the same; costs combine by a sum or a maximum, both of which keep the order, and the turning is less by
    b2 - b1 >= 0. So the way from 1 is at least as good in both criteria, and keeps to the limit if that from 2 does.
    Where 1 was dropped itself, the same holds for the one that it was dropped for, which left the heap earlier; this
    ends at one that was followed.

    Turning alone in place of b and x would not do: a label that enters c later in its range but a turn earlier has
    turned less, yet it misses the tilts that are possible only before. Within one turn after one start b is
    the same, and what remains of the rule is that a label has to enter c after less turning than those before it.

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
    search = _Search(cell_map, objective, tilts, limit_deg)
    for cell, phase in _starts(cell_map, formation, orientation, phase_deg):
        search.begin(cell, phase)
    last = search.run()
    return None if last is None else Path(objective, tuple(_steps(last)))


class _Search:
    """Labels by cell, and the heap of those that are still to be looked at."""

    def __init__(self, cell_map: CellMap, objective: Objective, tilts: frozenset[Move], limit_deg: float) -> None:
        self._cell_map = cell_map
        self._objective = objective
        self._tilts = tilts
        self._limit_deg = limit_deg
        self._heap: list[tuple[float, float, int, int, _Label]] = []
        self._pushed = 0
        self._settled: dict[tuple[int, int], list[tuple[float, float, float]]] = {}

    def begin(self, cell: Cell, phase: float) -> None:
        """Allow the path to begin in a cell, at a phase between its start and end."""
        cost = -_margin(cell) if self._objective is Objective.MARGIN else 0.0
        self._push(_Label(cell, phase, 0, phase, cost, 0, None, None))

    def run(self) -> _Label | None:
        """The label of the first cell in the window; None if none is within the limit."""
        while self._heap:
            label = heappop(self._heap)[-1]
            if label.cell.in_window:
                return label
            if self._dominated(label):
                continue
            self._settled.setdefault(_place(label.cell), []).append((label.cost, label.base, label.phase))
            for following in self._following(label):
                self._push(following)
        return None

    def _push(self, label: _Label) -> None:
        turning = label.turning
        if turning > self._limit_deg or self._dominated(label):
            return
        first, second = label.cost, turning
        if self._objective is Objective.TURNING:
            first, second = second, first
        heappush(self._heap, (first, second, label.moves, self._pushed, label))
        self._pushed += 1

    def _dominated(self, label: _Label) -> bool:
        base, phase, cost = label.base, label.phase, label.cost
        settled = self._settled.get(_place(label.cell), ())
        return any(c <= cost and b <= base and x <= phase for c, b, x in settled)

    def _following(self, label: _Label) -> Iterator[_Label]:
        cell, phase, lap = label.cell, label.phase, label.lap
        after = self._cell_map.after(cell)
        next_lap = lap if after.position > cell.position else lap + 1
        yield self._entered(label, Move.COUNTER_CLOCKWISE, after, after.start_deg, next_lap)
        for move, orientation in self._cell_map.neighbours(cell.orientation):
            if move not in self._tilts:
                continue
            for other, low, high, ahead in self._cell_map.overlaps(cell, orientation):
                if high > phase:
                    entry = max(max(low, phase) - CIRCLE_DEG * ahead, other.start_deg)
                    yield self._entered(label, move, other, entry, lap + ahead)

    def _entered(self, label: _Label, move: Move, cell: Cell, phase: float, lap: int) -> _Label:
        if self._objective is Objective.MARGIN:
            cost = max(label.cost, -_margin(cell))
        else:
            cost = label.cost + (cell.formation != label.cell.formation)
        return _Label(cell, phase, lap, label.origin, cost, label.moves + 1, move, label)


def _starts(
    cell_map: CellMap, formation: Formation, orientation: int | None, phase_deg: float | None
) -> list[tuple[Cell, float]]:
    """The cells in which a path may begin, each with the phase, between its start and end, at which it does."""
    occurrences = [cell for cell in cell_map if cell.formation == formation]
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
        raise InvalidValueError("formation", formation.key, "one that holds at the orientation and phase asked for")
    return starts


def _steps(last: _Label) -> list[Step]:
    steps = []
    label: _Label | None = last
    while label is not None:
        steps.append(Step(label.move, label.cell, label.phase % CIRCLE_DEG, label.turning))
        label = label.parent
    return steps[::-1]


def _place(cell: Cell) -> tuple[int, int]:
    return cell.orientation, cell.position


def _margin(cell: Cell) -> float:
    return cell.margin or 0.0
