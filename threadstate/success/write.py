"""Writing a success map to the database: create its row, write its orientations, publish it."""

from __future__ import annotations

from datetime import UTC, datetime

from sqlalchemy import Connection, Engine, insert, select, update

from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.grid import Grid
from threadstate.library.success_tables import success_map, success_orientation
from threadstate.library.write import IncompleteLibraryError, next_published_at
from threadstate.success.document import document_text, map_sha256_of, orientation_document, orientation_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import inputs_document
from threadstate.success.model import OrientationMap


def open_map(engine: Engine, inputs: SuccessInputs) -> int:
    """The id of the map of these inputs; its row is created if it does not exist."""
    with engine.begin() as connection:
        take_lock(connection, WriterLock.OPEN_LIBRARY)
        known = connection.scalar(select(success_map.c.id).where(success_map.c.input_sha256 == inputs.sha256))
        if known is not None:
            return int(known)
        made = connection.execute(
            insert(success_map)
            .values(
                designation=inputs.pair.designation,
                length_unit=inputs.pair.unit.value,
                input_sha256=inputs.sha256,
                inputs=document_text(inputs_document(inputs)),
                code_version=inputs.code_version,
                created_at=datetime.now(UTC),
            )
            .returning(success_map.c.id)
        )
        return int(made.scalar_one())


def write_orientation(engine: Engine, map_id: int, found: OrientationMap) -> bool:
    """Write an orientation in one transaction; a committed one is not changed.

    Returns:
        Whether it was written.
    """
    with engine.begin() as connection:
        # The row's lock serialises the writers of one map, on databases that lock rows.
        connection.execute(select(success_map.c.id).where(success_map.c.id == map_id).with_for_update())
        there = select(success_orientation.c.orientation).where(
            success_orientation.c.map_id == map_id, success_orientation.c.orientation == found.index
        )
        if connection.execute(there).first() is not None:
            return False
        connection.execute(
            insert(success_orientation).values(
                map_id=map_id,
                orientation=found.index,
                roll_deg=found.roll_deg + 0.0,
                pitch_deg=found.pitch_deg + 0.0,
                content_sha256=orientation_sha256(found),
                document=document_text(orientation_document(found)),
            )
        )
    return True


def publish_map_in(connection: Connection, map_id: int, grid: Grid) -> str:
    """Publish a complete map in a transaction that has begun; a published one is not changed.

    Returns:
        Its content hash.

    Raises:
        IncompleteLibraryError: orientations are missing.
    """
    which = success_map.c.id == map_id
    known = connection.scalar(select(success_map.c.content_sha256).where(which).with_for_update())
    if known is not None:
        return str(known)
    rows = connection.execute(
        select(success_orientation.c.orientation, success_orientation.c.content_sha256)
        .where(success_orientation.c.map_id == map_id)
        .order_by(success_orientation.c.orientation)
    ).all()
    if [row.orientation for row in rows] != list(range(grid.orientation_count)):
        raise IncompleteLibraryError(f"success map {map_id} has {len(rows)} of {grid.orientation_count} orientations")
    content_sha256 = map_sha256_of([row.content_sha256 for row in rows])
    published_at = next_published_at(connection, success_map)
    connection.execute(
        update(success_map).where(which).values(content_sha256=content_sha256, published_at=published_at)
    )
    return content_sha256
