"""Histories as rows of the tables; computing processes make them, without the database's modules."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict

from threadstate.history.falls import Falls
from threadstate.history.labels import ContactLabels
from threadstate.history.model import Boundary, SolvedHistory
from threadstate.history.window import Window
from threadstate.library.rows import FormationRows, HistoryRows, Row
from threadstate.network.cells import Cell
from threadstate.network.formation import Formation
from threadstate.network.from_history import cells_of
from threadstate.state.model import ContactState, Vector
from threadstate.stored_histories.model import StoredContactChange, stored_changes

_NOTHING = (None,) * 6


class FallsRows(TypedDict):
    """The rows of an orientation's falls, by their tables."""

    descents: tuple[Row, ...]
    descent_jumps: tuple[Row, ...]
    steepest_fall: tuple[Row, ...]


def history_rows(history: SolvedHistory, windows: Sequence[Window], falls: Falls) -> HistoryRows:
    """The rows of an orientation's history, of its clearance windows and of its falls."""
    # No row contains the number of the orientation.
    cells = cells_of(0, history, [(window.enter_deg, window.leave_deg) for window in windows])
    formations = sorted({cell.formation for cell in cells}, key=lambda one: one.key)
    boundaries = list(enumerate(history.boundaries))
    return HistoryRows(
        formations=tuple(_rows_of_formation(one) for one in formations),
        intervals=tuple(_interval_row(cell, one.state) for cell, one in zip(cells, history.intervals, strict=True)),
        boundaries=tuple(_boundary_row(i, one) for i, one in boundaries),
        boundary_contacts=tuple(
            _change_row(i, change)
            for i, one in boundaries
            for change in stored_changes(one.changes, one.before, one.after)
        ),
        windows=tuple(_window_row(i, one) for i, one in enumerate(windows)),
        window_courses=tuple(
            (i, place, course.features.value, course.start_deg, course.end_deg, course.start_height, course.end_height)
            for i, one in enumerate(windows)
            for place, course in enumerate(one.courses)
        ),
        **falls_rows(falls),
    )


def falls_rows(falls: Falls) -> FallsRows:
    """The rows of an orientation's falls."""
    steepest = falls.steepest
    return FallsRows(
        descents=tuple(
            (i, one.start_deg, one.end_deg, one.start_height, one.end_height, one.fall_error, one.undecided_deg)
            for i, one in enumerate(falls.descents)
        ),
        descent_jumps=tuple(
            (i, place, jump.phase_deg, jump.width_deg, jump.height_before, jump.height_after, jump.height_error)
            for i, one in enumerate(falls.descents)
            for place, jump in enumerate(one.jumps)
        ),
        steepest_fall=(
            (0.0, None, None) if steepest is None else (steepest.fall, steepest.start_deg, steepest.descent),
        ),
    )


def _rows_of_formation(one: Formation) -> FormationRows:
    contacts = tuple(
        (one.key, position, contact.stage, contact.bolt_region.value, contact.nut_region.value, contact.features.value)
        for position, contact in enumerate(one.contacts)
    )
    return FormationRows(one.key, (one.key, one.state_class and one.state_class.value), contacts)


def _interval_row(cell: Cell, state: ContactState | None) -> Row:
    flags = " ".join(cell.flags)
    labels = (cell.formation.key, flags, cell.margin)
    return cell.position, cell.start_deg, cell.end_deg, *labels, *_heights(state), cell.in_window


def _boundary_row(position: int, one: Boundary) -> Row:
    (first_before, last_before), (first_after, last_after) = _heights(one.before), _heights(one.after)
    between = sorted({flag.value for labels in one.through for flag in labels.flags})
    heights = (first_before, first_after, last_before, last_after)
    return position, one.low_deg, one.high_deg, *heights, " ".join(between)


def _heights(state: ContactState | None) -> tuple[float | None, float | None]:
    if state is None:
        return None, None
    return state.poses[0].translation[2] + 0.0, state.poses[-1].translation[2] + 0.0


def _change_row(position: int, change: StoredContactChange) -> Row:
    before = _side_columns(change.before, change.normal_before)
    after = _side_columns(change.after, change.normal_after)
    return position, change.stage, change.place, *before, *after, change.moved


def _side_columns(labels: ContactLabels | None, normal: Vector | None) -> Row:
    if labels is None or normal is None:
        return _NOTHING
    components = (component + 0.0 for component in normal)
    return labels.bolt_region.value, labels.nut_region.value, labels.features.value, *components


def _window_row(position: int, one: Window) -> Row:
    heights = (one.enter_height, one.leave_height, one.lowest_deg, one.lowest_height)
    return position, one.enter_deg, one.leave_deg, *heights
