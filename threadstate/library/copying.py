"""Copying a published library to another database, chunk by chunk; published there only if the content hashes are
equal.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Engine

from threadstate.errors import ThreadstateError
from threadstate.library.fingerprint import library_sha256
from threadstate.library.identity import inputs_sha256
from threadstate.library.read import LibraryRecord, library_by_id, library_by_input
from threadstate.library.stored_chunk import StoredChunk, stored_chunk
from threadstate.library.write import committed_orientations, open_copy, publish, remove_unpublished, write_chunk


class CopyError(ThreadstateError):
    """A copy differs from its source."""


@dataclass(frozen=True)
class LibraryCopy:
    """A library that is published in another database.

    Attributes:
        library_id: its id there.
        content_sha256: hash of its content.
        pose_count: number of poses, decided or not.
        was_there: whether it was published there before, so that nothing was copied.
    """

    library_id: int
    content_sha256: str
    pose_count: int
    was_there: bool


def copy_library(source: Engine, target: Engine, library_id: int) -> LibraryCopy:
    """Copy the published library of that id to another database, which is migrated.

    One chunk at a time is in memory. May be killed at any time: the next copy resumes after the committed chunks.
    The content hash is computed from the copied rows; the library is published only if it equals the source's.

    Raises:
        NotFoundError: the source has no such library.
        CopyError: what arrived is not the source's content, and is removed again; or the target has another content
            for the same inputs.
    """
    with source.connect() as connection:
        record = library_by_id(connection, library_id)
    _check_inputs(record)
    there = _published(target, record)
    if there is not None:
        return there
    copy_id = open_copy(target, record)
    committed = committed_orientations(target, copy_id)
    for index in range(record.grid.orientation_count):
        if index not in committed:
            chunk = _chunk(source, library_id, record, index)
            write_chunk(target, copy_id, chunk.rows, chunk.history)
    arrived = library_sha256(
        [_chunk(target, copy_id, record, index).content_sha256 for index in range(record.grid.orientation_count)]
    )
    if arrived != record.content_sha256:
        remove_unpublished(target, copy_id)
        raise CopyError(
            f"what arrived of library {library_id} has the content hash {arrived}, not {record.content_sha256}; "
            "it is removed again"
        )
    publish(target, copy_id, record.grid)
    made = _published(target, record)
    assert made is not None
    return LibraryCopy(made.library_id, made.content_sha256, made.pose_count, was_there=False)


def _check_inputs(record: LibraryRecord) -> None:
    found = inputs_sha256(record.pair, record.grid, record.method, record.options, record.code_version)
    if found != record.input_sha256:
        raise CopyError(f"the inputs of library {record.id} have the hash {found}, not {record.input_sha256}")


def _published(target: Engine, record: LibraryRecord) -> LibraryCopy | None:
    with target.connect() as connection:
        there = library_by_input(connection, record.input_sha256)
    if there is None:
        return None
    if there.content_sha256 != record.content_sha256:
        raise CopyError(
            f"library {there.id} there has the same inputs and the content hash {there.content_sha256}, "
            f"not {record.content_sha256}"
        )
    return LibraryCopy(there.id, there.content_sha256, there.grid.pose_count, was_there=True)


def _chunk(engine: Engine, library_id: int, record: LibraryRecord, index: int) -> StoredChunk:
    with engine.connect() as connection:
        return stored_chunk(connection, library_id, record.grid, index)
