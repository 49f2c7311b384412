"""A cache of the histories and networks of libraries, which do not change once published."""

from __future__ import annotations

from concurrent.futures import Future
from threading import Lock
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Connection

from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from threadstate.library.read import LibraryRecord
from threadstate.responses.library_network import LibraryNetwork, library_network

MOST_LIBRARIES = 4
"""Size of the cache; the least recently used network is evicted."""


class NetworkCache:
    """The networks of one database, by library id."""

    def __init__(self) -> None:
        self._networks: dict[int, Future[LibraryNetwork]] = {}
        self._lock = Lock()

    def get(self, connection: Connection, library: LibraryRecord) -> LibraryNetwork:
        """The network of a library, read if it is not in the cache.

        Requests for the same library wait for one reading, others do not.

        Raises:
            NotFoundError: the library has no histories.
        """
        with self._lock:
            found = self._networks.pop(library.id, None)
            network: Future[LibraryNetwork] = Future() if found is None else found
            while len(self._networks) >= MOST_LIBRARIES:
                del self._networks[next(iter(self._networks))]
            self._networks[library.id] = network
        if found is None:
            try:
                network.set_result(library_network(connection, library))
            except BaseException as error:
                with self._lock:
                    if self._networks.get(library.id) is network:
                        del self._networks[library.id]
                network.set_exception(error)
        return network.result()


def _network(request: Request, connection: ReadConnection, library: IdentifiedLibrary) -> LibraryNetwork:
    cache: NetworkCache = request.app.state.networks
    return cache.get(connection, library)


RequestedNetwork = Annotated[LibraryNetwork, Depends(_network)]
"""The network of the library in the path."""
