"""The computing process: solves one orientation after another, as its parent asks."""

from __future__ import annotations

import signal
from multiprocessing.connection import Connection

from threadstate.archive.answers import exact_answers
from threadstate.archive.compute import computed_rows
from threadstate.library.identity import LibraryInputs
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
    try:
        try:
            exact_answers(inputs.pair, inputs.options, inputs.grid.poses(0)[:1])
            connection.send(Ready())
            while True:
                connection.send(compute_chunk(inputs, connection.recv()))
        except (EOFError, ConnectionError):
            return
        except Exception as error:  # whatever it is, the parent has to learn of it
            connection.send(Failure(f"{type(error).__name__}: {error}"))
    except ConnectionError:
        return
