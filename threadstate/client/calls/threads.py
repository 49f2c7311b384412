"""Requests for standard threads."""

from __future__ import annotations

from threadstate.client.call import SVG, Call, LibraryName, get, get_content, path_of
from threadstate.client.models.threads import StandardThreadList


def threads(search: str | None = None) -> Call[StandardThreadList]:
    """Standard threads with the limits of their diameters: all, or those of a designation or words that it contains."""
    return get(path_of("v1", "threads"), StandardThreadList, search=search)


def profiles_svg(
    *, designation: str | None = None, library: LibraryName | None = None, unit: str | None = None
) -> Call[bytes]:
    """The picture of both profiles with the play between them, as SVG; of a known thread or of a library's pair."""
    path = path_of("v1", "threads", "profiles.svg")
    return get_content(path, SVG, designation=designation, library=library, unit=unit)
