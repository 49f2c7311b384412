"""The search for the best way to the window over cells and the phases at which they are entered."""

from __future__ import annotations

from collections import defaultdict
from enum import StrEnum
from heapq import heappop, heappush
from typing import NamedTuple

from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.moves import Move
from threadstate.statics.verdict import Verdict


class Objective(StrEnum):
    """What makes one path better than another; the second criterion decides between equals."""

    TURNING = "turning"
    """Least turning, then fewest transitions."""
    TRANSITIONS = "transitions"
    """Fewest changes of formation, then least turning."""
    MARGIN = "margin"
    """Largest worst margin of all cells of the path, then least turning."""


class Label(NamedTuple):
    """A way to a cell, which it enters at ``phase``, between the cell's start and end.

    ``number`` is the cell's in its map. The way began at ``origin``; since then phase has grown to ``phase`` + 360 *
    ``lap`` deg, by ``steps`` moves. ``cost`` is the number of transitions or, for MARGIN, minus the worst margin.
    """

    number: int
    phase: float
    lap: int
    origin: float
    cost: float
    steps: int
    move: Move | None
    parent: Label | None

    @property
    def turning(self) -> float:
        """How far the bolt was turned."""
        return CIRCLE_DEG * self.lap - self.origin + self.phase


class Search:
    """A label-setting search, exact in both criteria of its objective. No move leaves a cell whose verdict is avoided.

    A label is a way to a cell c: its cost (transitions, or minus the worst margin), the phase x at which c is entered,
    and b, the turning less x, so that c is left at a phase y >= x after a turning of b + y. Every step leaves cost and
    turning as they are or raises them, so that labels leave the heap in the objective's order, and the first one in the
    window is the best, unless one was dropped that had to be followed.

    A label is dropped if one that leaves the heap before it at the same cell has no larger cost, b and x. That is safe.
    Let 2 be the dropped label and 1 the other. Whatever way goes on from 2, leaving c at y >= x2 >= x1, goes on from 1
    as well: the bolt stays in c until y, which changes no formation and adds no margin. From there on the cells are
    the same; costs combine by a sum or a maximum, both of which keep the order, and the turning is less by
    b2 - b1 >= 0. So the way from 1 is at least as good in both criteria, and keeps to the limit if that from 2 does.
    Where 1 is dropped itself, the same holds for the one that it is dropped for, which leaves the heap earlier still;
    this ends at one that is followed. What comes after a label in the window in the objective's order is dropped, too.

    Turning alone in place of b and x would not do: a label that enters c later in its range but a turn earlier has
    turned less, yet it misses the tilts that are possible only before. Within one turn after one start b is
    the same, and what remains of the rule is that a label has to enter c after less turning than those before it.
    """

    def __init__(
        self,
        cell_map: CellMap,
        objective: Objective,
        tilts: frozenset[Move],
        limit_deg: float,
        avoid: frozenset[Verdict] = frozenset(),
    ) -> None:
        self._cells = cell_map.all_cells
        self._cell_map = cell_map
        self._objective = objective
        self._tilts = tilts
        self._limit_deg = limit_deg
        self._avoid = avoid
        self._heap: list[tuple[float, float, int, int, Label]] = []
        self._pushed = 0
        self._best = (float("inf"), float("inf"))
        self._entered: defaultdict[int, list[tuple[float, float, float, int]]] = defaultdict(list)
        self._settled: defaultdict[int, list[tuple[float, float, float]]] = defaultdict(list)

    def begin(self, cell: Cell, phase: float) -> None:
        """Allow the path to begin in a cell, at a phase between its start and end."""
        cost = -known_margin(cell) if self._objective is Objective.MARGIN else 0.0
        self._push(self._cell_map.number(cell), phase, 0, phase, cost, 0, None, None)

    def run(self) -> Label | None:
        """The label of the first cell in the window; None if none is within the limit."""
        while self._heap:
            label = heappop(self._heap)[-1]
            number, phase, lap, origin, cost, _, _, _ = label
            if self._cells[number].in_window:
                return label
            base = CIRCLE_DEG * lap - origin
            settled = self._settled[number]
            if not any(c <= cost and b <= base and x <= phase for c, b, x in settled):
                settled.append((cost, base, phase))
                if self._cells[number].verdict not in self._avoid:
                    self._follow(label)
        return None

    def _follow(self, label: Label) -> None:
        number, phase, lap = label.number, label.phase, label.lap
        cell = self._cells[number]
        after = self._cell_map.after(cell)
        next_lap = lap if after.position > cell.position else lap + 1
        self._enter(label, Move.COUNTER_CLOCKWISE, self._cell_map.number(after), after.start_deg, next_lap)
        if self._tilts:
            for move, target, low, high, ahead in self._cell_map.crossings[number]:
                if high > phase and move in self._tilts:
                    entry = (low if low > phase else phase) - CIRCLE_DEG * ahead
                    self._enter(label, move, target, entry, lap + ahead)

    def _enter(self, label: Label, move: Move, target: int, phase: float, lap: int) -> None:
        cell = self._cells[target]
        if self._objective is Objective.MARGIN:
            cost = max(label.cost, -known_margin(cell))
        else:
            cost = label.cost + (cell.formation is not self._cells[label.number].formation)
        # A start on a lap other than that of the cell before may be rounded to just below itself.
        phase = max(phase, cell.start_deg)
        self._push(target, phase, lap, label.origin, cost, label.steps + 1, move, label)

    def _push(
        self,
        number: int,
        phase: float,
        lap: int,
        origin: float,
        cost: float,
        steps: int,
        move: Move | None,
        parent: Label | None,
    ) -> None:
        base = CIRCLE_DEG * lap - origin
        turning = base + phase
        order = (turning, cost) if self._objective is Objective.TURNING else (cost, turning)
        if turning > self._limit_deg or order > self._best:
            return
        entered = self._entered[number]
        for c, b, x, n in entered:
            if c <= cost and b <= base and x <= phase and n <= steps:
                return
        entered.append((cost, base, phase, steps))
        if self._cells[number].in_window:
            self._best = order
        label = Label(number, phase, lap, origin, cost, steps, move, parent)
        heappush(self._heap, (*order, steps, self._pushed, label))
        self._pushed += 1


def known_margin(cell: Cell) -> float:
    """The margin of a cell; 0 for an undecided one."""
    return cell.margin or 0.0
