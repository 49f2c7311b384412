"""Responses with a strong ETag, and 304 where the client has the content already."""

from __future__ import annotations

import hashlib
import json

from fastapi import Request, Response

from service.compression import worth_compressing, zipped_etag
from service.content_negotiation import header_value, names_etag, takes_gzip

REVALIDATE = "public, no-cache"
"""Caches must revalidate: a stored library does not change, but ``latest`` may mean another one."""
REVALIDATE_PRIVATELY = "private, no-cache"
"""No shared caches where reads need a key."""

JSON = "application/json"
SVG = "image/svg+xml"
NOT_MODIFIED: dict[int | str, dict[str, str]] = {304: {"description": "The client's copy is current (`If-None-Match`)"}}
CSV = "text/csv; charset=utf-8; header=present"
VARY_ACCEPT = "Accept"
"""In the header ``Vary`` of what has a JSON and a CSV form."""


def etag_of(content: bytes) -> str:
    """The strong ETag of these bytes."""
    return f'"{hashlib.sha256(content).hexdigest()}"'


def json_response(request: Request, document: object, headers: dict[str, str] | None = None) -> Response:
    """A response with ``document`` as JSON.

    Raises:
        ValueError: a number is not finite.
    """
    return representation(request, json_content(document), JSON, headers)


def json_content(document: object) -> bytes:
    """``document`` as compact JSON; every double reads back the same.

    Raises:
        ValueError: a number is not finite.
    """
    return json.dumps(document, separators=(",", ":"), allow_nan=False).encode()


def representation(
    request: Request, content: bytes, media_type: str, headers: dict[str, str] | None = None
) -> Response:
    """A response with ``content`` and its ETag, or an empty 304 if ``If-None-Match`` has that ETag."""
    headers = headers or {}
    etag = etag_of(content)
    will_be_zipped = "Content-Encoding" not in headers and worth_compressing(media_type, len(content))
    if will_be_zipped and takes_gzip(header_value(request.headers.raw, b"accept-encoding")):
        etag = zipped_etag(etag)
    cached = REVALIDATE_PRIVATELY if request.app.state.read_keys_required else REVALIDATE
    all_headers = {"ETag": etag, "Cache-Control": cached, **headers}
    if names_etag(header_value(request.headers.raw, b"if-none-match"), etag):
        return Response(status_code=304, headers=all_headers)
    return Response(content, 200, all_headers, media_type)


def zipped_representation(
    request: Request, content: bytes, zipped: bytes, media_type: str, headers: dict[str, str] | None = None
) -> Response:
    """A response with ``content``, or with ``zipped`` for clients that accept gzip; each has its own ETag."""
    all_headers = {"Vary": "Accept-Encoding", **(headers or {})}
    if takes_gzip(header_value(request.headers.raw, b"accept-encoding")):
        return representation(request, zipped, media_type, {"Content-Encoding": "gzip", **all_headers})
    return representation(request, content, media_type, all_headers)
