"""Databases that grow: full libraries beside each other, how large they are and how long questions take."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence

from sqlalchemy import Connection, Engine, Table, func, insert, literal, select, text, update
from sqlalchemy.sql.elements import ColumnElement

from benchmarks.scale.computing import SEED
from benchmarks.scale.figures import Grown, Room
from benchmarks.scale.processor import Stopwatch
from threadstate.library.address import is_sqlite
from threadstate.library.history_tables import history_interval
from threadstate.library.pose import state_of_pose
from threadstate.library.read import LibraryRecord, library_by_id, states_between
from threadstate.library.tables import library, state
from threadstate.library.write import publish_in
from threadstate.tables import metadata

SIZES = (1, 3, 9)
REPEATS = 60
PUBLISHED = 5
PAGE = 100


def grown(engine: Engine, database: str) -> Iterator[Grown]:
    """The database, which has one library, with more and more copies of it under other hashes."""
    for size in SIZES:
        with engine.connect() as connection:
            there = connection.scalar(select(func.count()).select_from(library)) or 0
        for number in range(there, size):
            _double(engine, number)
        _settle(engine)
        yield _measured(engine, database, size)


def rooms(engine: Engine, database: str) -> list[Room]:
    """Where the bytes are, by table, in a database that has grown."""
    with engine.connect() as connection:
        states = _count(connection, state)
        intervals = _count(connection, history_interval)
        found = []
        for table in metadata.sorted_tables:
            if "library_id" not in table.c:
                continue
            each = intervals if "orientation" in table.c and table.name != "chunk" else states
            own, indexes = (_sqlite_bytes if is_sqlite(engine.url) else _postgresql_bytes)(connection, table)
            found.append(Room(database, table.name, _count(connection, table) / each, own / each, indexes / each))
    return found


def _double(engine: Engine, number: int) -> None:
    """One more copy of library 1: rows within the database, and no computing."""
    with engine.begin() as connection:
        first = connection.execute(select(library).where(library.c.id == 1)).mappings().one()
        made = connection.execute(
            insert(library)
            .values({name: value for name, value in first.items() if name != "id"} | {"input_sha256": f"{number:064x}"})
            .returning(library.c.id)
        ).scalar_one()
        for table in metadata.sorted_tables:
            if "library_id" in table.c:
                others = [column for column in table.c if column.name != "library_id"]
                rows: list[ColumnElement[object]] = [literal(made), *others]
                connection.execute(
                    insert(table).from_select(
                        ["library_id", *(column.name for column in others)],
                        select(*rows).where(table.c.library_id == 1),
                    )
                )


def _settle(engine: Engine) -> None:
    """What PostgreSQL does by itself after a while."""
    if not is_sqlite(engine.url):
        with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text("VACUUM ANALYZE"))


def _measured(engine: Engine, database: str, size: int) -> Grown:
    moments = random.Random(SEED)
    with engine.connect() as connection:
        records = [library_by_id(connection, one) for one in connection.scalars(select(library.c.id))]
        states = _count(connection, state)

        def pose(record: LibraryRecord) -> object:
            grid = record.grid
            roll, pitch, phase = grid.poses(moments.randrange(grid.orientation_count))[
                moments.randrange(grid.phase_count)
            ]
            return state_of_pose(connection, record.id, roll, pitch, phase)

        def page(record: LibraryRecord) -> object:
            after = moments.uniform(0.0, 0.01)
            return connection.execute(
                select(state.c.drop, state.c.ordinal)
                .where(state.c.library_id == record.id, state.c.drop > after)
                .order_by(state.c.drop, state.c.ordinal)
                .limit(PAGE)
            ).all()

        def orientation(record: LibraryRecord) -> object:
            first = record.grid.first_ordinal(moments.randrange(record.grid.orientation_count))
            return states_between(connection, record.id, first, first + record.grid.phase_count - 1)

        pose_ms, page_ms, orientation_ms = (
            _mean_ms(connection, one, records, moments) for one in (pose, page, orientation)
        )
    publish_ms = _publish_ms(engine, records[-1])
    return Grown(database, size, states, _bytes(engine), pose_ms, page_ms, orientation_ms, publish_ms)


def _mean_ms(
    connection: Connection,
    query: Callable[[LibraryRecord], object],
    records: Sequence[LibraryRecord],
    moments: random.Random,
) -> float:
    query(records[0])
    stopwatch = Stopwatch(connection)
    for _ in range(REPEATS):
        query(moments.choice(records))
    return 1e3 * stopwatch.seconds / REPEATS


def _publish_ms(engine: Engine, record: LibraryRecord) -> float:
    """Publishing a library that is whole, taken back each time."""
    hidden = update(library).where(library.c.id == record.id).values(content_sha256=None, published_at=None)
    stopwatch = Stopwatch.on(engine)
    for _ in range(PUBLISHED):
        with engine.connect() as connection, connection.begin() as transaction:
            connection.execute(hidden)
            publish_in(connection, record.id, record.grid)
            transaction.rollback()
    return 1e3 * stopwatch.seconds / PUBLISHED


def _count(connection: Connection, table: Table) -> int:
    return connection.scalar(select(func.count()).select_from(table)) or 0


def _bytes(engine: Engine) -> int:
    pages = "SELECT page_count * page_size FROM pragma_page_count(), pragma_page_size()"
    with engine.connect() as connection:
        statement = pages if is_sqlite(engine.url) else "SELECT pg_database_size(current_database())"
        return int(connection.scalar(text(statement)) or 0)


def _sqlite_bytes(connection: Connection, table: Table) -> tuple[int, int]:
    """Bytes of a table and of its indexes; the table is its own primary key's index."""
    sizes = connection.execute(
        text(
            "SELECT s.name = :table, sum(s.pgsize) FROM dbstat s JOIN sqlite_schema m ON m.name = s.name "
            "WHERE m.tbl_name = :table GROUP BY 1"
        ),
        {"table": table.name},
    ).all()
    by_kind = {bool(own): int(size) for own, size in sizes}
    return by_kind.get(True, 0), by_kind.get(False, 0)


def _postgresql_bytes(connection: Connection, table: Table) -> tuple[int, int]:
    sizes = connection.execute(
        text("SELECT pg_table_size(:table), pg_indexes_size(:table)"), {"table": table.name}
    ).one()
    return int(sizes[0]), int(sizes[1])
