"""Histories as rows of the tables, and rows read back as histories."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TypedDict

from sqlalchemy import Connection, Table, select

from threadstate.errors import SchemaError
from threadstate.history.falls import Descent, Falls, Jump, SteepestFall
from threadstate.history.labels import ContactLabels
from threadstate.history.model import Boundary, SolvedHistory
from threadstate.history.window import Course, Window
from threadstate.library import history_tables as tables
from threadstate.library.grid import Grid
from threadstate.library.rows import FormationRows, HistoryRows, Row
from threadstate.library.schema import MIGRATE_COMMAND
from threadstate.network.cells import Cell
from threadstate.network.formation import Formation
from threadstate.network.from_history import cells_of
from threadstate.state.model import ContactState, FeaturePair, Flag, StateClass, Vector
from threadstate.stored_histories.model import (
    StoredBoundary,
    StoredContactChange,
    StoredHeights,
    StoredHistories,
    StoredHistory,
    stored_changes,
)
from threadstate.thread.regions import Region

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


def stored_histories(connection: Connection, library_id: int, grid: Grid) -> StoredHistories | None:
    """The histories of a published library; None if it has none, as a library computed by meshes.

    Raises:
        SchemaError: they lack falls; the message names the command that adds them.
    """
    parts = [
        _by_orientation(connection, table, library_id, grid)
        for table in (
            tables.history_interval,
            tables.history_boundary,
            tables.history_boundary_contact,
            tables.clearance_window,
            tables.clearance_window_course,
            tables.descent,
            tables.descent_jump,
            tables.steepest_fall,
        )
    ]
    if not parts[0][0]:
        return None
    if not all(parts[-1]):
        raise SchemaError(
            f"histories of library {library_id} lack the descents that this threadstate reads: run `{MIGRATE_COMMAND}`"
        )
    known = formations(_formation_rows(connection, library_id))
    histories = tuple(
        orientation_history(index, HistoryRows((), *(part[index] for part in parts)), known)
        for index in range(grid.orientation_count)
    )
    return StoredHistories(grid.tilts_deg, histories)


def formations(rows: Iterable[FormationRows]) -> dict[str, Formation]:
    """Formations by their keys."""
    found = {}
    for one in rows:
        key, state_class = one.formation
        labels = tuple(_labels(*row[2:]) for row in one.contacts)
        found[key] = Formation(None if state_class is None else StateClass(state_class), labels)
    return found


def orientation_history(index: int, rows: HistoryRows, known: Mapping[str, Formation]) -> StoredHistory:
    """The history of the orientation with that number, from its rows."""
    changes: defaultdict[int, list[StoredContactChange]] = defaultdict(list)
    for row in rows.boundary_contacts:
        changes[row[0]].append(_change(row))
    courses: defaultdict[int, list[Course]] = defaultdict(list)
    for position, _, features, *numbers in rows.window_courses:
        courses[position].append(Course(FeaturePair(features), *numbers))
    return StoredHistory(
        cells=tuple(_cell(index, row, known) for row in rows.intervals),
        heights=tuple(StoredHeights(row[6], row[7]) for row in rows.intervals),
        boundaries=tuple(_boundary(row, tuple(changes[row[0]])) for row in rows.boundaries),
        windows=tuple(_window(row, tuple(courses[row[0]])) for row in rows.windows),
        falls=_falls(rows),
    )


def _by_orientation(connection: Connection, table: Table, library_id: int, grid: Grid) -> list[tuple[Row, ...]]:
    """The rows of every orientation in order, without ``library_id`` and ``orientation``."""
    found: list[list[Row]] = [[] for _ in range(grid.orientation_count)]
    query = select(*list(table.c)[1:]).where(table.c.library_id == library_id).order_by(*table.primary_key.columns)
    for orientation, *row in connection.execute(query):
        found[orientation].append(tuple(row))
    return [tuple(rows) for rows in found]


def _formation_rows(connection: Connection, library_id: int) -> list[FormationRows]:
    contacts: defaultdict[str, list[Row]] = defaultdict(list)
    for row in _of_library(connection, tables.formation_contact, library_id):
        contacts[row[0]].append(row)
    rows = _of_library(connection, tables.formation, library_id)
    return [FormationRows(row[0], row, tuple(contacts[row[0]])) for row in rows]


def _of_library(connection: Connection, table: Table, library_id: int) -> list[Row]:
    query = select(*list(table.c)[1:]).where(table.c.library_id == library_id).order_by(*table.primary_key.columns)
    return [tuple(row) for row in connection.execute(query)]


def _labels(stage: int, bolt_region: str, nut_region: str, features: str) -> ContactLabels:
    return ContactLabels(stage, Region(bolt_region), Region(nut_region), FeaturePair(features))


def _cell(orientation: int, row: Row, known: Mapping[str, Formation]) -> Cell:
    position, start, end, key, flags, margin, _, _, in_window = row
    return Cell(orientation, position, start, end, known[key], _flags(flags), margin, in_window)


def _flags(names: str) -> tuple[Flag, ...]:
    return tuple(Flag(name) for name in names.split())


def _boundary(row: Row, changes: tuple[StoredContactChange, ...]) -> StoredBoundary:
    _, low, high, first_before, first_after, last_before, last_after, between = row
    heights = (first_before, first_after, last_before, last_after)
    return StoredBoundary(low, high, *heights, _flags(between), changes)


def _change(row: Row) -> StoredContactChange:
    _, stage, place, *sides, moved = row
    before, normal_before = _side(stage, sides[:6])
    after, normal_after = _side(stage, sides[6:])
    return StoredContactChange(stage, place, before, normal_before, after, normal_after, moved)


def _side(stage: int, values: list[str | float | None]) -> tuple[ContactLabels, Vector] | tuple[None, None]:
    match values:
        case [str(bolt_region), str(nut_region), str(features), float(x), float(y), float(z)]:
            return _labels(stage, bolt_region, nut_region, features), (x, y, z)
    return None, None


def _window(row: Row, courses: tuple[Course, ...]) -> Window:
    _, enter, leave, enter_height, leave_height, lowest_deg, lowest_height = row
    return Window(enter, leave, enter_height, leave_height, lowest_deg, lowest_height, courses)


def _descent(row: Row, jumps: tuple[Jump, ...]) -> Descent:
    _, start, end, start_height, end_height, fall_error, undecided = row
    return Descent(start, end, start_height, end_height, fall_error, undecided, jumps)


def _falls(rows: HistoryRows) -> Falls:
    jumps: defaultdict[int, list[Jump]] = defaultdict(list)
    for position, _, *numbers in rows.descent_jumps:
        jumps[position].append(Jump(*numbers))
    ((fall, start, descent),) = rows.steepest_fall
    return Falls(
        tuple(_descent(row, tuple(jumps[row[0]])) for row in rows.descents),
        None if descent is None else SteepestFall(fall, start, descent),
    )
