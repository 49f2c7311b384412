"""Cross-origin resource sharing (CORS): pages of the allowed origins may read the service."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict

from service.quantities import UNIT_HEADER
from service.request_scope import HEADER

PREFLIGHT_CACHE_S = 600
"""How long a browser may cache the response to a preflight request."""


class CorsOptions(TypedDict):
    """The options of Starlette's CORSMiddleware."""

    allow_origins: Sequence[str]
    allow_methods: Sequence[str]
    allow_headers: Sequence[str]
    expose_headers: Sequence[str]
    max_age: int


def cors_options(origins: Sequence[str]) -> CorsOptions:
    """What pages of these origins may send and read; without cookies, as keys are sent in a header."""
    return {
        "allow_origins": origins,
        "allow_methods": ("GET", "HEAD", "POST", "DELETE"),
        "allow_headers": ("Authorization", "Content-Type", "If-None-Match", "Last-Event-ID", HEADER),
        "expose_headers": ("ETag", "Link", "Location", "Content-Location", UNIT_HEADER, "Retry-After", HEADER),
        "max_age": PREFLIGHT_CACHE_S,
    }
