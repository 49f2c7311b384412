"""Where the history of an orientation comes from: a library's tables, or a computation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import Connection

from threadstate.errors import InvalidValueError
from threadstate.library.stored_inputs import library_options, library_pair
from threadstate.numbers import number_text
from threadstate.responses.library_network import LibraryNetwork, library_network
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair
from worker.output import tell
from worker.pairs.chosen import chosen_pair
from worker.stored_network import connected_library


@dataclass(frozen=True)
class OrientationSource:
    """The pair of an orientation, and what it is computed with or read from.

    Attributes:
        pair: the pair.
        options: the solver's options, where the orientation is computed.
        stored: the library that holds the orientation, and the connection to it; None: it is computed.
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
    """Where the history of an orientation (degrees) comes from.

    Args:
        database: the database; None: that of the settings.
        library: name of the library; None: none, or with ``stored`` the latest.
        pair: the pair where there is no library; see :func:`worker.pairs.chosen.chosen_pair`.
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
                tell(f"computed: {name} {number_text(value)} is not on the grid of library {record.id}")
        yield OrientationSource(library_pair(record), library_options(record), None)
