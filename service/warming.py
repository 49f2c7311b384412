"""What is slow the first time is done at start, in the background; a request that comes earlier waits for its part."""

from __future__ import annotations

import asyncio
import time
from itertools import count, islice

from fastapi import FastAPI
from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.cache.library_names import LibraryNames
from service.network.store import NetworkStore
from threadstate.errors import NotFoundError
from threadstate.library.named import LATEST
from threadstate.library.read import LibraryRecord
from threadstate.responses.precompute import precompute_steps

STEPS_AT_START = 3
"""Of the precompute_steps, those that solve nothing; what solves is done one by one, at leisure."""
LEISURE = 3.0
"""After each step at leisure requests have the machine to themselves for so many times as long."""


class Warming:
    """Describes the interface, and prepares the network of the latest library, if there is one.

    Attributes:
        done: whether that was done, or tried.
        done_in_full: the same of what is done at leisure, too.
    """

    def __init__(self) -> None:
        self.done = False
        self.done_in_full = False

    async def run(self, app: FastAPI, names: LibraryNames) -> None:
        """Do it, once."""
        await run_in_threadpool(app.openapi)
        library = await names.look_up(LATEST)
        if library is not None:
            for number in range(STEPS_AT_START):
                await run_in_threadpool(_prepare, app.state.engine, app.state.networks, library, number)
        self.done = True
        if library is not None:
            await _prepare_at_leisure(app, library)
        self.done_in_full = True


async def _prepare_at_leisure(app: FastAPI, library: LibraryRecord) -> None:
    await app.state.kernels.settled()
    for number in count(STEPS_AT_START):
        began = time.monotonic()
        if not await run_in_threadpool(_prepare, app.state.engine, app.state.networks, library, number):
            return
        await asyncio.sleep(LEISURE * (time.monotonic() - began))


def _prepare(engine: Engine, networks: NetworkStore, library: LibraryRecord, number: int) -> bool:
    """Do one step of the precompute_steps; whether there was one that could be done."""
    try:
        with engine.connect() as connection:
            steps = precompute_steps(connection, networks.of(connection, library))
            step = next(islice(steps, number, None), None)
            if step is not None:
                step()
    except (NotFoundError, SQLAlchemyError):
        return False
    return step is not None
