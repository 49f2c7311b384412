"""The states of an orientation as one JSON array, stored compressed beside their rows: a history is one read."""

from __future__ import annotations

from collections.abc import Iterator

from sqlalchemy import Connection, Engine, select, update

from threadstate.library.grid import Grid
from threadstate.library.read import states_between
from threadstate.library.rows import packed_states, unpacked_states
from threadstate.library.tables import chunk, library


def orientation_states_json(connection: Connection, library_id: int, grid: Grid, orientation: int) -> bytes:
    """The states of the orientation with that number as a JSON array, in order; lengths in the library's unit."""
    query = select(chunk.c.states_json).where(chunk.c.library_id == library_id, chunk.c.orientation == orientation)
    packed: bytes | None = connection.scalar(query)
    return unpacked_states(_packed_from_rows(connection, library_id, grid, orientation) if packed is None else packed)


def orientations_without_json(engine: Engine) -> list[tuple[int, int]]:
    """The numbers of libraries and orientations, in order, that an older threadstate stored without JSON."""
    query = (
        select(chunk.c.library_id, chunk.c.orientation)
        .where(chunk.c.states_json.is_(None))
        .order_by(chunk.c.library_id, chunk.c.orientation)
    )
    with engine.connect() as connection:
        return [(row.library_id, row.orientation) for row in connection.execute(query)]


def fill_states_json(engine: Engine, orientations: list[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Store the JSON of orientations that have none, each in its own transaction; yields each after it is stored."""
    for library_id, orientation in orientations:
        with engine.begin() as connection:
            head = connection.execute(select(library).where(library.c.id == library_id)).one()
            grid = Grid(head.tilt_max_deg, head.tilt_step_deg, head.phase_step_deg)
            packed = _packed_from_rows(connection, library_id, grid, orientation)
            of_chunk = (chunk.c.library_id == library_id) & (chunk.c.orientation == orientation)
            connection.execute(update(chunk).where(of_chunk).values(states_json=packed))
        yield library_id, orientation


def _packed_from_rows(connection: Connection, library_id: int, grid: Grid, orientation: int) -> bytes:
    first = grid.first_ordinal(orientation)
    return packed_states(states_between(connection, library_id, first, first + grid.phase_count - 1))
