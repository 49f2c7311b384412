"""What is made of a request's address and method before it is routed."""

from __future__ import annotations

from urllib.parse import unquote

from starlette.types import ASGIApp, Message, Receive, Scope, Send

ASKED_AS_HEAD = "threadstate.asked_as_head"
"""In the scope of a request that came as HEAD; an answer that has no end looks for it."""


class EncodedSlashes:
    """Keeps a slash that came percent-encoded inside its path segment, as ``%2F``.

    A thread's designation may hold one ("1/4-20 UNC"), and ASGI servers decode a path before it is split.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        raw_path: bytes = scope.get("raw_path") or b""
        if b"%2f" in raw_path.lower():
            segments = raw_path.decode("ascii", "replace").split("/")
            scope = {**scope, "path": "/".join(unquote(segment).replace("/", "%2F") for segment in segments)}
        await self._app(scope, receive, send)


class HeadAsGet:
    """Answers HEAD as GET without the content."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return

        async def send_without_content(message: Message) -> None:
            if message["type"] == "http.response.body":
                message = {**message, "body": b""}
            await send(message)

        await self._app({**scope, "method": "GET", ASKED_AS_HEAD: True}, receive, send_without_content)
