"""Writing a library of settled states: create its row, write its chunks, publish it."""

from __future__ import annotations

from datetime import UTC, datetime

from sqlalchemy import Connection, Engine, insert, select, update

from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.settled_tables import (
    settled_chunk,
    settled_contact,
    settled_fall,
    settled_flag,
    settled_library,
    settled_state,
)
from threadstate.library.write import IncompleteLibraryError, insert_rows, next_published_at
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.rows import SettledRows


def open_settled(engine: Engine, inputs: SettledInputs) -> int:
    """The id of the library of these inputs; its row is created if it does not exist."""
    grid = inputs.grid
    with engine.begin() as connection:
        take_lock(connection, WriterLock.OPEN_LIBRARY)
        which = settled_library.c.input_sha256 == inputs.sha256
        known = connection.scalar(select(settled_library.c.id).where(which))
        if known is not None:
            return int(known)
        made = connection.execute(
            insert(settled_library)
            .values(
                designation=inputs.pair.designation,
                length_unit=inputs.pair.unit.value,
                input_sha256=inputs.sha256,
                pair=inputs.pair_json,
                device=inputs.device_json,
                code_version=inputs.code_version,
                tilt_max_deg=grid.tilt_max_deg,
                tilt_step_deg=grid.tilt_step_deg,
                phase_step_deg=grid.phase_step_deg,
                created_at=datetime.now(UTC),
            )
            .returning(settled_library.c.id)
        )
        return int(made.scalar_one())


def committed_settled(engine: Engine, library_id: int) -> frozenset[int]:
    """The numbers of the committed chunks."""
    which = settled_chunk.c.library_id == library_id
    with engine.connect() as connection:
        return frozenset(connection.scalars(select(settled_chunk.c.orientation).where(which)))


def write_settled(engine: Engine, library_id: int, rows: SettledRows) -> bool:
    """Write a chunk in one transaction; a committed chunk is not changed.

    Returns:
        Whether it was written.
    """
    index = rows.orientation.index
    with engine.begin() as connection:
        # The row's lock serialises the writers of one library, on databases that lock rows.
        connection.execute(select(settled_library.c.id).where(settled_library.c.id == library_id).with_for_update())
        there = select(settled_chunk.c.orientation).where(
            settled_chunk.c.library_id == library_id, settled_chunk.c.orientation == index
        )
        if connection.execute(there).first() is not None:
            return False
        insert_rows(connection, settled_state, library_id, rows.states)
        insert_rows(connection, settled_contact, library_id, rows.contacts)
        insert_rows(connection, settled_fall, library_id, rows.falls)
        insert_rows(connection, settled_flag, library_id, rows.flags)
        insert_rows(connection, settled_chunk, library_id, [(index, len(rows.states), rows.content_sha256)])
    return True


def publish_settled(engine: Engine, library_id: int, grid: Grid) -> str:
    """Publish a complete library in one transaction; a published one is not changed.

    Returns:
        Its content hash.

    Raises:
        IncompleteLibraryError: chunks are missing.
    """
    with engine.begin() as connection:
        return publish_settled_in(connection, library_id, grid)


def publish_settled_in(connection: Connection, library_id: int, grid: Grid) -> str:
    """As :func:`publish_settled`, in a transaction that has begun."""
    which = settled_library.c.id == library_id
    known = connection.scalar(select(settled_library.c.content_sha256).where(which).with_for_update())
    if known is not None:
        return str(known)
    chunks = connection.execute(
        select(settled_chunk.c.orientation, settled_chunk.c.state_count, settled_chunk.c.content_sha256)
        .where(settled_chunk.c.library_id == library_id)
        .order_by(settled_chunk.c.orientation)
    ).all()
    states = sum(row.state_count for row in chunks)
    if [row.orientation for row in chunks] != list(range(grid.orientation_count)) or states != grid.pose_count:
        raise IncompleteLibraryError(
            f"library {library_id} of settled states has {len(chunks)} of {grid.orientation_count} orientations "
            f"and {states} of {grid.pose_count} poses"
        )
    content_sha256 = library_sha256([row.content_sha256 for row in chunks])
    published_at = next_published_at(connection, settled_library)
    connection.execute(
        update(settled_library).where(which).values(content_sha256=content_sha256, published_at=published_at)
    )
    return content_sha256
