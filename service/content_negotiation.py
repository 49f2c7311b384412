"""Content negotiation and conditional requests: what a client accepts, and which copy it has."""

from __future__ import annotations

import re
from collections.abc import Iterable

_WEIGHT = re.compile(r"0(\.[0-9]{0,3})?|1(\.0{0,3})?", re.ASCII)

_Weights = dict[str, tuple[float, int]]
"""Weight and negative position of each member of a header, by name; the preferred one is larger."""


def header_value(headers: Iterable[tuple[bytes, bytes]], name: bytes) -> str:
    """The value of a header of an ASGI scope; where it comes in several lines, all of them as one list (RFC 9110)."""
    return ", ".join(value.decode("latin-1") for one, value in headers if one == name)


def takes_gzip(accept_encoding: str) -> bool:
    """Whether the header accepts gzip, and does not prefer bytes without any coding (RFC 9110, section 12.5.3)."""
    if not accept_encoding:
        return False
    weights = _weights(accept_encoding)
    gzip, _ = _first(weights, "gzip", "x-gzip", "*")
    identity, _ = _first(weights, "identity", "*")
    return gzip > 0.0 and gzip >= identity


def prefers_csv(accept: str) -> bool:
    """Whether the header accepts text/csv and gives it more weight than JSON, or the same and names it earlier."""
    if not accept:
        return False
    weights = _weights(accept)
    csv = _first(weights, "text/csv", "text/*", "*/*")
    return csv[0] > 0.0 and csv > _first(weights, "application/json", "application/*", "*/*")


def prefers_events(accept: str) -> bool:
    """Whether the header names text/event-stream with more weight than JSON, or the same and earlier."""
    if not accept:
        return False
    weights = _weights(accept)
    events = _first(weights, "text/event-stream")
    return events[0] > 0.0 and events > _first(weights, "application/json", "application/*", "*/*")


def names_etag(if_none_match: str, etag: str) -> bool:
    """Whether the header's list names ``etag``; for this header RFC 9110 has weak tags match as well."""
    tags = (tag.strip().removeprefix("W/") for tag in if_none_match.split(","))
    return any(tag in (etag, "*") for tag in tags)


def _first(weights: _Weights, *names: str) -> tuple[float, int]:
    """The weight of the first of these names in the header, most specific first; 0 if it has none of them."""
    return next((weights[name] for name in names if name in weights), (0.0, 0))


def _weights(header: str) -> _Weights:
    """The members of a list; an invalid weight (RFC 9110, section 12.4.2) is 0."""
    weights: _Weights = {}
    for place, member in enumerate(header.lower().split(",")):
        name, *parameters = (part.strip() for part in member.split(";"))
        match [one.removeprefix("q=") for one in parameters if one.startswith("q=")]:
            case []:
                weight = 1.0
            case [text] if _WEIGHT.fullmatch(text):
                weight = float(text)
            case _:
                weight = 0.0
        weights.setdefault(name, (weight, -place))
    return weights
