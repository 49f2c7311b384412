"""Server-sent events."""

from __future__ import annotations

from types import MappingProxyType

from fastapi.responses import StreamingResponse

HEADERS = MappingProxyType({"Cache-Control": "no-store", "X-Accel-Buffering": "no"})
"""Proxies neither cache nor buffer the stream."""


class EventStream(StreamingResponse):
    """Server-sent events."""

    media_type = "text/event-stream"


def event_text(kind: str, data: str) -> str:
    """An event of a kind with its data, which is one line, as it is sent."""
    return f"event: {kind}\ndata: {data}\n\n"


def comment_text(comment: str) -> str:
    """A comment as it is sent: nothing for the client, but a sign that the connection is alive."""
    return f": {comment}\n\n"
