"""Errors of the client; none of them contains the key.

Every error takes its arguments as they are, so that it can be sent to another process.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.service import Problem, ProblemItem
from threadstate.errors import ThreadstateError

PROBLEM_PREFIX = "urn:threadstate:problem:"


class ClientError(ThreadstateError):
    """Base of all errors that a client raises, except for invalid arguments (``InvalidValueError``)."""


class ConnectionFailedError(ClientError):
    """The service cannot be reached, or the connection broke before the response was complete.

    Attributes:
        message: what failed.
        reached: whether the request may have reached the service.
    """

    def __init__(self, message: str, reached: bool) -> None:
        super().__init__(message, reached)
        self.message = message
        self.reached = reached

    def __str__(self) -> str:
        return self.message


class TimedOutError(ConnectionFailedError):
    """The service did not answer in time."""


class UnexpectedAnswerError(ClientError):
    """A response that the interface does not document: of another server, a proxy, or a service of another version."""


class ProblemError(ClientError):
    """The service responded with a problem document (RFC 9457).

    Attributes:
        request: method and path of the request.
        problem: the document.
        retry_after_s: seconds of the header ``Retry-After``; None without it.
    """

    def __init__(self, request: str, problem: Problem, retry_after_s: float | None = None) -> None:
        super().__init__(request, problem, retry_after_s)
        self.request = request
        self.problem = problem
        self.retry_after_s = retry_after_s

    def __str__(self) -> str:
        return f"{self.request}: {self.status} {self.title}: {self.detail}".rstrip(": ")

    @property
    def name(self) -> str:
        """The problem's name, as the interface lists them; empty if the service does not define it."""
        return self.problem.type.removeprefix(PROBLEM_PREFIX) if self.problem.type.startswith(PROBLEM_PREFIX) else ""

    @property
    def type(self) -> str:
        """Which problem it is: a URN, or ``about:blank``."""
        return self.problem.type

    @property
    def title(self) -> str:
        """The problem in words that do not change."""
        return self.problem.title

    @property
    def status(self) -> int:
        """The HTTP status."""
        return self.problem.status

    @property
    def detail(self) -> str:
        """The problem in words of this occurrence."""
        return self.problem.detail

    @property
    def refused(self) -> tuple[ProblemItem, ...]:
        """The invalid values, if any."""
        return self.problem.errors


class InvalidRequestError(ProblemError):
    """A value is outside its range, or the request is malformed or too large (400, 413)."""


class UnauthorizedError(ProblemError):
    """A valid API key is needed (401)."""


class ForbiddenError(ProblemError):
    """The key is for reading alone (403)."""


class NotFoundError(ProblemError):
    """The library, pose, orientation, formation or job does not exist (404)."""


class UndecidedPoseError(NotFoundError):
    """A pose of the grid that the library's solver method could not decide; the detail says why (404)."""


class ConflictError(ProblemError):
    """The job has ended and cannot be cancelled (409)."""


class UnresolvedPoseError(ProblemError):
    """The exact search could not decide a pose; the detail names it (422)."""


class TooManyRequestsError(ProblemError):
    """Too many requests at once (429); ``retry_after_s`` says how long to wait."""


class ServiceUnavailableError(ProblemError):
    """The service is unavailable (503): its database is not ready, or its kernels are being compiled."""


class ServerError(ProblemError):
    """The service failed (any other 5xx)."""


class JobEndedError(ClientError):
    """A job ended without a library.

    Attributes:
        job: the job as it is now.
    """

    def __init__(self, job: JobDocument) -> None:
        super().__init__(job)
        self.job = job

    def __str__(self) -> str:
        reason = "" if self.job.reason is None else f": {self.job.reason}"
        return f"job {self.job.id} {self.job.state.value}{reason}"


class JobFailedError(JobEndedError):
    """The job failed."""


class JobCancelledError(JobEndedError):
    """The job was cancelled."""


class WaitTimedOutError(ClientError):
    """A job did not end within the time limit; it continues."""


_BY_NAME: Mapping[str, type[ProblemError]] = MappingProxyType({"undecided-pose": UndecidedPoseError})
_BY_STATUS: Mapping[int, type[ProblemError]] = MappingProxyType(
    {
        400: InvalidRequestError,
        401: UnauthorizedError,
        403: ForbiddenError,
        404: NotFoundError,
        409: ConflictError,
        413: InvalidRequestError,
        422: UnresolvedPoseError,
        429: TooManyRequestsError,
        503: ServiceUnavailableError,
    }
)


def problem_error(request: str, problem: Problem, retry_after_s: float | None) -> ProblemError:
    """The error for a problem document in response to ``request``."""
    default = ServerError if problem.status >= 500 else ProblemError
    kind = _BY_STATUS.get(problem.status, default)
    name = problem.type.removeprefix(PROBLEM_PREFIX)
    return _BY_NAME.get(name, kind)(request, problem, retry_after_s)
