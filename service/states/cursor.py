"""Cursors: a place in an order, opaque to the client, valid for the very query that it came from."""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import math

from service.states.query import Place, Sort, StateFilter
from threadstate.errors import InvalidValueError
from threadstate.library.grid import LARGEST_POSE_COUNT
from threadstate.state.model import StateClass

LONGEST_CURSOR = 256


def encode_cursor(place: Place, library_id: int, which: StateFilter, sort: Sort) -> str:
    """The cursor of the page that begins after ``place``."""
    content = json.dumps([_query_digest(library_id, which, sort), place.value, place.ordinal], separators=(",", ":"))
    return base64.urlsafe_b64encode(content.encode()).decode().rstrip("=")


def decode_cursor(cursor: str, library_id: int, which: StateFilter, sort: Sort) -> Place:
    """The place that a cursor stands for.

    Raises:
        InvalidValueError: it is not a cursor, or one of another library, filter or order.
    """
    try:
        content = json.loads(base64.b64decode(cursor + "=" * (-len(cursor) % 4), altchars=b"-_", validate=True))
    except (binascii.Error, ValueError, RecursionError):
        raise _invalid(cursor) from None
    match content:
        case [str(digest), (str() | float() | int() | None) as value, int(ordinal)] if (
            digest == _query_digest(library_id, which, sort)
            and not isinstance(value, bool)
            and not isinstance(ordinal, bool)
            and 0 <= ordinal < LARGEST_POSE_COUNT
            and _can_be_of(sort.key, value)
        ):
            return Place(value, ordinal)
    raise _invalid(cursor)


def _can_be_of(key: str, value: str | float | None) -> bool:
    if isinstance(value, str):
        return key == "class" and value in set(StateClass)
    return value is None or (key != "class" and isinstance(value, float) and math.isfinite(value))


def _query_digest(library_id: int, which: StateFilter, sort: Sort) -> str:
    return hashlib.sha256(repr((library_id, which, sort)).encode()).hexdigest()[:16]


def _invalid(cursor: str) -> InvalidValueError:
    return InvalidValueError("cursor", cursor, "a cursor from the `next` link of this very query")
