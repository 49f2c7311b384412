"""What is slow the first time is done at start, in the background; a request that comes earlier waits for its part."""

from __future__ import annotations

import contextlib
from itertools import islice

from fastapi import FastAPI
from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.kept.names import LibraryNames
from service.libraries.identify import LATEST
from service.network.store import NetworkStore
from service.renditions.shelf import RenditionShelf
from threadstate.answer.prepare import preparation
from threadstate.errors import NotFoundError
from threadstate.library.read import LibraryRecord

STEPS_AT_START = 3
"""Of the preparation, those that solve nothing: the rest would take a core from the requests for a minute."""


class Warming:
    """Describes the interface, and prepares the rendition and the network of the latest library, if there is one."""

    def __init__(self) -> None:
        self.done = False

    async def run(self, app: FastAPI, names: LibraryNames, shelf: RenditionShelf | None) -> None:
        """Do it, once."""
        await run_in_threadpool(app.openapi)
        library = await names.look_up(LATEST)
        if library is not None:
            if shelf is not None:
                shelf.get(library)
            await run_in_threadpool(_read_network, app.state.engine, app.state.networks, library)
            if shelf is not None:
                await shelf.settled()
        self.done = True


def _read_network(engine: Engine, networks: NetworkStore, library: LibraryRecord) -> None:
    with contextlib.suppress(NotFoundError, SQLAlchemyError), engine.connect() as connection:
        for step in islice(preparation(connection, networks.of(connection, library)), STEPS_AT_START):
            step()
