"""Computing chunks, all that is stored of an orientation or a sampled path, in a process that its parent controls."""

from __future__ import annotations

import signal
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection

from threadstate.chances.inputs import ChancesInputs
from threadstate.library.identity import LibraryInputs
from threadstate.settled.inputs import SettledInputs
from threadstate.stored_histories.compute import computed_rows, exact_answers
from worker.messages import Chunk, ChunkInputs, Failure, LibraryChunk, Ready


def compute_library_chunk(inputs: LibraryInputs, index: int) -> LibraryChunk:
    """The contact states of an orientation and, by the exact method, its history, as rows."""
    return LibraryChunk(*computed_rows(inputs, index))


def compute_chunk(inputs: ChunkInputs, index: int) -> Chunk:
    """All that is stored of the orientation, or the sampled path, with this number."""
    if isinstance(inputs, LibraryInputs):
        return compute_library_chunk(inputs, index)
    # What a library of contact states does not need takes a second to import.
    if isinstance(inputs, SettledInputs):
        from threadstate.settled.compute import computed_rows as settled_rows

        return settled_rows(inputs.pair, inputs.grid, inputs.device, index)
    if isinstance(inputs, ChancesInputs):
        from threadstate.chances.compute import computed_record

        sampled = (inputs.uncertainty, inputs.point_limit, index)
        return computed_record(inputs.pair, inputs.device, inputs.strategy, *sampled)
    from threadstate.success.compute import computed_orientation

    return computed_orientation(
        inputs.pair,
        inputs.device,
        inputs.strategy,
        inputs.grid,
        inputs.frictions,
        inputs.phase_tolerance_deg,
        inputs.mu_tolerance,
        inputs.point_limit,
        index,
    )


def serve_chunks(connection: Connection, inputs: ChunkInputs) -> None:
    """Reply to each number received with its chunk, until the other end of the pipe is closed.

    A parent that dies closes its end, and the process ends.
    """
    # SIGINT reaches the whole process group; the parent alone handles it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(EOFError, ConnectionError):  # the parent has ended
        message = _tried(partial(_ready, inputs))
        connection.send(message)
        while not isinstance(message, Failure):
            message = _tried(partial(compute_chunk, inputs, connection.recv()))
            connection.send(message)


def _ready(inputs: ChunkInputs) -> Ready:
    if isinstance(inputs, LibraryInputs):
        exact_answers(inputs.pair, inputs.options, inputs.grid.poses(0)[:1])
    else:
        from threadstate.device.settle import settle_poses

        first = [(0.0, 0.0, 0.0)] if isinstance(inputs, ChancesInputs) else inputs.grid.poses(0)[:1]
        settle_poses(inputs.pair, first, inputs.device)
    return Ready()


def _tried(compute: Callable[[], object]) -> object:
    try:
        return compute()
    except Exception as error:  # reported to the parent, whatever it is
        return Failure(f"{type(error).__name__}: {error}")
