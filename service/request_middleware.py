"""Middleware of every request: id, log, metrics and security headers; HEAD as GET; encoded slashes; body limit."""

from __future__ import annotations

import time
from urllib.parse import unquote

from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.logs import AccessLine, log_access
from service.metrics import RequestMetrics
from service.request_scope import ABORTED, HEAD_REQUEST, HEADER, current_request_id, method_of, new_notes, request_id
from service.shutdown import Shutdown

CONTENT_SECURITY_POLICY = (
    "default-src 'self'; img-src 'self' data:; base-uri 'none'; object-src 'none'; frame-ancestors 'none'"
)
SECURITY_HEADERS = (
    (b"content-security-policy", CONTENT_SECURITY_POLICY.encode()),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)
_POLICY = SECURITY_HEADERS[0][0]
_REQUEST_ID = HEADER.lower().encode()


class RequestMiddleware:
    """The outermost middleware: gives each request an id, logs and counts it, and adds the security headers."""

    def __init__(self, app: ASGIApp, metrics: RequestMetrics, shutdown: Shutdown, *, logging: bool) -> None:
        self._app = app
        self._metrics = metrics
        self._shutdown = shutdown
        self._logging = logging

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        number = request_id(next((value for name, value in scope["headers"] if name == _REQUEST_ID), None))
        current_request_id.set(number)
        notes = new_notes(scope)
        began = time.perf_counter()
        status, sent = ABORTED, 0

        async def send_last(message: Message) -> None:
            nonlocal status, sent
            if message["type"] == "http.response.start":
                status = message["status"]
                message = {**message, "headers": self._with_own_headers(message["headers"], number)}
            else:
                sent += len(message.get("body", b""))
            await send(message)

        self._metrics.in_flight += 1
        try:
            await self._app(scope, receive, send_last)
        finally:
            seconds = time.perf_counter() - began
            self._metrics.in_flight -= 1
            method, route = method_of(scope), notes.route
            self._metrics.count(method, route, status, seconds)
            if self._logging:
                client = scope.get("client")
                log_access(AccessLine(method, route, status, seconds, sent, client[0] if client else ""))

    def _with_own_headers(self, headers: list[tuple[bytes, bytes]], number: str) -> list[tuple[bytes, bytes]]:
        has_policy = any(name == _POLICY for name, _ in headers)
        ours = [*headers, *SECURITY_HEADERS[has_policy:], (_REQUEST_ID, number.encode())]
        if self._shutdown.started:
            ours.append((b"connection", b"close"))
        return ours


class EncodedSlashesMiddleware:
    """Keeps a percent-encoded slash within its path segment, as ``%2F``.

    A designation may contain one ("1/4-20 UNC"), and ASGI servers decode a path before it is split.
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


class HeadAsGetMiddleware:
    """Handles HEAD as GET without the content."""

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

        await self._app({**scope, "method": "GET", HEAD_REQUEST: True}, receive, send_without_content)


class BodyLimitMiddleware:
    """Rejects a request body of more than ``largest_bytes``, whether its length is announced or not."""

    def __init__(self, app: ASGIApp, largest_bytes: int) -> None:
        self._app = app
        self._largest_bytes = largest_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        received = 0

        async def receive_within_limit() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b""))
            if received > self._largest_bytes:
                raise HTTPException(413, f"the body has more than {self._largest_bytes} bytes")
            return message

        await self._app(scope, receive_within_limit, send)
