"""Where commands get a library, its network, or the history of an orientation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import Connection

from threadstate.errors import InvalidValueError
from threadstate.library.engine import reading
from threadstate.library.identity import options_of, pair_of
from threadstate.library.named import LATEST, named_library
from threadstate.library.read import LibraryRecord
from threadstate.library.schema import check_schema
from threadstate.numbers import number_text
from threadstate.responses.library_network import LibraryNetwork, library_network
from threadstate.settings import read_settings
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair
from worker.output import print_status
from worker.pairs.selection import chosen_pair


@contextmanager
def connected_library(database: str | None, name: str | None) -> Iterator[tuple[Connection, LibraryRecord]]:
    """The library of a name (None: ``latest``), with the connection that it was read from.

    Raises:
        SchemaError: the database is at another revision.
        NotFoundError: no such library is published.
    """
    with reading(database or read_settings().database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            yield connection, named_library(connection, LATEST if name is None else name)


def checked_database(database: str) -> None:
    """Check that a database exists with this code's schema, before a writer opens it, which would create it.

    Raises:
        SchemaError: it does not exist or is at another revision.
    """
    with reading(database) as engine:
        check_schema(engine)


def stored_network(database: str | None, name: str | None = None) -> LibraryNetwork:
    """The histories and the network of the library of a name (None: ``latest``).

    Raises:
        SchemaError: the database is at another revision.
        NotFoundError: no such library is published, or it has no histories.
    """
    with connected_library(database, name) as (connection, record):
        return library_network(connection, record)


@dataclass(frozen=True)
class OrientationSource:
    """The pair of an orientation, and the options or the library of its history.

    Attributes:
        pair: the pair.
        options: the solver's options, if the history is computed.
        stored: the library with the orientation, and a connection to it; None if the history is computed.
    """

    pair: Pair
    options: SolveOptions
    stored: tuple[Connection, LibraryNetwork] | None


@contextmanager
def orientation_source(
    database: str | None,
    library: str | None,
    pair: str | None,
    dimensions: Sequence[str] | None,
    roll_deg: float,
    pitch_deg: float,
    *,
    stored: bool,
) -> Iterator[OrientationSource]:
    """Open the source of an orientation's history.

    Args:
        database: the database; None: that of the settings.
        library: name of the library; None: none, or with ``stored`` the latest.
        pair: the pair where there is no library; see :func:`worker.pairs.selection.chosen_pair`.
        dimensions: likewise.
        roll_deg: roll.
        pitch_deg: pitch.
        stored: only what the library's tables hold.

    Raises:
        InvalidValueError: both a library and a pair, or a pair that is not valid.
        SchemaError: the database is at another revision.
        NotFoundError: no such library is published, it has no histories, or not of this orientation if ``stored``.
    """
    if library is None and not stored:
        yield OrientationSource(chosen_pair(pair, dimensions or ()), SolveOptions(), None)
        return
    if pair is not None or dimensions:
        given = "--dimension" if pair is None else "--pair"
        raise InvalidValueError(given, pair or dimensions, "without a library, which has a pair of its own")
    with connected_library(database, library) as (connection, record):
        tilts = record.grid.tilts_deg
        if stored or (roll_deg in tilts and pitch_deg in tilts):
            network = library_network(connection, record)
            yield OrientationSource(network.pair, network.options, (connection, network))
            return
        checked_poses([(roll_deg, pitch_deg, 0.0)])
        for name, value in (("roll", roll_deg), ("pitch", pitch_deg)):
            if value not in tilts:
                print_status(f"computed: {name} {number_text(value)} is not on the grid of library {record.id}")
        yield OrientationSource(pair_of(record.pair), options_of(record.options), None)
