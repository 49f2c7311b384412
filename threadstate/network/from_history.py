"""Cells of the network from a history, and their margins."""

from __future__ import annotations

from collections.abc import Collection

from threadstate.history.model import CIRCLE_DEG, SolvedHistory
from threadstate.network.cells import Cell
from threadstate.network.formation import formation_of
from threadstate.state.model import ContactState, Flag, StateClass


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


def smallest_margin(state: ContactState | None) -> float | None:
    """The smallest margin of a state's class and regions, a length in the pair's unit; None where undecided."""
    if state is None:
        return None
    margins = [margin for contact in state.contacts for margin in (contact.bolt_margin, contact.nut_margin)]
    of_class = class_margin(state)
    return min(margins if of_class is None else [*margins, of_class])


def class_margin(state: ContactState) -> float | None:
    """By how much the nearest of a state's lengths may change before its class does (method, section 5).

    None where the class stands on no length: contact is a patch, or there is no third contact.
    """
    drop, embedment, pivot = state.drop_margin, state.embedment_margin, state.pivot_margin
    if Flag.FLUSH in state.flags or drop is None or embedment is None or pivot is None:
        return None
    if state.state_class is StateClass.UNSTABLE_TWO_POINT:
        return min(-drop, -embedment)
    return min(max(drop, embedment), abs(pivot))
