"""Filters and orders of the states of a library, and cursors: opaque places in such an order."""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import math
from dataclasses import dataclass

from threadstate.errors import InvalidValueError
from threadstate.library.grid import LARGEST_POSE_COUNT
from threadstate.state.model import Flag, StateClass
from threadstate.state.quantities import QUANTITIES
from threadstate.statics.stored import NAMES as STATICS
from threadstate.thread.regions import Region


@dataclass(frozen=True)
class Range:
    """From the least to the greatest value, both included; None stands for no bound."""

    least: float | None = None
    greatest: float | None = None


@dataclass(frozen=True)
class StateFilter:
    """Conditions that all hold for a state; None stands for any. Angles in degrees."""

    roll_deg: float | None = None
    pitch_deg: float | None = None
    phase_deg: float | None = None
    phase_min_deg: float | None = None
    phase_max_deg: float | None = None
    state_class: StateClass | None = None
    bolt_region: Region | None = None
    nut_region: Region | None = None
    flag: Flag | None = None
    support_margin: Range = Range()
    mu_hold: Range = Range()
    mu_wedge: Range = Range()


SORT_KEYS = (
    "roll",
    "pitch",
    "phase",
    "class",
    *(quantity.name for quantity in QUANTITIES if quantity.sortable),
    *STATICS,
)
"""What states can be sorted by; ties, and ``roll``, are in the order of roll, pitch and phase."""


@dataclass(frozen=True)
class Sort:
    """An order of states. Where a length or turn is absent the state counts as the smallest.

    ``descending`` is the exact reverse of ascending, ties included.
    """

    key: str = "roll"
    descending: bool = False

    @property
    def name(self) -> str:
        """The order as a client writes it."""
        return ("-" if self.descending else "") + self.key


SORTS = {sort.name: sort for key in SORT_KEYS for sort in (Sort(key), Sort(key, descending=True))}
"""All orders by their names."""


@dataclass(frozen=True)
class Place:
    """A state's place in an order: its value of the sort key (None where absent or not needed), and its ordinal."""

    value: float | str | None
    ordinal: int


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
