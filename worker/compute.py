"""The computing process: solves one orientation after another, as its parent asks."""

from __future__ import annotations

import signal
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection

from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.records import RecordStore
from threadstate.history.window import windows_of
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.stored_histories.mapping import history_rows
from worker.answers import exact_answers, mesh_answers
from worker.messages import Chunk, Failure, Ready


def compute_chunk(inputs: LibraryInputs, index: int) -> Chunk:
    """The answers for all poses of an orientation and, by the exact method, its history, as rows."""
    grid, pair = inputs.grid, inputs.pair
    orientation, poses = grid.orientation(index), grid.poses(index)
    first = grid.first_ordinal(index)
    if inputs.mesh is not None:
        return Chunk(chunk_rows(orientation, first, mesh_answers(pair, inputs.options, inputs.mesh, poses)), None)
    store = RecordStore(pair, inputs.options)
    answers = exact_answers(pair, inputs.options, poses, store)
    tilt = (orientation.roll_deg, orientation.pitch_deg)
    (history,) = histories_of(pair, [tilt], inputs.options, store=store)
    falls = falls_of(height_curve(pair, *tilt, inputs.options, store), pair.thread_pitch)
    return Chunk(chunk_rows(orientation, first, answers), history_rows(history, windows_of(pair, history), falls))


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
