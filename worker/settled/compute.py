"""Computing the settled states of an orientation, in a process that its parent controls."""

from __future__ import annotations

from functools import partial
from multiprocessing.connection import Connection

from threadstate.device.settle import settle_poses
from threadstate.settled.compute import computed_rows
from threadstate.settled.inputs import SettledInputs
from worker.compute import serve


def serve_settled(connection: Connection, inputs: SettledInputs) -> None:
    """Reply to each orientation number received with its rows, until the other end of the pipe is closed."""
    compute = partial(computed_rows, inputs.pair, inputs.grid, inputs.device)
    serve(connection, partial(_prepare, inputs), compute)


def _prepare(inputs: SettledInputs) -> None:
    settle_poses(inputs.pair, inputs.grid.poses(0)[:1], inputs.device)
