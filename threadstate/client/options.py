"""Options of a client: address of the service, API key, timeouts and retries."""

from __future__ import annotations

import math
import os
from collections.abc import Generator, Mapping
from dataclasses import dataclass

import httpx2

import threadstate
from threadstate.client.errors import UnexpectedAnswerError
from threadstate.client.retrying import Retrying
from threadstate.errors import InvalidValueError
from threadstate.settings import KEY, SERVICE

DEFAULT_ADDRESS = "http://127.0.0.1:8000"


class KeyHeader(httpx2.Auth):
    """Sends the API key in the header ``Authorization``, to this client's service alone: redirections are not
    followed.
    """

    def __init__(self, key: str) -> None:
        self._header = f"Bearer {key}"

    def auth_flow(self, request: httpx2.Request) -> Generator[httpx2.Request, httpx2.Response, None]:
        """Put the header on a request."""
        request.headers["Authorization"] = self._header
        yield request


def service_address(address: str | None, environment: Mapping[str, str] = os.environ) -> httpx2.URL:
    """The service's address, without a slash at its end; None is that of ``THREADSTATE_SERVICE``.

    Raises:
        InvalidValueError: it is not an HTTP address, or has more than a host, a port and a path.
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


def key_header(key: str | None, environment: Mapping[str, str] = os.environ) -> KeyHeader | None:
    """The header for a key; None is that of ``THREADSTATE_KEY``, without which no key is sent.

    Raises:
        InvalidValueError: it is not of the form of a key; the message does not repeat it.
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
        UnexpectedAnswerError: it is a URL of another host.
    """
    if not path.startswith("/") or path.startswith("//"):
        raise UnexpectedAnswerError(f"{path[:100]!r} is not a path on {address.host}")
    prefix = address.path.rstrip("/")
    below = path if prefix and path.startswith(f"{prefix}/") else f"{prefix}{path}"
    raw_path = below.encode("ascii", "replace")
    return address.copy_with(raw_path=raw_path)


DEFAULT_TIMEOUT_S = 60.0
DEFAULT_RETRIES = 4
CONNECT_TIMEOUT_S = 5.0


@dataclass(frozen=True)
class Options:
    """Options of a client."""

    address: httpx2.URL
    key: KeyHeader | None
    timeout: httpx2.Timeout
    retrying: Retrying

    @property
    def headers(self) -> dict[str, str]:
        """Headers of every request."""
        return {"User-Agent": f"threadstate/{threadstate.__version__}"}

    def timeout_with(self, read_timeout_s: float | None) -> httpx2.Timeout:
        """The timeouts of a request; ``read_timeout_s`` replaces the usual read timeout unless None."""
        if read_timeout_s is None:
            return self.timeout
        return httpx2.Timeout(**{**self.timeout.as_dict(), "read": read_timeout_s})

    def __str__(self) -> str:
        shown = "with a key" if self.key else "without a key"
        return f"{self.address}, {shown}"


def make_options(address: str | None, key: str | None, timeout_s: float, retries: int) -> Options:
    """The options of these arguments; None is the value of the environment.

    Raises:
        InvalidValueError: one of them is not valid.
    """
    if not (math.isfinite(timeout_s) and timeout_s > 0.0):
        raise InvalidValueError("timeout_s", timeout_s, "a finite number > 0")
    timeout = httpx2.Timeout(timeout_s, connect=min(timeout_s, CONNECT_TIMEOUT_S))
    return Options(service_address(address), key_header(key), timeout, Retrying(retries))
