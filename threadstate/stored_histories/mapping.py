"""Rows of the tables read back as histories."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping

from sqlalchemy import Connection, Table, select

from threadstate.errors import SchemaError
from threadstate.history.falls import Descent, Falls, Jump, SteepestFall
from threadstate.history.labels import ContactLabels
from threadstate.history.window import Course, Window
from threadstate.library import history_tables as tables
from threadstate.library.grid import Grid
from threadstate.library.rows import FormationRows, HistoryRows, Row
from threadstate.library.schema import MIGRATE_COMMAND
from threadstate.network.cells import Cell
from threadstate.network.formation import Formation
from threadstate.state.model import FeaturePair, Flag, StateClass, Vector
from threadstate.stored_histories.model import (
    StoredBoundary,
    StoredContactChange,
    StoredHeights,
    StoredHistories,
    StoredHistory,
)
from threadstate.thread.regions import Region


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
