"""Writing a library: create its row, write its chunks, publish it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import lru_cache

from sqlalchemy import Connection, Dialect, Engine, Table, delete, func, insert, select, update

from threadstate.errors import ThreadstateError
from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.history_tables import formation, formation_contact
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import LibraryRecord
from threadstate.library.rows import ChunkRows, HistoryRows, Row, content_sha256_of
from threadstate.library.solver_method import SolverMethod
from threadstate.library.tables import chunk, contact, library, metadata, stage_pose, state, state_flag, undecided
from threadstate.units import LengthUnit


class IncompleteLibraryError(ThreadstateError):
    """A library cannot be published: chunks are missing."""


@dataclass(frozen=True)
class _Head:
    """The values of a library's row when it is created."""

    designation: str
    length_unit: LengthUnit
    input_sha256: str
    pair: str
    method: SolverMethod
    options: str
    code_version: str
    grid: Grid
    created_at: datetime


def open_library(engine: Engine, inputs: LibraryInputs) -> int:
    """The id of the library of these inputs; its row is created if it does not exist."""
    return _opened(
        engine,
        _Head(
            inputs.pair.designation,
            inputs.pair.unit,
            inputs.sha256,
            inputs.pair_json,
            inputs.method,
            inputs.options_json,
            inputs.code_version,
            inputs.grid,
            datetime.now(UTC),
        ),
    )


def open_copy(engine: Engine, record: LibraryRecord) -> int:
    """The id of the library with the inputs of a published one of another database; created if it does not exist."""
    return _opened(
        engine,
        _Head(
            record.designation,
            record.length_unit,
            record.input_sha256,
            record.pair,
            record.method,
            record.options,
            record.code_version,
            record.grid,
            record.created_at,
        ),
    )


def _opened(engine: Engine, head: _Head) -> int:
    grid = head.grid
    with engine.begin() as connection:
        take_lock(connection, WriterLock.OPEN_LIBRARY)
        known = connection.scalar(select(library.c.id).where(library.c.input_sha256 == head.input_sha256))
        if known is not None:
            return int(known)
        made = connection.execute(
            insert(library)
            .values(
                designation=head.designation,
                length_unit=head.length_unit.value,
                input_sha256=head.input_sha256,
                pair=head.pair,
                method=head.method.value,
                options=head.options,
                code_version=head.code_version,
                tilt_max_deg=grid.tilt_max_deg,
                tilt_step_deg=grid.tilt_step_deg,
                phase_step_deg=grid.phase_step_deg,
                tilt_count=grid.tilt_count,
                phase_count=grid.phase_count,
                state_count=grid.pose_count,
                created_at=head.created_at,
            )
            .returning(library.c.id)
        )
        return int(made.scalar_one())


def committed_orientations(engine: Engine, library_id: int) -> frozenset[int]:
    """The numbers of the committed chunks."""
    with engine.connect() as connection:
        return frozenset(connection.scalars(select(chunk.c.orientation).where(chunk.c.library_id == library_id)))


def write_chunk(
    engine: Engine,
    library_id: int,
    rows: ChunkRows,
    history: HistoryRows | None = None,
) -> bool:
    """Write a chunk, with its history if it has one, in one transaction; a committed chunk is not changed.

    Returns:
        Whether it was written.
    """
    orientation = rows.orientation
    with engine.begin() as connection:
        # The row's lock serialises the writers of one library, on databases that lock rows.
        connection.execute(select(library.c.id).where(library.c.id == library_id).with_for_update())
        there = select(chunk.c.orientation).where(
            chunk.c.library_id == library_id, chunk.c.orientation == orientation.index
        )
        if connection.execute(there).first() is not None:
            return False
        insert_rows(connection, state, library_id, rows.states)
        insert_rows(connection, stage_pose, library_id, rows.stage_poses)
        insert_rows(connection, contact, library_id, rows.contacts)
        insert_rows(connection, state_flag, library_id, rows.flags)
        insert_rows(connection, undecided, library_id, rows.undecided)
        insert_rows(
            connection,
            chunk,
            library_id,
            [
                (
                    orientation.index,
                    orientation.roll_deg,
                    orientation.pitch_deg,
                    rows.pose_count,
                    content_sha256_of(rows, history),
                    rows.states_json,
                )
            ],
        )
        if history is not None:
            _write_history(connection, library_id, orientation.index, history)
    return True


def publish(engine: Engine, library_id: int, grid: Grid) -> str:
    """Publish a complete library in one transaction; a published one is not changed.

    Returns:
        Its content hash.

    Raises:
        IncompleteLibraryError: chunks are missing.
    """
    with engine.begin() as connection:
        return publish_in(connection, library_id, grid)


def publish_in(connection: Connection, library_id: int, grid: Grid) -> str:
    """As :func:`publish`, in a transaction that has begun."""
    known = connection.scalar(select(library.c.content_sha256).where(library.c.id == library_id).with_for_update())
    if known is not None:
        return str(known)
    chunks = connection.execute(
        select(chunk.c.orientation, chunk.c.state_count, chunk.c.content_sha256)
        .where(chunk.c.library_id == library_id)
        .order_by(chunk.c.orientation)
    ).all()
    states, left_undecided = (_count(connection, table, library_id) for table in (state, undecided))
    answers = states + left_undecided
    if [row.orientation for row in chunks] != list(range(grid.orientation_count)) or answers != grid.pose_count:
        raise IncompleteLibraryError(
            f"library {library_id} has {len(chunks)} of {grid.orientation_count} orientations and "
            f"{answers} of {grid.pose_count} poses"
        )
    content_sha256 = library_sha256([row.content_sha256 for row in chunks])
    connection.execute(
        update(library)
        .where(library.c.id == library_id)
        .values(
            content_sha256=content_sha256,
            published_at=next_published_at(connection, library),
            undecided_count=left_undecided,
        )
    )
    return content_sha256


def next_published_at(connection: Connection, table: Table) -> datetime:
    """The time at which what is published next is published.

    What was published last is the latest, even if the clock was set back.
    """
    latest = connection.scalar(select(func.max(table.c.published_at)))
    now = datetime.now(UTC)
    return now if latest is None or latest < now else latest + timedelta(microseconds=1)


def pin_library(engine: Engine, library_id: int | None) -> None:
    """Pin the library that ``latest`` means; with None unpin it.

    At most one library is pinned. The caller checks that it is published and of the exact method.
    """
    with engine.begin() as connection:
        connection.execute(update(library).where(library.c.pinned_at.is_not(None)).values(pinned_at=None))
        if library_id is not None:
            connection.execute(update(library).where(library.c.id == library_id).values(pinned_at=datetime.now(UTC)))


def remove_unpublished(engine: Engine, library_id: int) -> None:
    """Remove a library that is not published, with all its rows."""
    with engine.begin() as connection:
        connection.execute(delete(library).where(library.c.id == library_id, library.c.published_at.is_(None)))


def _write_history(connection: Connection, library_id: int, orientation: int, rows: HistoryRows) -> None:
    there = set(connection.scalars(select(formation.c.formation).where(formation.c.library_id == library_id)))
    new = [one for one in rows.formations if one.key not in there]
    insert_rows(connection, formation, library_id, [one.formation for one in new])
    insert_rows(connection, formation_contact, library_id, [row for one in new for row in one.contacts])
    for name, of_table in rows.of_orientation():
        insert_rows(connection, metadata.tables[name], library_id, [(orientation, *row) for row in of_table])


def _count(connection: Connection, table: Table, library_id: int) -> int:
    counted = select(func.count()).select_from(table).where(table.c.library_id == library_id)
    return int(connection.execute(counted).scalar_one())


def insert_rows(connection: Connection, table: Table, library_id: int, rows: Sequence[Row]) -> None:
    """Insert positional rows, each without its leading ``library_id``, directly with the driver."""
    if rows:
        statement = _insert_statement(table, connection.dialect)
        connection.exec_driver_sql(statement, [(library_id, *row) for row in rows])


@lru_cache
def _insert_statement(table: Table, dialect: Dialect) -> str:
    return str(insert(table).compile(dialect=dialect))
