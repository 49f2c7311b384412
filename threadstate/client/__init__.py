"""A client of the service: ``Client``, ``AsyncClient``, what they answer and what they raise.

One description of every request (``calls``) and one reading of every answer (``models``, ``wire``) serve both clients;
only the sending differs. ``docs/client.md`` is the manual.
"""

from threadstate.client.async_client import AsyncClient
from threadstate.client.async_job import AsyncJob
from threadstate.client.client import Client
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
from threadstate.client.items import AsyncItems, Items
from threadstate.client.job import Job
from threadstate.client.waiting import Progress

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
