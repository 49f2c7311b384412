"""Answers GETs below ``/v1/libraries/{id}`` with what is kept or rendered already, and keeps what is made.

An answer depends on the library, which does not change, on the address, and on two headers of the request. Errors and
streams go through untouched.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import NamedTuple

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.accepted import names_etag, prefers_csv, takes_gzip
from service.kept.answers import Answer, Headers, KeptAnswers
from service.kept.compression import compressible, varying, zipped, zipped_etag, zipped_headers
from service.kept.names import LibraryNames
from service.middleware import ASKED_AS_HEAD
from service.renditions.answer import rendered_history, rendered_state
from service.renditions.shelf import RenditionShelf
from service.representation import REVALIDATE, REVALIDATE_PRIVATELY
from service.route_notes import note_route, noted_route
from threadstate.library.read import LibraryRecord

LIBRARIES = "/v1/libraries/"
NEGOTIATED = "/histories/"
"""Below a library, what has a JSON and a CSV form, by the header ``Accept``."""


class _Asked(NamedTuple):
    """What a request's headers ask for, and the key they show."""

    gzip: bool
    csv: bool
    if_none_match: str
    authorization: str | None

    @classmethod
    def by(cls, headers: Headers) -> _Asked:
        gzip, csv, if_none_match, authorization = False, False, "", None
        for name, value in headers:
            if name == b"accept-encoding":
                gzip = takes_gzip(value.decode("latin-1"))
            elif name == b"accept":
                csv = prefers_csv(value.decode("latin-1"))
            elif name == b"if-none-match":
                if_none_match = value.decode("latin-1")
            elif name == b"authorization":
                authorization = value.decode("latin-1")
        return cls(gzip, csv, if_none_match, authorization)


class _Key(NamedTuple):
    """What an answer depends on."""

    library: int
    path: str
    query: bytes
    csv: bool
    zipped: bool = False


class AnswerKept:
    """Answers what is kept or rendered; what several ask for at once is made once.

    Where reading is closed, ``allows`` says by the header ``Authorization`` who may have it (None: everybody may).
    """

    def __init__(
        self,
        app: ASGIApp,
        names: LibraryNames,
        kept: KeptAnswers,
        shelf: RenditionShelf | None,
        allows: Callable[[str | None], Awaitable[bool]] | None,
    ) -> None:
        self._app = app
        self._names = names
        self._kept = kept
        self._shelf = shelf
        self._allows = allows
        self._cached = (REVALIDATE if allows is None else REVALIDATE_PRIVATELY).encode()
        self._being_made: dict[_Key, asyncio.Event] = {}

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
        asked = _Asked.by(scope["headers"])
        if self._allows is not None and not await self._allows(asked.authorization):
            await self._app(scope, receive, send)
            return
        key = _Key(library.id, slash + path, scope["query_string"], asked.csv)
        answer = self._at_hand(key, library)
        if answer is None and (making := self._being_made.get(key)) is not None:
            await making.wait()
            answer = self._kept.get(key)
        if answer is None or (answer.body is None and not names_etag(asked.if_none_match, answer.etag)):
            if ASKED_AS_HEAD in scope:
                await self._app(scope, receive, send)
                return
            answer = await self._make(key, scope, receive, send)
        if answer is not None:
            await self._reply(key, answer, asked, scope, send)

    def _at_hand(self, key: _Key, library: LibraryRecord) -> Answer | None:
        rendition = None
        if self._shelf is not None and not key.query and not key.csv:
            rendition = self._shelf.get(library)
        if rendition is not None:
            answer = rendered_state(rendition, library, key.path, self._cached)
            if answer is not None:
                return answer
        answer = self._kept.get(key)
        if answer is None and rendition is not None:
            answer = rendered_history(rendition, library, key.path, self._cached)
            if answer is not None:
                self._kept.put(key, answer)
        return answer

    async def _make(self, key: _Key, scope: Scope, receive: Receive, send: Send) -> Answer | None:
        """The answer, made and kept; None where it is of another kind and was sent already."""
        made = self._being_made.setdefault(key, asyncio.Event())
        capture = _Capture(key, scope, send, self._cached)
        try:
            # Compressed here, if at all.
            headers = [(name, value) for name, value in scope["headers"] if name != b"accept-encoding"]
            await self._app({**scope, "headers": headers}, receive, capture.send)
            answer = capture.answer
            if answer is not None:
                self._kept.put(key, answer)
            return None if answer is None or answer.body is None else answer
        finally:
            self._being_made.pop(key, None)
            made.set()

    async def _reply(self, key: _Key, answer: Answer, asked: _Asked, scope: Scope, send: Send) -> None:
        note_route(scope, answer.route)
        etag, zipping = answer.etag, asked.gzip and compressible(answer.headers)
        if zipping:
            etag = zipped_etag(etag)
        if answer.body is None or names_etag(asked.if_none_match, etag):
            headers = _with_etag(answer.headers_of_304, etag)
            await send({"type": "http.response.start", "status": 304, "headers": headers})
            await send({"type": "http.response.body", "body": b""})
            return
        if zipping:
            answer = await self._zipped(key._replace(zipped=True), answer, answer.body)
        await send({"type": "http.response.start", "status": 200, "headers": answer.headers})
        await send({"type": "http.response.body", "body": answer.body})

    async def _zipped(self, key: _Key, answer: Answer, body: bytes) -> Answer:
        found = self._kept.get(key)
        if found is None:
            content = await zipped(body)
            etag = zipped_etag(answer.etag)
            headers = _with_etag(zipped_headers(answer.headers, len(content)), etag)
            found = Answer(answer.route, etag, headers, content)
            self._kept.put(key, found)
        return found


class _Capture:
    """Holds back an answer that is to be kept, whole; sends on any other as it comes."""

    def __init__(self, key: _Key, scope: Scope, send: Send, cached: bytes) -> None:
        self._cached = cached
        self._key = key
        self._scope = scope
        self._send = send
        self._start: Message | None = None
        self.answer: Answer | None = None

    async def send(self, message: Message) -> None:
        """Take a message of the application (ASGI)."""
        if self._start is not None:
            start, self._start = self._start, None
            if message.get("more_body"):
                await self._send(start)
                await self._send(message)
                return
            self.answer = self._answer(varying(start["headers"]), message["body"])
        elif message["type"] == "http.response.start" and self._is_kept(message["headers"]):
            if message["status"] == 200 and _named(message["headers"], b"content-length"):
                self._start = message
                return
            if message["status"] == 304:
                self.answer = self._answer(message["headers"], None)
            await self._send(message)
        else:
            await self._send(message)

    def _answer(self, headers: Headers, body: bytes | None) -> Answer:
        return Answer(noted_route(self._scope), _named(headers, b"etag").decode("latin-1"), headers, body)

    def _is_kept(self, headers: Headers) -> bool:
        """Whether an answer is the same for everybody who asks with the same key."""
        varies = {name.strip() for name in _named(headers, b"vary").lower().split(b",")}
        negotiated = {b"accept"} if self._key.path.startswith(NEGOTIATED) else set()
        return (
            _named(headers, b"etag") != b""
            and _named(headers, b"cache-control") == self._cached
            and varies <= {b"", b"accept-encoding"} | negotiated
        )


def _named(headers: Headers, name: bytes) -> bytes:
    return next((value for one, value in headers if one == name), b"")


def _with_etag(headers: Headers, etag: str) -> Headers:
    return [(name, etag.encode("latin-1") if name == b"etag" else value) for name, value in headers]
