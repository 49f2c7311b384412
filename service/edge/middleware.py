"""The outermost layer: one wrapper of ``send`` for all that is done to every answer."""

from __future__ import annotations

import time

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.edge.drain import Drain
from service.logs.access import AccessLine, log_access
from service.metrics.requests import RequestMetrics
from service.request_id import HEADER, current_request_id, request_id
from service.route_notes import method_of, new_notes

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
_ABORTED = 499
"""What is logged where no answer was begun, as where the client is gone."""


class Edge:
    """Numbers requests, logs and counts them, and puts the security headers on every answer."""

    def __init__(self, app: ASGIApp, metrics: RequestMetrics, drain: Drain, *, logging: bool) -> None:
        self._app = app
        self._metrics = metrics
        self._drain = drain
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
        status, sent = _ABORTED, 0

        async def send_last(message: Message) -> None:
            nonlocal status, sent
            if message["type"] == "http.response.start":
                status = message["status"]
                message = {**message, "headers": self._with_ours(message["headers"], number)}
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

    def _with_ours(self, headers: list[tuple[bytes, bytes]], number: str) -> list[tuple[bytes, bytes]]:
        has_policy = any(name == _POLICY for name, _ in headers)
        ours = [*headers, *SECURITY_HEADERS[has_policy:], (_REQUEST_ID, number.encode())]
        if self._drain.begun:
            ours.append((b"connection", b"close"))
        return ours
