"""Answers GET requests below ``/v1/libraries/{id}`` from the cache or the database, and caches the application's
responses.

A response depends on the library, which does not change, on the address, and on two headers of the request. Errors and
streams pass unchanged.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import NamedTuple

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.cache.library_names import LibraryNames
from service.cache.responses import CachedResponse, ResponseCache
from service.cache.stored import StoredResponses
from service.compression import Headers, compressible, varying, zipped, zipped_etag, zipped_headers
from service.content_negotiation import header_value, names_etag, prefers_csv, takes_gzip
from service.request_scope import HEAD_REQUEST, note_route, noted_route
from threadstate.library.read import LibraryRecord

LIBRARIES = "/v1/libraries/"
NEGOTIATED = "/histories/"
"""Resources below a library with a JSON and a CSV form, chosen by the header ``Accept``."""


class _RequestHeaders(NamedTuple):
    """The request headers that a response depends on, and the API key."""

    gzip: bool
    csv: bool
    if_none_match: str
    authorization: str | None

    @classmethod
    def read(cls, headers: Headers) -> _RequestHeaders:
        return cls(
            takes_gzip(header_value(headers, b"accept-encoding")),
            prefers_csv(header_value(headers, b"accept")),
            header_value(headers, b"if-none-match"),
            header_value(headers, b"authorization") or None,
        )


class _Key(NamedTuple):
    """The cache key: all that a response depends on."""

    library: int
    path: str
    query: bytes
    csv: bool
    zipped: bool = False


class CacheMiddleware:
    """Answers from the cache or directly from the database; concurrent requests for one response compute it once.

    The state of a pose is read every time, which is as fast as a cache. Where reads need a key, ``allows`` decides by
    the header ``Authorization`` who may read (None: everybody may).
    """

    def __init__(
        self,
        app: ASGIApp,
        names: LibraryNames,
        cache: ResponseCache,
        stored: StoredResponses,
        allows: Callable[[str | None], Awaitable[bool]] | None,
        cache_control: str,
    ) -> None:
        self._app = app
        self._names = names
        self._cache = cache
        self._stored = stored
        self._allows = allows
        self._cache_control = cache_control.encode()
        self._pending: dict[_Key, asyncio.Event] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        if scope["type"] != "http" or scope["method"] != "GET" or not scope["path"].startswith(LIBRARIES):
            await self._app(scope, receive, send)
            return
        name, slash, path = scope["path"][len(LIBRARIES) :].partition("/")
        library = self._names.known(name) or await self._names.look_up(name)
        if library is None:
            await self._app(scope, receive, send)
            return
        headers = _RequestHeaders.read(scope["headers"])
        if self._allows is not None and not await self._allows(headers.authorization):
            await self._app(scope, receive, send)
            return
        key = _Key(library.id, slash + path, scope["query_string"], headers.csv)
        plain = not key.query and not key.csv
        response = await self._stored.state(library, key.path) if plain else None
        if response is not None:
            await self._reply(None, response, headers, scope, send)
            return
        response = self._cache.get(key)
        if response is None and (making := self._pending.get(key)) is not None:
            await making.wait()
            response = self._cache.get(key)
        if response is None or (response.body is None and not names_etag(headers.if_none_match, response.etag)):
            if HEAD_REQUEST in scope:
                await self._app(scope, receive, send)
                return
            response = await self._make(key, library if plain else None, scope, receive, send)
        if response is not None:
            await self._reply(key, response, headers, scope, send)

    async def _make(
        self, key: _Key, library: LibraryRecord | None, scope: Scope, receive: Receive, send: Send
    ) -> CachedResponse | None:
        """Read a response from the database or get it from the application, and cache it.

        ``library`` is None if the response cannot be read directly. Returns None if the response cannot be cached and
        was sent.
        """
        made = self._pending.setdefault(key, asyncio.Event())
        try:
            response = None if library is None else await self._stored.history(library, key.path)
            if response is None:
                capture = _Capture(key, scope, send, self._cache_control)
                # Compressed here, if at all.
                headers = [(name, value) for name, value in scope["headers"] if name != b"accept-encoding"]
                await self._app({**scope, "headers": headers}, receive, capture.send)
                response = capture.response
            if response is not None:
                self._cache.put(key, response)
            return None if response is None or response.body is None else response
        finally:
            self._pending.pop(key, None)
            made.set()

    async def _reply(
        self, key: _Key | None, response: CachedResponse, headers: _RequestHeaders, scope: Scope, send: Send
    ) -> None:
        """Send a response as the request's headers require; a compressed one is cached under ``key``, if given."""
        note_route(scope, response.route)
        etag, zipping = response.etag, headers.gzip and compressible(response.headers)
        if zipping:
            etag = zipped_etag(etag)
        if response.body is None or names_etag(headers.if_none_match, etag):
            sent = _with_etag(response.headers_of_304, etag)
            await send({"type": "http.response.start", "status": 304, "headers": sent})
            await send({"type": "http.response.body", "body": b""})
            return
        if zipping:
            response = await self._zipped(key, response, response.body)
        await send({"type": "http.response.start", "status": 200, "headers": response.headers})
        await send({"type": "http.response.body", "body": response.body})

    async def _zipped(self, key: _Key | None, response: CachedResponse, body: bytes) -> CachedResponse:
        key = None if key is None else key._replace(zipped=True)
        found = None if key is None else self._cache.get(key)
        if found is None:
            content = await zipped(body)
            etag = zipped_etag(response.etag)
            headers = _with_etag(zipped_headers(response.headers, len(content)), etag)
            found = CachedResponse(response.route, etag, headers, content)
            if key is not None:
                self._cache.put(key, found)
        return found


class _Capture:
    """Captures a response that can be cached; passes on any other."""

    def __init__(self, key: _Key, scope: Scope, send: Send, cache_control: bytes) -> None:
        self._cache_control = cache_control
        self._key = key
        self._scope = scope
        self._send = send
        self._start: Message | None = None
        self.response: CachedResponse | None = None

    async def send(self, message: Message) -> None:
        """Receive a message of the application (ASGI)."""
        if self._start is not None:
            start, self._start = self._start, None
            if message.get("more_body"):
                await self._send(start)
                await self._send(message)
                return
            self.response = self._response(varying(start["headers"]), message["body"])
        elif message["type"] == "http.response.start" and self._is_cacheable(message["headers"]):
            if message["status"] == 200 and _named(message["headers"], b"content-length"):
                self._start = message
                return
            if message["status"] == 304:
                self.response = self._response(message["headers"], None)
            await self._send(message)
        else:
            await self._send(message)

    def _response(self, headers: Headers, body: bytes | None) -> CachedResponse:
        return CachedResponse(noted_route(self._scope), _named(headers, b"etag").decode("latin-1"), headers, body)

    def _is_cacheable(self, headers: Headers) -> bool:
        """Whether a response is the same for all requests with the same key."""
        varies = {name.strip() for name in _named(headers, b"vary").lower().split(b",")}
        negotiated = {b"accept"} if self._key.path.startswith(NEGOTIATED) else set()
        return (
            _named(headers, b"etag") != b""
            and _named(headers, b"cache-control") == self._cache_control
            and varies <= {b"", b"accept-encoding"} | negotiated
        )


def _named(headers: Headers, name: bytes) -> bytes:
    return next((value for one, value in headers if one == name), b"")


def _with_etag(headers: Headers, etag: str) -> Headers:
    return [(name, etag.encode("latin-1") if name == b"etag" else value) for name, value in headers]
