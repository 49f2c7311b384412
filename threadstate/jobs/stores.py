"""Where the chunks of each kind of job are stored: opened, read and published alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Connection, Engine, select

from threadstate.jobs.names import JobKind
from threadstate.library.grid import Grid
from threadstate.library.settled_tables import settled_chunk
from threadstate.library.success_tables import success_orientation
from threadstate.library.tables import chunk
from threadstate.library.write import open_library, publish_in
from threadstate.settled.write import open_settled, publish_settled_in
from threadstate.success.write import open_map, publish_map_in


@dataclass(frozen=True)
class ChunkStore:
    """Where the chunks of a kind of job are stored.

    Attributes:
        open: the id of what is made of the inputs of a job; its row is created if it does not exist.
        publish: publishes it, complete, in a transaction that has begun; its content hash.
        owner: the column of the chunks with the id of what they belong to.
        orientation: the column of the chunks with the number of the orientation.
    """

    open: Callable[[Engine, Any], int]
    publish: Callable[[Connection, int, Grid], str]
    owner: ColumnElement[int]
    orientation: ColumnElement[int]

    def committed(self, connection: Connection, store_id: int) -> frozenset[int]:
        """The numbers of the committed orientations."""
        return frozenset(connection.scalars(select(self.orientation).where(self.owner == store_id)))


STORES: Mapping[JobKind, ChunkStore] = {
    JobKind.LIBRARY: ChunkStore(open_library, publish_in, chunk.c.library_id, chunk.c.orientation),
    JobKind.SETTLED: ChunkStore(
        open_settled,
        publish_settled_in,
        settled_chunk.c.library_id,
        settled_chunk.c.orientation,
    ),
    JobKind.SUCCESS: ChunkStore(
        open_map, publish_map_in, success_orientation.c.map_id, success_orientation.c.orientation
    ),
}
