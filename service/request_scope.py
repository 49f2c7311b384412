"""What middleware and routes note about a request: its id, and the template of its route for logs and metrics.

The address itself is never logged, as it may hold anything.
"""

from __future__ import annotations

import re
import secrets
from contextvars import ContextVar
from dataclasses import dataclass
from typing import cast

from fastapi import Request
from starlette.types import Scope

UNMATCHED = "unmatched"
OTHER = "other"
_METHODS = frozenset(("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"))
_NOTES = "threadstate.notes"


@dataclass
class Notes:
    """Values of a request for the outermost middleware."""

    route: str = UNMATCHED


def new_notes(scope: Scope) -> Notes:
    """Add notes to the scope of a request."""
    notes = scope[_NOTES] = Notes()
    return notes


def note_route(scope: Scope, template: str) -> None:
    """Note the template of the matched route."""
    if _NOTES in scope:
        cast("Notes", scope[_NOTES]).route = template


def noted_route(scope: Scope) -> str:
    """The recorded template."""
    return cast("Notes", scope[_NOTES]).route if _NOTES in scope else UNMATCHED


async def note_matched_route(request: Request) -> None:
    """Note the matched route; the first of all dependencies."""
    note_route(request.scope, request.scope["route"].path)


def method_of(scope: Scope) -> str:
    """The HTTP method of a request, ``other`` if it is not a standard one."""
    method = str(scope["method"])
    return method if method in _METHODS else OTHER


HEAD_REQUEST = "threadstate.head_request"
"""Key in the scope of a HEAD request that is handled as GET; endpoints that stream check it."""

ABORTED = 499
"""Logged status where no response was started, or one that nobody receives: the client has disconnected."""

HEADER = "X-Request-ID"
INSTANCE_PREFIX = "urn:threadstate:request:"

# Shorter than a key's secret and without its underscores, so that no key is logged as a request id.
_WELL_FORMED = re.compile(rb"[A-Za-z0-9.:-]{1,40}")

current_request_id: ContextVar[str | None] = ContextVar("request_id", default=None)
"""The id of the current request."""


def request_id(asked: bytes | None) -> str:
    """The id that the client sent if it is well-formed, or a new random one."""
    if asked is not None and _WELL_FORMED.fullmatch(asked):
        return asked.decode()
    return secrets.token_hex(8)
