"""The pair that is to be solved, and how: a known one by its designation, or that of a stored library."""

from __future__ import annotations

from dataclasses import dataclass

from fastapi import Request

from service.database import engine_of
from service.libraries.identify import identified_library
from threadstate.errors import InvalidValueError
from threadstate.library.stored_inputs import library_options, library_pair
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
from threadstate.thread.pair import Pair

LIBRARY_DESCRIPTION = (
    "instead of a designation: the pair and the tolerances of this library, which is named as in a path: its number, "
    "`latest`, `latest-mesh`, a designation or its slug"
)
ONE_OF_BOTH = "a designation or a library, not both"


@dataclass(frozen=True)
class SolvedPair:
    """A pair and the options with which it is solved; ``library`` is the number of the library that both are from."""

    pair: Pair
    options: SolveOptions
    library: int | None


def solved_pair(request: Request, designation: str | None, library: int | str | None) -> SolvedPair:
    """The pair of a designation (None: the default one), or that of a library with its options.

    The database is asked only where a library is named.

    Raises:
        InvalidValueError: both are given, or the designation is not known.
        NotFoundError: no such library is published.
    """
    if library is None:
        return SolvedPair(pair_by_designation(designation or DEFAULT_DESIGNATION), SolveOptions(), None)
    if designation is not None:
        raise InvalidValueError("library", library, ONE_OF_BOTH)
    with engine_of(request).connect() as connection:
        record = identified_library(connection, str(library))
    return SolvedPair(library_pair(record), library_options(record), record.id)
