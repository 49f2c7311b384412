"""The histories and networks of libraries, read once: a published library does not change."""

from __future__ import annotations

from threading import Lock
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Connection

from service.database import ReadConnection
from service.libraries.identify import IdentifiedLibrary
from threadstate.library.read import LibraryRecord
from threadstate.responses.library_network import LibraryNetwork, library_network

MOST_LIBRARIES = 4
"""How many libraries' networks are kept; the one that was asked for longest ago goes first."""


class NetworkStore:
    """The networks of one database, by the number of their library."""

    def __init__(self) -> None:
        self._known: dict[int, LibraryNetwork] = {}
        self._lock = Lock()

    def of(self, connection: Connection, library: LibraryRecord) -> LibraryNetwork:
        """The network of a library, which is read if it is not known.

        Raises:
            NotFoundError: the library has no histories.
        """
        with self._lock:
            found = self._known.pop(library.id, None)
            if found is None:
                found = library_network(connection, library)
                while len(self._known) >= MOST_LIBRARIES:
                    del self._known[next(iter(self._known))]
            self._known[library.id] = found
        return found


def _network(request: Request, connection: ReadConnection, library: IdentifiedLibrary) -> LibraryNetwork:
    store: NetworkStore = request.app.state.networks
    return store.of(connection, library)


RequestedNetwork = Annotated[LibraryNetwork, Depends(_network)]
"""The network of the library in the path."""
