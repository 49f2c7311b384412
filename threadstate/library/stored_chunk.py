"""Reading a stored chunk: its rows, with the content hash computed from them."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from sqlalchemy import Connection, Table, select

from threadstate.library import history_tables as tables
from threadstate.library.grid import Grid
from threadstate.library.read import states_between, undecided_between
from threadstate.library.rows import ChunkRows, FormationRows, HistoryRows, Row, chunk_rows, content_sha256_of
from threadstate.library.statics import statics_between
from threadstate.state.model import Answer


@dataclass(frozen=True, slots=True)
class StoredChunk:
    """The rows of an orientation and the content hash of these rows; ``history`` is None if none is stored."""

    rows: ChunkRows
    history: HistoryRows | None
    content_sha256: str


def stored_chunk(connection: Connection, library_id: int, grid: Grid, index: int) -> StoredChunk:
    """The chunk of the orientation with that number, of a library that may be unpublished."""
    first = grid.first_ordinal(index)
    last = first + grid.phase_count - 1
    poses = dict(undecided_between(connection, library_id, first, last))
    decided = iter(states_between(connection, library_id, first, last))
    answers: list[Answer] = []
    for ordinal in range(first, last + 1):
        answer = poses.get(ordinal) or next(decided, None)
        if answer is not None:
            answers.append(answer)
    rows = chunk_rows(grid.orientation(index), first, answers, statics_between(connection, library_id, first, last))
    history = _history(connection, library_id, index)
    return StoredChunk(rows, history, content_sha256_of(rows, history))


def _history(connection: Connection, library_id: int, index: int) -> HistoryRows | None:
    intervals = _of_orientation(connection, tables.history_interval, library_id, index)
    if not intervals:
        return None
    column = list(tables.history_interval.c)[2:].index(tables.history_interval.c.formation)
    return HistoryRows(
        formations=_formations(connection, library_id, sorted({row[column] for row in intervals})),
        intervals=intervals,
        boundaries=_of_orientation(connection, tables.history_boundary, library_id, index),
        boundary_contacts=_of_orientation(connection, tables.history_boundary_contact, library_id, index),
        windows=_of_orientation(connection, tables.clearance_window, library_id, index),
        window_courses=_of_orientation(connection, tables.clearance_window_course, library_id, index),
        descents=_of_orientation(connection, tables.descent, library_id, index),
        descent_jumps=_of_orientation(connection, tables.descent_jump, library_id, index),
        steepest_fall=_of_orientation(connection, tables.steepest_fall, library_id, index),
    )


def _of_orientation(connection: Connection, table: Table, library_id: int, index: int) -> tuple[Row, ...]:
    """An orientation's rows in order, without ``library_id`` and ``orientation``."""
    query = (
        select(*list(table.c)[2:])
        .where(table.c.library_id == library_id, table.c.orientation == index)
        .order_by(*table.primary_key.columns)
    )
    return tuple(tuple(row) for row in connection.execute(query))


def _formations(connection: Connection, library_id: int, keys: list[str]) -> tuple[FormationRows, ...]:
    contacts: defaultdict[str, list[Row]] = defaultdict(list)
    for row in _of_keys(connection, tables.formation_contact, library_id, keys):
        contacts[row[0]].append(row)
    rows = _of_keys(connection, tables.formation, library_id, keys)
    return tuple(FormationRows(row[0], row, tuple(contacts[row[0]])) for row in rows)


def _of_keys(connection: Connection, table: Table, library_id: int, keys: list[str]) -> list[Row]:
    query = (
        select(*list(table.c)[1:])
        .where(table.c.library_id == library_id, table.c.formation.in_(keys))
        .order_by(*table.primary_key.columns)
    )
    return [tuple(row) for row in connection.execute(query)]
