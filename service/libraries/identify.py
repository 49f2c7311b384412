"""Which library an id in a path means."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path

from service.database import ReadConnection
from threadstate.library.named import LATEST, named_library
from threadstate.library.read import LibraryRecord

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
        NotFoundError: there is none; the message names those that there are.
    """
    return named_library(connection, library_id.replace("%2F", "/"))


IdentifiedLibrary = Annotated[LibraryRecord, Depends(identified_library)]
