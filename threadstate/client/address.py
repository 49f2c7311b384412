"""Where the service is, and the key that is shown to it."""

from __future__ import annotations

import os
from collections.abc import Generator, Mapping

import httpx2

from threadstate.client.errors import UnexpectedAnswerError
from threadstate.errors import InvalidValueError
from threadstate.settings import KEY, SERVICE

DEFAULT_ADDRESS = "http://127.0.0.1:8000"


class KeyHeader(httpx2.Auth):
    """Shows a key in the header ``Authorization``; to this client's service alone, as no redirection is followed."""

    def __init__(self, key: str) -> None:
        self._header = f"Bearer {key}"

    def auth_flow(self, request: httpx2.Request) -> Generator[httpx2.Request, httpx2.Response, None]:
        """Put the header on a request."""
        request.headers["Authorization"] = self._header
        yield request


def service_address(address: str | None, environment: Mapping[str, str] = os.environ) -> httpx2.URL:
    """The service's address, without a slash at its end; None is that of ``THREADSTATE_SERVICE``.

    Raises:
        InvalidValueError: it is no address of HTTP, or there is more in it than a host, a port and a path.
    """
    text = address or environment.get(SERVICE) or DEFAULT_ADDRESS
    valid = "http://HOST:PORT, perhaps with a path; a key goes into `key`"
    try:
        url = httpx2.URL(text.rstrip("/"))
    except httpx2.InvalidURL:
        raise InvalidValueError("address", text, valid) from None
    if url.userinfo:
        raise InvalidValueError("address", "(not shown, as there is a password in it)", valid)
    if url.scheme not in ("http", "https") or not url.host or url.query or url.fragment:
        raise InvalidValueError("address", text, valid)
    return url


def shown_key(key: str | None, environment: Mapping[str, str] = os.environ) -> KeyHeader | None:
    """The header for a key; None is that of ``THREADSTATE_KEY``, and nothing is shown where there is none either.

    Raises:
        InvalidValueError: it cannot be a key; the message does not hold it.
    """
    text = key or environment.get(KEY)
    if not text:
        return None
    if not (text.isascii() and text.isprintable() and " " not in text):
        raise InvalidValueError("key", "(not shown)", "a key as `threadstate key create` printed it")
    return KeyHeader(text)


def url_of(address: httpx2.URL, path: str) -> httpx2.URL:
    """The URL of a path, which begins at the service's address or, as links in answers may, at its host.

    Raises:
        UnexpectedAnswerError: it leads to another host.
    """
    if not path.startswith("/") or path.startswith("//"):
        raise UnexpectedAnswerError(f"{path[:100]!r} is no path on {address.host}")
    prefix = address.path.rstrip("/")
    below = path if prefix and path.startswith(f"{prefix}/") else f"{prefix}{path}"
    raw_path = below.encode("ascii", "replace")
    return address.copy_with(raw_path=raw_path)
