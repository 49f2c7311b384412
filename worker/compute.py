"""Computing the chunks of a library: the states of an orientation and its history, in a process that its parent
controls.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection

from threadstate.library.identity import LibraryInputs
from threadstate.stored_histories.compute import computed_rows, exact_answers
from worker.messages import Chunk, Failure, Ready


def compute_chunk(inputs: LibraryInputs, index: int) -> Chunk:
    """The answers for all poses of an orientation and, by the exact method, its history, as rows."""
    return Chunk(*computed_rows(inputs, index))


def serve_chunks(connection: Connection, inputs: LibraryInputs) -> None:
    """Reply to each orientation number received with its chunk, until the other end of the pipe is closed."""
    serve(connection, partial(_prepare, inputs), partial(compute_chunk, inputs))


def serve(connection: Connection, prepare: Callable[[], None], compute: Callable[[int], object]) -> None:
    """Reply to each number received with what is computed of it, until the other end of the pipe is closed.

    First ``prepare`` loads what is needed. A parent that dies closes its end, and the process ends.
    """
    # SIGINT reaches the whole process group; the parent alone handles it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(EOFError, ConnectionError):  # the parent has ended
        message = _tried(partial(_ready, prepare))
        connection.send(message)
        while not isinstance(message, Failure):
            message = _tried(partial(compute, connection.recv()))
            connection.send(message)


def _prepare(inputs: LibraryInputs) -> None:
    exact_answers(inputs.pair, inputs.options, inputs.grid.poses(0)[:1])


def _ready(prepare: Callable[[], None]) -> Ready:
    prepare()
    return Ready()


def _tried(compute: Callable[[], object]) -> object:
    try:
        return compute()
    except Exception as error:  # reported to the parent, whatever it is
        return Failure(f"{type(error).__name__}: {error}")
