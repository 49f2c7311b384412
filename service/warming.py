"""Background precomputation at start; a request that comes earlier computes what it needs itself."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import count, islice

from fastapi import FastAPI
from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from service.cache.library_names import LibraryNames
from service.network.cache import NetworkCache
from threadstate.errors import NotFoundError
from threadstate.library.named import LATEST
from threadstate.library.read import LibraryRecord
from threadstate.responses.heights import stored_heights
from threadstate.responses.library_network import LibraryNetwork

STEPS_AT_START = 3
"""The first steps of the precomputation, which solve nothing; the others run one by one, with pauses."""
PAUSE_FACTOR = 3.0
"""Each later step is followed by a pause of this many times its duration."""
TILTS_A_STEP = 50


class Warming:
    """Builds the OpenAPI document and precomputes the network of the latest library, if there is one.

    Attributes:
        done: whether the first steps have run.
        done_in_full: whether all steps have run.
    """

    def __init__(self) -> None:
        self.done = False
        self.done_in_full = False

    async def run(self, app: FastAPI, names: LibraryNames) -> None:
        """Run the precomputation, once."""
        await run_in_threadpool(app.openapi)
        library = await names.look_up(LATEST)
        if library is not None:
            for number in range(STEPS_AT_START):
                await run_in_threadpool(_run_step, app.state.engine, app.state.networks, library, number)
        self.done = True
        if library is not None:
            await _run_later_steps(app, library)
        self.done_in_full = True


async def _run_later_steps(app: FastAPI, library: LibraryRecord) -> None:
    await app.state.kernels.settled()
    for number in count(STEPS_AT_START):
        began = time.monotonic()
        if not await run_in_threadpool(_run_step, app.state.engine, app.state.networks, library, number):
            return
        await asyncio.sleep(PAUSE_FACTOR * (time.monotonic() - began))


def _run_step(engine: Engine, networks: NetworkCache, library: LibraryRecord, number: int) -> bool:
    """Run one step of the precomputation.

    Returns:
        Whether there was such a step, and it could be run.
    """
    try:
        with engine.connect() as connection:
            steps = precompute_steps(connection, networks.get(connection, library))
            step = next(islice(steps, number, None), None)
            if step is not None:
                step()
    except (NotFoundError, SQLAlchemyError):
        return False
    return step is not None


def precompute_steps(connection: Connection, network: LibraryNetwork) -> Iterator[Callable[[], object]]:
    """Steps of a few seconds at most, after which a network has cached all that it can.

    The steps come in the order in which the explorer needs their results; call them one by one, and stop at any time.
    """
    yield lambda: network.transitions
    yield lambda: network.summary
    yield lambda: network.formations
    yield lambda: network.node_link
    for number in range(network.cell_map.orientation_count):
        yield partial(stored_heights, connection, network, *network.histories.tilt_deg(number))
    yield lambda: network.dot
    yield lambda: network.graphml
    tilts = [one for one in network.transitions if not one.move.turns]
    for start in range(0, len(tilts), TILTS_A_STEP):
        yield partial(network.tilts.of, tilts[start : start + TILTS_A_STEP])
