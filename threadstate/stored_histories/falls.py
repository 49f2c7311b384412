"""Adding falls to histories that an older threadstate stored without them."""

from __future__ import annotations

from collections.abc import Iterator

from sqlalchemy import Engine, insert, select, update

from threadstate.library import history_tables as tables
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import options_of, pair_of
from threadstate.library.stored_chunk import stored_chunk
from threadstate.library.tables import chunk, library


def orientations_without_falls(engine: Engine) -> list[tuple[int, int]]:
    """The library ids and orientation numbers, in order, of histories without falls."""
    interval, fall = tables.history_interval.c, tables.steepest_fall.c
    has_falls = select(fall.orientation).where(
        fall.library_id == interval.library_id, fall.orientation == interval.orientation
    )
    query = (
        select(interval.library_id, interval.orientation)
        .distinct()
        .where(~has_falls.exists())
        .order_by(interval.library_id, interval.orientation)
    )
    with engine.connect() as connection:
        return [(row.library_id, row.orientation) for row in connection.execute(query)]


def add_falls(engine: Engine, incomplete: list[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Compute and store the falls of orientations, each in its own transaction; yields each after it is stored.

    Updates the content hash of each orientation, and with a library's last orientation the hash of the library, which
    is then that of a library computed now. May be stopped at any time and called again with the remaining orientations;
    another process may do the same concurrently.
    """
    for number, (library_id, orientation) in enumerate(incomplete):
        is_last = number + 1 == len(incomplete) or incomplete[number + 1][0] != library_id
        _add_falls_of(engine, library_id, orientation, is_last=is_last)
        yield library_id, orientation


def _add_falls_of(engine: Engine, library_id: int, orientation: int, *, is_last: bool) -> None:
    # Imported late: the kernels take a second to load, and listing orientations needs none.
    from threadstate.history.descents import falls_of
    from threadstate.history.height_curve import height_curve
    from threadstate.stored_histories.rows import falls_rows

    with engine.connect() as connection:
        head = connection.execute(select(library).where(library.c.id == library_id)).one()
    grid = Grid(head.tilt_max_deg, head.tilt_step_deg, head.phase_step_deg)
    pair, tilt = pair_of(head.pair), grid.orientation(orientation)
    falls = falls_of(height_curve(pair, tilt.roll_deg, tilt.pitch_deg, options_of(head.options)), pair.thread_pitch)
    rows = falls_rows(falls)
    fall = tables.steepest_fall.c
    stored = select(fall.orientation).where(fall.library_id == library_id, fall.orientation == orientation)
    with engine.begin() as connection:
        # The row's lock serialises two processes that do this for one library, on databases that lock rows.
        connection.execute(select(library.c.id).where(library.c.id == library_id).with_for_update())
        if connection.execute(stored).first() is not None:
            return
        for table, of_table in (
            (tables.descent, rows["descents"]),
            (tables.descent_jump, rows["descent_jumps"]),
            (tables.steepest_fall, rows["steepest_fall"]),
        ):
            names = [column.name for column in table.c]
            values = [dict(zip(names, (library_id, orientation, *row), strict=True)) for row in of_table]
            if values:
                connection.execute(insert(table), values)
        content_sha256 = stored_chunk(connection, library_id, grid, orientation).content_sha256
        of_chunk = (chunk.c.library_id == library_id) & (chunk.c.orientation == orientation)
        connection.execute(update(chunk).where(of_chunk).values(content_sha256=content_sha256))
        if is_last and head.published_at is not None:
            hashes = (
                select(chunk.c.content_sha256).where(chunk.c.library_id == library_id).order_by(chunk.c.orientation)
            )
            whole = library_sha256(list(connection.scalars(hashes)))
            connection.execute(update(library).where(library.c.id == library_id).values(content_sha256=whole))
