"""Responses compressed by gzip for clients that accept it; the compressed bytes have an ETag of their own."""

from __future__ import annotations

import gzip

from fastapi.concurrency import run_in_threadpool
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.content_negotiation import header_value, takes_gzip

Headers = list[tuple[bytes, bytes]]

LEAST_BYTES = 1024
"""Smaller responses are sent as they are."""
_AT_ONCE_BYTES = 16 * 1024
"""Larger ones are compressed in a thread, so that the event loop is not blocked."""
_LEVEL = 6
_MEDIA_TYPES = (
    "application/json",
    "application/problem+json",
    "application/graphml+xml",
    "text/csv",
    "text/vnd.graphviz",
    "model/gltf-binary",
)
_ACCEPT_ENCODING = b"Accept-Encoding"


def worth_compressing(media_type: str, size_bytes: int) -> bool:
    """Whether a response of that type and size is compressed for clients that accept it."""
    return size_bytes > LEAST_BYTES and media_type.partition(";")[0] in _MEDIA_TYPES


def zipped_etag(etag: str) -> str:
    """The ETag of the compressed bytes, given that of the uncompressed ones."""
    return etag.removesuffix('"') + '-gzip"'


def compressible(headers: Headers) -> bool:
    """Whether a response with those headers has a known length and is compressed for clients that accept it."""
    named = dict(headers)
    size, media_type = named.get(b"content-length", b"0"), named.get(b"content-type", b"")
    return b"content-encoding" not in named and worth_compressing(media_type.decode("latin-1"), int(size))


def varying(headers: Headers) -> Headers:
    """The headers with Accept-Encoding in ``Vary``."""
    varied = [value for name, value in headers if name == b"vary"]
    if any(_ACCEPT_ENCODING in value for value in varied):
        return headers
    return [
        *((name, value) for name, value in headers if name != b"vary"),
        (b"vary", b", ".join((*varied, _ACCEPT_ENCODING))),
    ]


def zipped_headers(headers: Headers, size_bytes: int) -> Headers:
    """The headers of the same response compressed to that size, except its ETag."""
    rest = [(name, value) for name, value in varying(headers) if name != b"content-length"]
    return [*rest, (b"content-length", b"%d" % size_bytes), (b"content-encoding", b"gzip")]


async def zipped(content: bytes) -> bytes:
    """The bytes compressed, the same every time."""
    if len(content) <= _AT_ONCE_BYTES:
        return _gzip(content)
    return await run_in_threadpool(_gzip, content)


def _gzip(content: bytes) -> bytes:
    return gzip.compress(content, _LEVEL, mtime=0)


class CompressionMiddleware:
    """Compresses responses of known length, which already have the ETag of the compressed bytes; streams pass
    unchanged.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        taken = takes_gzip(header_value(scope["headers"], b"accept-encoding"))
        held: Message | None = None

        async def send_zipped(message: Message) -> None:
            nonlocal held
            if held is not None and message.get("more_body"):
                await send(held)
                await send(message)
                held = None
            elif held is not None:
                content = await zipped(message["body"])
                await send({**held, "headers": zipped_headers(held["headers"], len(content))})
                await send({**message, "body": content})
                held = None
            elif message["type"] != "http.response.start" or not compressible(message["headers"]):
                await send(message)
            elif taken:
                held = message
            else:
                await send({**message, "headers": varying(message["headers"])})

        await self._app(scope, receive, send_zipped)
