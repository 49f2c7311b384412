"""Building requests and parsing responses and failures; shared by both clients."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

import httpx2
from pydantic import ValidationError

from threadstate.client.call import Call, name_of
from threadstate.client.errors import (
    ClientError,
    ConnectionFailedError,
    TimedOutError,
    UnexpectedAnswerError,
    problem_error,
)
from threadstate.client.models.service import Problem
from threadstate.client.options import Options, url_of
from threadstate.client.retrying import retry_after_s

Result = TypeVar("Result")

_LONGEST_ECHO = 200


def build_request(
    http: httpx2.Client | httpx2.AsyncClient,
    options: Options,
    call: Call[object],
    headers: dict[str, str] | None = None,
    read_timeout_s: float | None = None,
) -> httpx2.Request:
    """The request of a call, with further headers; ``read_timeout_s`` replaces the usual read timeout unless None.

    Raises:
        UnexpectedAnswerError: the call follows a link of a response to another host.
    """
    url = url_of(options.address, call.path)
    return http.build_request(
        call.method,
        url.copy_merge_params(call.parameters) if call.parameters else url,
        content=call.body,
        headers=call.headers | (headers or {}),
        timeout=options.timeout_with(read_timeout_s),
    )


def parse_response(call: Call[Result], response: httpx2.Response) -> Result:
    """The result of a call, parsed from a complete response.

    Raises:
        ProblemError: the service refused the request.
        UnexpectedAnswerError: the response is not of the documented form.
    """
    check_success(call, response)
    try:
        return call.read(response.content)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(part) for part in first["loc"])
        raise UnexpectedAnswerError(f"{name_of(call)}: {error.title} {place}: {first['msg']}") from None


def check_success(call: Call[object], response: httpx2.Response) -> None:
    """Check that a response is successful; the content of others must have been read.

    Raises:
        ProblemError: the service refused the request.
        UnexpectedAnswerError: the response is neither successful nor a problem document.
    """
    if response.is_success:
        return
    if response.status_code < 400:
        raise UnexpectedAnswerError(f"{name_of(call)}: {response.status_code}, not followed")
    raise problem_error(name_of(call), _problem(response), retry_after_s(response.headers.get("Retry-After")))


@contextmanager
def client_errors(call: Call[object]) -> Iterator[None]:
    """Raise errors of the transport as errors of the client.

    Raises:
        ConnectionFailedError: the connection failed.
        TimedOutError: the answer did not come in time.
    """
    try:
        yield
    except (httpx2.TransportError, httpx2.DecodingError) as error:
        raise _failure(call, error) from None


def _failure(call: Call[object], error: httpx2.RequestError) -> ClientError:
    reached = not isinstance(error, httpx2.ConnectError | httpx2.ConnectTimeout | httpx2.PoolTimeout)
    kind = TimedOutError if isinstance(error, httpx2.TimeoutException) else ConnectionFailedError
    said = str(error) or "no details"
    if isinstance(error, httpx2.ConnectError | httpx2.ConnectTimeout):
        url = error.request.url
        where = f"{url.scheme}://{url.netloc.decode('ascii')}"
        return kind(f"no service answers at {where} ({said}); `threadstate serve` starts one on this machine", reached)
    return kind(f"{name_of(call)}: {type(error).__name__}: {said}", reached)


def _problem(response: httpx2.Response) -> Problem:
    """The problem document of a response; without one, as of a proxy, its status and the beginning of its content."""
    try:
        problem = Problem.model_validate_json(response.content)
    except ValidationError:
        text = " ".join(response.text[:_LONGEST_ECHO].split())
        return Problem(status=response.status_code, title=response.reason_phrase, detail=text)
    return problem.model_copy(update={"status": response.status_code})


def _name(call: Call[object]) -> str:
    return f"{call.method} {call.path.partition('?')[0]}"
