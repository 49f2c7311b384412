"""Cells under a load: cut where the verdict changes at a friction, so that moves can depend on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from itertools import count

from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.statics.verdict import Verdict

Part = tuple[float, float, Verdict]
"""Start and end of a part of a cell, in its own degrees, and the verdict there."""


class Mark(StrEnum):
    """What a load does where a transition begins."""

    FREE = "free"
    """The contacts cannot hold the load: the bolt moves."""
    HELD = "held"
    """They can: whoever moves the bolt may have to overcome friction."""
    WEDGED = "wedged"
    """They can press against each other without any load: nothing moves the bolt for certain."""
    UNDECIDED = "undecided"
    """The friction lies within the bounds of a least one, or the state is not known."""


_MARKS = {
    Verdict.MOVES: Mark.FREE,
    Verdict.CAN_STAY: Mark.HELD,
    Verdict.UNDECIDED: Mark.UNDECIDED,
    Verdict.CAN_WEDGE: Mark.WEDGED,
}
_SEVERITY = tuple(_MARKS.values())


def mark_of(verdict: Verdict) -> Mark:
    """The mark of what begins at a state."""
    return _MARKS[verdict]


def loaded_cells(cell_map: CellMap, parts: Sequence[Sequence[Sequence[Part]]]) -> CellMap:
    """The cells cut into their parts, by orientation and position; each has the verdict of its part."""
    return CellMap(
        cell_map.tilts_deg,
        tuple(
            tuple(_parts_of(cells, of_orientation)) for cells, of_orientation in zip(cell_map.cells, parts, strict=True)
        ),
    )


def _parts_of(cells: Sequence[Cell], parts: Sequence[Sequence[Part]]) -> list[Cell]:
    found = [
        replace(cell, start_deg=start, end_deg=end, verdict=verdict)
        for cell, of_cell in zip(cells, parts, strict=True)
        for start, end, verdict in of_cell
    ]
    # What phase 0 lies in is last; its parts beyond 360 deg come first.
    wrapped = [
        replace(one, start_deg=one.start_deg - CIRCLE_DEG, end_deg=one.end_deg - CIRCLE_DEG)
        for one in found
        if one.start_deg >= CIRCLE_DEG
    ]
    ordered = wrapped + [one for one in found if one.start_deg < CIRCLE_DEG]
    return [replace(one, position=position) for position, one in zip(count(), ordered)]


def transition_mark(one: Transition, parts: Sequence[Part]) -> Mark:
    """The mark of a transition, by the parts of its source; of a tilt the severest along its stretch."""
    if one.move is Move.COUNTER_CLOCKWISE:
        return mark_of(parts[-1][2])
    if one.move is Move.CLOCKWISE:
        return mark_of(parts[0][2])
    shift = CIRCLE_DEG if one.start_deg < one.source.start_deg else 0.0
    low, high = one.start_deg + shift, one.end_deg + shift
    return severest(mark_of(verdict) for start, end, verdict in parts if start < high and low < end)


def severest(marks: Iterable[Mark]) -> Mark:
    """The severest of marks: wedged, then undecided, held, free."""
    return max(marks, key=_SEVERITY.index)
