"""Requests for the service's own state."""

from __future__ import annotations

from threadstate.client.call import Call, get, path_of
from threadstate.client.models.health import Health, Readiness


def health() -> Call[Health]:
    """Whether the process lives."""
    return get(path_of("healthz"), Health)


def readiness() -> Call[Readiness]:
    """Whether the service can answer; one that cannot is a ``ServiceUnavailableError`` at once."""
    return Call("GET", path_of("readyz"), Readiness.model_validate_json, repeatable=False)
