"""Computing the map of an orientation, in a process that its parent controls."""

from __future__ import annotations

from functools import partial
from multiprocessing.connection import Connection

from threadstate.device.settle import settle_poses
from threadstate.success.compute import computed_orientation
from threadstate.success.inputs import SuccessInputs
from worker.compute import serve


def serve_success(connection: Connection, inputs: SuccessInputs) -> None:
    """Reply to each orientation number received with its map, until the other end of the pipe is closed."""
    compute = partial(
        computed_orientation,
        inputs.pair,
        inputs.device,
        inputs.strategy,
        inputs.grid,
        inputs.frictions,
        inputs.phase_tolerance_deg,
        inputs.mu_tolerance,
        inputs.point_limit,
    )
    serve(connection, partial(_prepare, inputs), compute)


def _prepare(inputs: SuccessInputs) -> None:
    settle_poses(inputs.pair, inputs.grid.poses(0)[:1], inputs.device)
