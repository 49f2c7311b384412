"""What logs and metrics say of a request: the template of its address, because the address may hold anything."""

from __future__ import annotations

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
    """What the inner layers tell the outermost one of a request."""

    route: str = UNMATCHED


def new_notes(scope: Scope) -> Notes:
    """Notes that go with a request through all layers."""
    notes = scope[_NOTES] = Notes()
    return notes


def note_route(scope: Scope, template: str) -> None:
    """Note which route answers."""
    if _NOTES in scope:
        cast("Notes", scope[_NOTES]).route = template


def noted_route(scope: Scope) -> str:
    """The route that was noted."""
    return cast("Notes", scope[_NOTES]).route if _NOTES in scope else UNMATCHED


async def note_matched_route(request: Request) -> None:
    """Note the route that was matched; the first dependency of all."""
    note_route(request.scope, request.scope["route"].path)


def method_of(scope: Scope) -> str:
    """The method of a request, if it is a usual one."""
    method = str(scope["method"])
    return method if method in _METHODS else OTHER
