"""Cells of the network from a history."""

from __future__ import annotations

from collections.abc import Collection

from threadstate.history.model import CIRCLE_DEG, SolvedHistory
from threadstate.network.cells import Cell
from threadstate.network.formation import formation_of
from threadstate.network.margin import smallest_margin


def cells_of(
    orientation: int, history: SolvedHistory, windows_deg: Collection[tuple[float, float]]
) -> tuple[Cell, ...]:
    """The cells of an orientation's history, one for every interval.

    ``orientation`` is its number in the grid. ``windows_deg`` are the phases at which the bolt enters and leaves its
    clearance windows, counted on from the entry.
    """
    return tuple(
        Cell(
            orientation,
            position,
            interval.start_deg,
            interval.end_deg,
            formation_of(interval.labels),
            interval.labels.flags,
            smallest_margin(interval.state),
            any((interval.middle_deg - enter) % CIRCLE_DEG < leave - enter for enter, leave in windows_deg),
        )
        for position, interval in enumerate(history.intervals)
    )
