"""The library that a path names, and the pair and options that a request solves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Path, Query, Request
from pydantic import BaseModel, Field

from service.database import ReadConnection, engine_of
from threadstate.errors import InvalidValueError
from threadstate.library.identity import options_of, pair_of
from threadstate.library.named import LATEST, named_library
from threadstate.library.read import LibraryRecord
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation, source_of
from threadstate.thread.pair import Pair
from threadstate.thread.standards.document import SourceDocument

LibraryId = Annotated[
    str,
    Path(
        alias="id",
        min_length=1,
        max_length=100,
        description="`latest`, the pinned library or else the one published last by the exact method; `latest-mesh`, "
        "the last by meshes; a library's number; or a thread's designation, with its slash percent-encoded "
        "(`1%2F4-20%20UNC`) or as a slug (`1-4-20-unc`), for the pinned or else latest library of that thread by the "
        "exact method",
        examples=[LATEST, "1", "1-4-20-unc"],
    ),
]


def identified_library(connection: ReadConnection, library_id: LibraryId) -> LibraryRecord:
    """The published library that ``library_id`` means.

    Raises:
        NotFoundError: it does not exist; the message lists the published libraries.
    """
    return named_library(connection, library_id.replace("%2F", "/"))


IdentifiedLibrary = Annotated[LibraryRecord, Depends(identified_library)]

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

    @property
    def source(self) -> str | None:
        """On what the pair's dimensions rest."""
        return source_of(self.pair)


class AnswerOfPair(BaseModel):
    """Of which pair an answer is."""

    designation: str
    source: SourceDocument
    library: int | None = Field(description="number of the library whose pair and tolerances these are")


def solved_pair(request: Request, designation: str | None, library: int | str | None) -> SolvedPair:
    """The pair of a designation (None: the default one), or that of a library with its options.

    Reads the database only if a library is given.

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
    return SolvedPair(pair_of(record.pair), options_of(record.options), record.id)


DesignationQuery = Annotated[
    str | None,
    Query(
        min_length=1,
        max_length=100,
        description=f"designation of the pair; {DEFAULT_DESIGNATION} where neither it nor a library is given",
    ),
]
LibraryQuery = Annotated[str | None, Query(min_length=1, max_length=100, description=LIBRARY_DESCRIPTION)]


def _solved_pair(request: Request, designation: DesignationQuery = None, library: LibraryQuery = None) -> SolvedPair:
    return solved_pair(request, designation, library)


RequestedPair = Annotated[SolvedPair, Depends(_solved_pair)]
"""The pair and the tolerances that the query parameters name."""
