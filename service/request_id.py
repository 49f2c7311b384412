"""The number of a request: the client's own if it is well-formed, else one that is drawn."""

from __future__ import annotations

import re
import secrets
from contextvars import ContextVar

HEADER = "X-Request-ID"
INSTANCE_PREFIX = "urn:threadstate:request:"

# Shorter than a key's secret and without the underscores of a key: none comes into the log as the number of a request.
_WELL_FORMED = re.compile(rb"[A-Za-z0-9.:-]{1,40}")

current_request_id: ContextVar[str | None] = ContextVar("request_id", default=None)
"""The number of the request that is being answered."""


def request_id(asked: bytes | None) -> str:
    """The number that a request has asked for, or a new one."""
    if asked is not None and _WELL_FORMED.fullmatch(asked):
        return asked.decode()
    return secrets.token_hex(8)
