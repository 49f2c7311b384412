"""A line for every request that was answered."""

from __future__ import annotations

from typing import NamedTuple

import structlog

_log = structlog.get_logger()


class AccessLine(NamedTuple):
    """What is said of a request; neither its address, nor its query, nor any of its headers but its number.

    ``sent_bytes`` are those of the content.
    """

    method: str
    route: str
    status: int
    seconds: float
    sent_bytes: int
    client: str


def log_access(line: AccessLine) -> None:
    """Log a request; one that failed by our fault as an error."""
    say = _log.error if line.status == 500 else _log.info
    say(
        "request",
        method=line.method,
        route=line.route,
        status=line.status,
        duration_ms=round(1000.0 * line.seconds, 3),
        bytes=line.sent_bytes,
        client=line.client,
    )
