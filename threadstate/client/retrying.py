"""Which requests are sent again, and after what pause."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from random import SystemRandom

from threadstate.client.errors import (
    ClientError,
    ConnectionFailedError,
    ServiceUnavailableError,
    TimedOutError,
    TooManyRequestsError,
)
from threadstate.errors import InvalidValueError

LARGEST_RETRY_COUNT = 100
COMPILING_TIMES = 20
"""How often at least a service is asked again that compiles its kernels, unless nothing is to be sent again."""
KERNELS_COMPILING = "kernels-compiling"
FIRST_PAUSE_S = 0.2
LONGEST_PAUSE_S = 30.0

_random = SystemRandom()


@dataclass(frozen=True)
class Retrying:
    """Send a request again up to ``times``, after pauses that double, unless the service says how long to wait.

    A connection that was never made and a 429 have not acted, and are tried again whatever was asked. A connection that
    broke and a 503 are tried again where the request is repeatable. Nothing else is: what was not answered in time
    would only be more work for a service that is late already. A service that compiles its kernels says so, and is
    asked again for ten minutes.
    """

    times: int

    def __post_init__(self) -> None:
        if not 0 <= self.times <= LARGEST_RETRY_COUNT:
            raise InvalidValueError("retries", self.times, f"0 to {LARGEST_RETRY_COUNT}")

    def pause_s(self, error: ClientError, tried: int, *, repeatable: bool) -> float | None:
        """How many seconds to wait after the failure number ``tried``, from 0; None where it is final."""
        compiling = isinstance(error, ServiceUnavailableError) and error.name == KERNELS_COMPILING
        if tried >= (max(self.times, COMPILING_TIMES) if compiling and self.times else self.times):
            return None
        match error:
            case TimedOutError(reached=True):
                return None
            case ConnectionFailedError():
                return backoff_s(tried) if repeatable or not error.reached else None
            case TooManyRequestsError():
                return _asked_s(error.retry_after_s, tried)
            case ServiceUnavailableError() if repeatable:
                return _asked_s(error.retry_after_s, tried)
        return None


def backoff_s(tried: int) -> float:
    """A pause that doubles with every failure up to a limit; drawn from its upper half, so that clients spread."""
    longest = min(FIRST_PAUSE_S * 2.0 ** min(tried, 30), LONGEST_PAUSE_S)
    return longest * _random.uniform(0.5, 1.0)


def _asked_s(retry_after_s: float | None, tried: int) -> float | None:
    if retry_after_s is None:
        return backoff_s(tried)
    return retry_after_s if retry_after_s <= LONGEST_PAUSE_S else None


def retry_after_s(header: str | None) -> float | None:
    """The seconds that a header ``Retry-After`` asks for, as a number or as a date; None where it says neither."""
    if header is None:
        return None
    if header.isascii() and header.isdigit():
        return float(header)
    try:
        seconds = (parsedate_to_datetime(header) - datetime.now(UTC)).total_seconds()
    except (TypeError, ValueError):
        return None
    return max(0.0, seconds) if math.isfinite(seconds) else None
