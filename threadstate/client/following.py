"""Following a job's events over as many connections as it takes."""

from __future__ import annotations

import httpx2
from pydantic import ValidationError

from threadstate.client.call import Call
from threadstate.client.errors import ClientError, TimedOutError, UnexpectedAnswerError
from threadstate.client.models.jobs import EventDocument
from threadstate.client.retrying import Retrying, backoff_s
from threadstate.numbers import integer

QUIET_S = 10.0
"""A stream on which nothing came for so many seconds is left and asked for again: the connection may be dead."""


class Place:
    """Where a follower of a job's events is: what it has received, and how often it has failed since.

    ``after`` is the number of the last event that is known already.
    """

    def __init__(self, after: int, retrying: Retrying) -> None:
        self._last = after
        self._retrying = retrying
        self._failed = 0

    @property
    def headers(self) -> dict[str, str]:
        """What tells the service where to go on."""
        return {"Last-Event-ID": str(self._last)} if self._last else {}

    def received(self, event: httpx2.ServerSentEvent) -> EventDocument:
        """What an event says; the next connection goes on after it.

        Raises:
            UnexpectedAnswerError: it is no event of a job.
        """
        try:
            document = EventDocument.model_validate_json(event.data)
            number = integer(event.id)
        except (ValidationError, ValueError):
            raise UnexpectedAnswerError(f"{event.data[:100]!r} is no event of a job") from None
        self._last, self._failed = number, 0
        return document

    def pause_after_close_s(self) -> float:
        """How long to wait after the service, or a proxy, closed the stream although the job goes on."""
        self._failed += 1
        return backoff_s(self._failed - 1)

    def pause_after_s(self, call: Call[object], error: ClientError) -> float | None:
        """How long to wait after a failure; None where it is final. A stream that was only quiet is no failure."""
        if isinstance(error, TimedOutError) and error.reached:
            return 0.0
        self._failed += 1
        return self._retrying.pause_s(error, self._failed - 1, repeatable=call.repeatable)
