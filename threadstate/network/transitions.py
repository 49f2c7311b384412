"""Transitions: where one formation, or one interval, gives way to another."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.changes import ChangeKind, FormationDifference, difference
from threadstate.network.formation import Formation
from threadstate.network.moves import Move


@dataclass(frozen=True, slots=True)
class Transition:
    """A move from one cell to another.

    A turn happens at one phase: ``start_deg`` = ``end_deg`` in [0, 360). A tilt can happen at any phase from
    ``start_deg`` in [0, 360) to ``end_deg``, which is above 360 where phase 0 lies between them. ``cover_deg`` is the
    phase over which, under this move, ``target`` is the next formation to come: of a tilt the whole stretch, of a
    turn what the bolt can turn before it within its formation; 0 where the formation stays.
    """

    move: Move
    source: Cell
    target: Cell
    start_deg: float
    end_deg: float
    cover_deg: float

    @property
    def formation_changes(self) -> bool:
        """Whether the two cells have different formations; else a flag changes or a height jumps."""
        return self.source.formation != self.target.formation

    @property
    def difference(self) -> FormationDifference:
        """Which contact changes and how."""
        return difference(self.source.formation, self.target.formation)


def transitions(cell_map: CellMap) -> tuple[Transition, ...]:
    """All transitions: by orientation of the source; first turns by phase, then tilts by source and move.

    Along phase every boundary between two cells is one in both senses, whether or not the formation changes. To an
    orientation beside it in the grid there is one for every stretch that two cells share and whose formations differ.
    """
    return tuple(one for number in range(cell_map.orientation_count) for one in _from_orientation(cell_map, number))


def _from_orientation(cell_map: CellMap, number: int) -> Iterator[Transition]:
    yield from _turns(cell_map.cells[number])
    for cell in cell_map.cells[number]:
        yield from _tilts(cell_map, cell)


def _turns(cells: tuple[Cell, ...]) -> Iterator[Transition]:
    if len(cells) == 1:
        return
    runs = _run_widths(cells)
    for before, after in zip(cells[-1:] + cells[:-1], cells, strict=True):
        differ = before.formation != after.formation
        phase = after.start_deg
        for move, source, target in (
            (Move.COUNTER_CLOCKWISE, before, after),
            (Move.CLOCKWISE, after, before),
        ):
            cover = runs[source.position] if differ else 0.0
            yield Transition(move, source, target, phase, phase, cover)


def _run_widths(cells: tuple[Cell, ...]) -> list[float]:
    """For every cell the phase that it and the adjacent cells of the same formation cover together."""
    count = len(cells)
    first = next((i for i in range(count) if cells[i].formation != cells[i - 1].formation), None)
    if first is None:
        return [CIRCLE_DEG] * count
    widths = [0.0] * count
    run: list[Cell] = []
    for i in range(first, first + count):
        run.append(cells[i % count])
        if cells[(i + 1) % count].formation != run[-1].formation:
            width = (run[-1].end_deg - run[0].start_deg) % CIRCLE_DEG
            for cell in run:
                widths[cell.position] = width
            run = []
    return widths


def _tilts(cell_map: CellMap, cell: Cell) -> Iterator[Transition]:
    for move, target, low, high, _ in cell_map.crossings[cell_map.number(cell)]:
        other = cell_map.all_cells[target]
        if other.formation is not cell.formation:
            shift = CIRCLE_DEG if low >= CIRCLE_DEG else 0.0
            yield Transition(move, cell, other, low - shift, high - shift, high - low)


def with_move(found: Iterable[Transition], move: Move) -> tuple[Transition, ...]:
    """Those by one move."""
    return tuple(one for one in found if one.move is move)


def changing_formation(found: Iterable[Transition]) -> tuple[Transition, ...]:
    """Those whose formations differ: the edges of the network."""
    return tuple(one for one in found if one.formation_changes)


def from_formation(found: Iterable[Transition], formation: Formation) -> tuple[Transition, ...]:
    """Those that leave a formation."""
    return tuple(one for one in found if one.source.formation == formation)


def to_formation(found: Iterable[Transition], formation: Formation) -> tuple[Transition, ...]:
    """Those that lead to a formation."""
    return tuple(one for one in found if one.target.formation == formation)


def from_orientation(found: Iterable[Transition], orientation: int) -> tuple[Transition, ...]:
    """Those that begin at one orientation."""
    return tuple(one for one in found if one.source.orientation == orientation)


def with_change(found: Iterable[Transition], kind: ChangeKind) -> tuple[Transition, ...]:
    """Those by which a class, a contact or a label of one changes."""
    return tuple(one for one in found if kind in one.difference.kinds)


def within_phases(found: Iterable[Transition], start_deg: float, end_deg: float) -> tuple[Transition, ...]:
    """Those that can happen at a phase from ``start_deg`` counter-clockwise to ``end_deg``, both included.

    The range is at most one turn: from 350 to 10 deg it holds phase 0, from 10 to 370 deg every phase.
    """
    width = min(end_deg - start_deg, CIRCLE_DEG) if end_deg >= start_deg else (end_deg - start_deg) % CIRCLE_DEG

    def meets(one: Transition) -> bool:
        ahead = (one.start_deg - start_deg) % CIRCLE_DEG
        return ahead <= width or ahead + (one.end_deg - one.start_deg) >= CIRCLE_DEG

    return tuple(one for one in found if meets(one))
