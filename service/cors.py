"""Pages of other origins that may read the service, by an allow-list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict

from service.request_id import HEADER
from service.units import UNIT_HEADER

KEPT_FOR_S = 600
"""How long a browser may go on without asking again."""


class CorsOptions(TypedDict):
    """The options of the layer that answers for other origins."""

    allow_origins: Sequence[str]
    allow_methods: Sequence[str]
    allow_headers: Sequence[str]
    expose_headers: Sequence[str]
    max_age: int


def cors_options(origins: Sequence[str]) -> CorsOptions:
    """What pages of these origins may send and see; no cookies: keys are sent as a header."""
    return {
        "allow_origins": origins,
        "allow_methods": ("GET", "HEAD", "POST", "DELETE"),
        "allow_headers": ("Authorization", "Content-Type", "If-None-Match", "Last-Event-ID", HEADER),
        "expose_headers": ("ETag", "Link", "Location", "Content-Location", UNIT_HEADER, "Retry-After", HEADER),
        "max_age": KEPT_FOR_S,
    }
