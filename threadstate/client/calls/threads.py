"""Requests for standard threads."""

from __future__ import annotations

from threadstate.client.call import Call, get, path_of
from threadstate.client.models.threads import StandardThreadList


def threads(search: str | None = None) -> Call[StandardThreadList]:
    """Standard threads with the limits of their diameters: all, or those of a designation or words that it contains."""
    return get(path_of("v1", "threads"), StandardThreadList, search=search)
