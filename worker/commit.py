"""Committing chunks to the library or map that they belong to."""

from __future__ import annotations

from sqlalchemy import Engine

from threadstate.library.write import write_chunk
from threadstate.settled.rows import SettledRows
from threadstate.settled.write import write_settled
from threadstate.success.model import OrientationMap
from threadstate.success.write import write_orientation
from worker.messages import Chunk, LibraryChunk


def commit_chunk(engine: Engine, store_id: int, chunk: Chunk) -> bool:
    """Write a job's chunk in one transaction; a committed chunk is not changed.

    Returns:
        Whether it was written.
    """
    if isinstance(chunk, LibraryChunk):
        return write_chunk(engine, store_id, chunk.rows, chunk.history)
    if isinstance(chunk, SettledRows):
        return write_settled(engine, store_id, chunk)
    assert isinstance(chunk, OrientationMap)
    return write_orientation(engine, store_id, chunk)


def orientation_of(chunk: Chunk) -> int:
    """The number of the orientation in the grid."""
    if isinstance(chunk, LibraryChunk):
        return chunk.rows.orientation.index
    if isinstance(chunk, SettledRows):
        return chunk.orientation.index
    assert isinstance(chunk, OrientationMap)
    return chunk.index
