"""Which library an id in a path means."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import Depends, Path

from service.database import ReadConnection
from threadstate.errors import NotFoundError
from threadstate.library.method import Method
from threadstate.library.read import LibraryRecord, latest_library, library_by_id, published_libraries

LATEST = "latest"
LATEST_MESH = "latest-mesh"
_NUMBER = re.compile(r"[0-9]{1,18}")

LibraryId = Annotated[
    str,
    Path(
        alias="id",
        min_length=1,
        max_length=100,
        description="`latest`, by the exact method; `latest-mesh`, by meshes; a library's number; or a thread's "
        "designation, with its slash percent-encoded (`1%2F4-20%20UNC`) or as a slug (`1-4-20-unc`), for the latest "
        "library of that thread by the exact method",
        examples=[LATEST, "1", "1-4-20-unc"],
    ),
]


def slug(designation: str) -> str:
    """A designation in lower-case letters, digits and single hyphens: "1/4-20 UNC" is "1-4-20-unc"."""
    return re.sub("[^a-z0-9]+", "-", designation.lower()).strip("-")


def identified_library(connection: ReadConnection, library_id: LibraryId) -> LibraryRecord:
    """The published library that ``library_id`` means.

    Raises:
        NotFoundError: there is none; the message names those that there are.
    """
    if library_id == LATEST:
        return latest_library(connection)
    if library_id == LATEST_MESH:
        return latest_library(connection, method=Method.MESH)
    if _NUMBER.fullmatch(library_id):
        return library_by_id(connection, int(library_id))
    name = library_id.replace("%2F", "/")
    latest_first = [record for record in published_libraries(connection) if record.method is Method.EXACT]
    for record in latest_first:
        if name in (record.designation, slug(record.designation)):
            return record
    known = ", ".join(sorted({slug(record.designation) for record in latest_first})) or "none yet"
    raise NotFoundError(f"no library of {name!r} is published; threads with a library: {known}")


IdentifiedLibrary = Annotated[LibraryRecord, Depends(identified_library)]
