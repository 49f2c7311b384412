"""A client of the service: ``Client``, ``AsyncClient``, what they answer and what they raise.

One description of every request (``calls``) and one reading of every answer (``models``, ``wire``) serve both clients;
only the sending differs. ``docs/client.md`` is the manual.
"""

from threadstate.client._async.client import AsyncClient, AsyncItems
from threadstate.client._async.job import AsyncJob
from threadstate.client._sync.client import Client, Items
from threadstate.client._sync.job import Job
from threadstate.client.errors import (
    ClientError,
    ConflictError,
    ConnectionFailedError,
    ForbiddenError,
    InvalidRequestError,
    JobCancelledError,
    JobEndedError,
    JobFailedError,
    NotFoundError,
    ProblemError,
    ServerError,
    ServiceUnavailableError,
    TimedOutError,
    TooManyRequestsError,
    UnauthorizedError,
    UndecidedPoseError,
    UnexpectedAnswerError,
    UnresolvedPoseError,
    WaitTimedOutError,
)
from threadstate.client.frames import to_pandas, to_polars
from threadstate.client.watching import Progress

__all__ = [
    "AsyncClient",
    "AsyncItems",
    "AsyncJob",
    "Client",
    "ClientError",
    "ConflictError",
    "ConnectionFailedError",
    "ForbiddenError",
    "InvalidRequestError",
    "Items",
    "Job",
    "JobCancelledError",
    "JobEndedError",
    "JobFailedError",
    "NotFoundError",
    "ProblemError",
    "Progress",
    "ServerError",
    "ServiceUnavailableError",
    "TimedOutError",
    "TooManyRequestsError",
    "UnauthorizedError",
    "UndecidedPoseError",
    "UnexpectedAnswerError",
    "UnresolvedPoseError",
    "WaitTimedOutError",
    "to_pandas",
    "to_polars",
]
