"""The computing process: solves one orientation after another, as its parent asks."""

from __future__ import annotations

import signal
from multiprocessing.connection import Connection

from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import ChunkRows, chunk_rows
from threadstate.state.solve import solve_poses
from worker.messages import Failure, Ready


def compute_chunk(inputs: LibraryInputs, index: int) -> ChunkRows:
    """All states of an orientation, as rows."""
    grid = inputs.grid
    states = solve_poses(inputs.pair, grid.poses(index), inputs.options)
    return chunk_rows(grid.orientation(index), grid.first_ordinal(index), states)


def serve_chunks(connection: Connection, inputs: LibraryInputs) -> None:
    """Answer every orientation's number that arrives with its rows, until the other end is closed.

    A parent that dies, however it dies, closes its end: the process then ends by itself.
    """
    # Ctrl-C reaches the whole group; the parent alone decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        try:
            solve_poses(inputs.pair, inputs.grid.poses(0)[:1], inputs.options)
            connection.send(Ready())
            while True:
                connection.send(compute_chunk(inputs, connection.recv()))
        except (EOFError, ConnectionError):
            return
        except Exception as error:  # whatever it is, the parent has to learn of it
            connection.send(Failure(f"{type(error).__name__}: {error}"))
    except ConnectionError:
        return
