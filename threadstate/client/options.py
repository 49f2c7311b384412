"""What a client is made with, of either kind."""

from __future__ import annotations

import math
from dataclasses import dataclass

import httpx2

import threadstate
from threadstate.client.address import KeyHeader, service_address, shown_key
from threadstate.client.retrying import Retrying
from threadstate.errors import InvalidValueError

DEFAULT_TIMEOUT_S = 60.0
DEFAULT_RETRIES = 4
CONNECT_TIMEOUT_S = 5.0


@dataclass(frozen=True)
class Options:
    """Where the service is, what is shown to it, how long it is waited for and how often it is asked."""

    address: httpx2.URL
    key: KeyHeader | None
    timeout: httpx2.Timeout
    retrying: Retrying

    @property
    def headers(self) -> dict[str, str]:
        """Headers of every request."""
        return {"User-Agent": f"threadstate/{threadstate.__version__}"}

    def timeout_of(self, quiet_s: float | None) -> httpx2.Timeout:
        """The timeouts of a request of which nothing may be heard for ``quiet_s`` (None: as usual)."""
        if quiet_s is None:
            return self.timeout
        return httpx2.Timeout(**{**self.timeout.as_dict(), "read": quiet_s})

    def __str__(self) -> str:
        shown = "with a key" if self.key else "without a key"
        return f"{self.address}, {shown}"


def options_of(address: str | None, key: str | None, timeout_s: float, retries: int) -> Options:
    """Options from what a user says; None is what the environment says.

    Raises:
        InvalidValueError: one of them is not valid.
    """
    if not (math.isfinite(timeout_s) and timeout_s > 0.0):
        raise InvalidValueError("timeout_s", timeout_s, "a finite number > 0")
    timeout = httpx2.Timeout(timeout_s, connect=min(timeout_s, CONNECT_TIMEOUT_S))
    return Options(service_address(address), shown_key(key), timeout, Retrying(retries))
