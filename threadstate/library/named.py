"""The published library of a name, for the service and the command line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress

from sqlalchemy import Connection

from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.library.read import LibraryRecord, latest_library, library_by_id, published_libraries
from threadstate.library.solver_method import SolverMethod
from threadstate.thread.catalogue import pair_by_designation

LATEST = "latest"
LATEST_MESH = "latest-mesh"

_NUMBER = re.compile(r"[0-9]{1,18}")


def slug(designation: str) -> str:
    """A designation in lower-case letters, digits and single hyphens: "1/4-20 UNC" is "1-4-20-unc"."""
    return re.sub("[^a-z0-9]+", "-", designation.lower()).strip("-")


def named_library(connection: Connection, name: str) -> LibraryRecord:
    """The published library of a name.

    Args:
        connection: to the database.
        name: ``latest``, the pinned library or else the one published last by the exact method; ``latest-mesh``, the
            one published last by meshes; a library's number; a designation, as libraries have it or as people write
            that of a standard thread, or its slug, the library of that thread that is pinned or else published last by
            the exact method.

    Raises:
        NotFoundError: it does not exist; the message lists the published libraries.
    """
    if name == LATEST:
        return latest_library(connection)
    if name == LATEST_MESH:
        return latest_library(connection, method=SolverMethod.MESH)
    published = published_libraries(connection)
    if _NUMBER.fullmatch(name):
        try:
            return library_by_id(connection, int(name))
        except NotFoundError as error:
            raise NotFoundError(f"{error}; published are: {_listed(published)}") from None
    by_exact_method = [one for one in published if one.method is SolverMethod.EXACT]
    by_exact_method.sort(key=lambda one: not one.is_pinned)
    for wanted in _ways_to_write(name):
        for record in by_exact_method:
            if wanted in (record.designation, slug(record.designation)):
                return record
    raise NotFoundError(f"no library of {name!r} is published; published are: {_listed(published)}")


def _ways_to_write(name: str) -> Iterator[str]:
    """The name, and then the designation that libraries have where it is that of a known pair."""
    yield name
    with suppress(InvalidValueError):
        yield pair_by_designation(name).designation


def _listed(published: list[LibraryRecord]) -> str:
    """Ids and designations of libraries, for messages; at most ``most`` of them."""
    most = 20
    shown = [
        f"{one.id} ({slug(one.designation)}{'' if one.method is SolverMethod.EXACT else ', by meshes'})"
        for one in published
    ]
    more = [f"and {len(shown) - most} more"] if len(shown) > most else []
    return ", ".join(shown[:most] + more) or "none yet"
