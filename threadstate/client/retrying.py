"""Which requests are retried, and after what pause."""

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
COMPILING_RETRIES = 20
"""Minimum number of retries while the service compiles its kernels, unless retries are disabled."""
KERNELS_COMPILING = "kernels-compiling"
FIRST_PAUSE_S = 0.2
LONGEST_PAUSE_S = 30.0

_random = SystemRandom()


@dataclass(frozen=True)
class Retrying:
    """Retry a request up to ``times``, with exponential backoff unless the service sends ``Retry-After``.

    A connection that was never made and a 429 had no effect: every request is retried. A broken connection and a 503
    are retried if the request is repeatable. Nothing else is retried: after a timeout it would only add load. While the
    service compiles its kernels, requests are retried for ten minutes.
    """

    times: int

    def __post_init__(self) -> None:
        if not 0 <= self.times <= LARGEST_RETRY_COUNT:
            raise InvalidValueError("retries", self.times, f"0 to {LARGEST_RETRY_COUNT}")

    def pause_s(self, error: ClientError, failures: int, *, repeatable: bool) -> float | None:
        """The pause in seconds after failure number ``failures``, from 0; None if it is final."""
        compiling = isinstance(error, ServiceUnavailableError) and error.name == KERNELS_COMPILING
        if failures >= (max(self.times, COMPILING_RETRIES) if compiling and self.times else self.times):
            return None
        match error:
            case TimedOutError(reached=True):
                return None
            case ConnectionFailedError():
                return backoff_s(failures) if repeatable or not error.reached else None
            case TooManyRequestsError():
                return _requested_pause_s(error.retry_after_s, failures)
            case ServiceUnavailableError() if repeatable:
                return _requested_pause_s(error.retry_after_s, failures)
        return None


def backoff_s(failures: int) -> float:
    """Exponential backoff up to a limit, with random jitter in its upper half."""
    longest = min(FIRST_PAUSE_S * 2.0 ** min(failures, 30), LONGEST_PAUSE_S)
    return longest * _random.uniform(0.5, 1.0)


def _requested_pause_s(retry_after_s: float | None, failures: int) -> float | None:
    if retry_after_s is None:
        return backoff_s(failures)
    return retry_after_s if retry_after_s <= LONGEST_PAUSE_S else None


def retry_after_s(header: str | None) -> float | None:
    """The seconds of a header ``Retry-After``, a number or a date; None if it is neither."""
    if header is None:
        return None
    if header.isascii() and header.isdigit():
        return float(header)
    try:
        seconds = (parsedate_to_datetime(header) - datetime.now(UTC)).total_seconds()
    except (TypeError, ValueError):
        return None
    return max(0.0, seconds) if math.isfinite(seconds) else None
