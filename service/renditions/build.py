"""``python -m service.renditions.build LIBRARY FILE``: the rendition of a library of the environment's database.

In a process of its own, because it computes for some seconds and the service answers meanwhile.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

from sqlalchemy import Connection

from service.renditions.file import write_rendition
from threadstate.library.engine import reading
from threadstate.library.read import LibraryRecord, library_by_id, states_between
from threadstate.settings import read_settings
from threadstate.state.document import StateDocument, state_document

NICENESS = 5
"""Requests come first."""


def build(database: str, library_id: int, path: Path) -> None:
    """Write the rendition of a published library.

    Raises:
        NotFoundError: there is no such library.
        OSError: the file cannot be written.
    """
    with reading(database) as engine, engine.connect() as connection:
        library = library_by_id(connection, library_id)
        write_rendition(path, _documents(connection, library), library.grid.state_count)


def _documents(connection: Connection, library: LibraryRecord) -> Iterator[StateDocument | None]:
    grid = library.grid
    for orientation in range(grid.orientation_count):
        first = grid.first_ordinal(orientation)
        states = iter(states_between(connection, library.id, first, first + grid.phase_count - 1))
        state = next(states, None)
        for phase_deg in grid.phases_deg:
            if state is None or state.phase_deg != phase_deg:
                yield None
            else:
                yield state_document(state)
                state = next(states, None)


if __name__ == "__main__":
    os.nice(NICENESS)
    build(read_settings().database, int(sys.argv[1]), Path(sys.argv[2]))
