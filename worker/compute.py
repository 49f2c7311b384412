"""The computing process: solves one orientation after another, as its parent asks."""

from __future__ import annotations

import signal
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection

from threadstate.library.identity import LibraryInputs
from threadstate.stored_histories.answers import exact_answers
from threadstate.stored_histories.compute import computed_rows
from worker.messages import Chunk, Failure, Ready


def compute_chunk(inputs: LibraryInputs, index: int) -> Chunk:
    """The answers for all poses of an orientation and, by the exact method, its history, as rows."""
    return Chunk(*computed_rows(inputs, index))


def serve_chunks(connection: Connection, inputs: LibraryInputs) -> None:
    """Answer every orientation's number that arrives with its rows, until the other end is closed.

    A parent that dies, however it dies, closes its end: the process then ends by itself.
    """
    # Ctrl-C reaches the whole group; the parent alone decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(EOFError, ConnectionError):  # the parent is gone
        message = _tried(partial(_prepared, inputs))
        connection.send(message)
        while not isinstance(message, Failure):
            message = _tried(partial(compute_chunk, inputs, connection.recv()))
            connection.send(message)


def _prepared(inputs: LibraryInputs) -> Ready:
    exact_answers(inputs.pair, inputs.options, inputs.grid.poses(0)[:1])
    return Ready()


def _tried(compute: Callable[[], Ready | Chunk]) -> Ready | Chunk | Failure:
    try:
        return compute()
    except Exception as error:  # whatever it is, the parent has to learn of it
        return Failure(f"{type(error).__name__}: {error}")
