"""Errors as problem documents (RFC 9457): the one mapping of errors to HTTP statuses."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from types import MappingProxyType
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException
from starlette.routing import Match

from service.kernels import KernelsCompilingError
from service.request_scope import INSTANCE_PREFIX, current_request_id
from service.valid_ranges import valid_range
from threadstate.access.keys import KeyRefusedError, ScopeRefusedError
from threadstate.errors import (
    InvalidValueError,
    MissingExtraError,
    NotFoundError,
    SchemaError,
    UndecidedPoseError,
    UnreadableDatabaseError,
    UnresolvedPoseError,
)
from threadstate.jobs.model import JobEndedError
from threadstate.library.database_errors import DatabaseFailure, database_failure

MEDIA_TYPE = "application/problem+json"
TYPE_PREFIX = "urn:threadstate:problem:"
_LONGEST_ECHO = 100
RETRY_AFTER_S = 5
"""Seconds until a retry after the database failed."""
KERNELS_RETRY_AFTER_S = 30
"""Seconds until a retry while kernels are being compiled."""
_OUT_OF_RANGE = frozenset({"greater_than", "greater_than_equal", "less_than", "less_than_equal", "finite_number"})
"""Kinds of refused values, as pydantic names them, that a range with both bounds is said of."""
NO_HEADERS: Mapping[str, str] = MappingProxyType({})


class ProblemItem(BaseModel):
    """An invalid value of a request."""

    location: str = Field(description="location: `query`, `path` or `body`, and the name or place there")
    value: str = Field(description="the value as received, shortened where long")
    valid: str = Field(description="what would be valid")


class Problem(BaseModel):
    """A problem document (RFC 9457)."""

    type: str = Field(description="which problem it is; docs/api.md lists them", examples=[f"{TYPE_PREFIX}not-found"])
    title: str = Field(description="the problem in words that do not change", examples=["Not found"])
    status: int = Field(description="the HTTP status", ge=400, le=599, examples=[404])
    detail: str = Field(description="this occurrence of it", examples=["library 7 is not published here"])
    instance: str | None = Field(
        default=None, description="the number of the request, as in the log", examples=[f"{INSTANCE_PREFIX}7f3a"]
    )
    errors: list[ProblemItem] = Field(default=[], description="the values that were refused, where there are any")


@dataclass(frozen=True)
class Kind:
    """A kind of problem: the end of its type, its status and its title."""

    name: str
    status: HTTPStatus
    title: str


INVALID_VALUE = Kind("invalid-value", HTTPStatus.BAD_REQUEST, "Invalid value")
UNKNOWN_PARAMETER = Kind("unknown-parameter", HTTPStatus.BAD_REQUEST, "Unknown parameter")
NOT_FOUND = Kind("not-found", HTTPStatus.NOT_FOUND, "Not found")
UNDECIDED_POSE = Kind("undecided-pose", HTTPStatus.NOT_FOUND, "Pose not decided")
NOT_MIGRATED = Kind("not-migrated", HTTPStatus.SERVICE_UNAVAILABLE, "Database not migrated")
NOT_READY = Kind("not-ready", HTTPStatus.SERVICE_UNAVAILABLE, "No library is published")
DATABASE_UNAVAILABLE = Kind("database-unavailable", HTTPStatus.SERVICE_UNAVAILABLE, "Database unavailable")
UNRESOLVED_POSE = Kind("unresolved-pose", HTTPStatus.UNPROCESSABLE_ENTITY, "Pose not resolved")
KEY_REFUSED = Kind("key-refused", HTTPStatus.UNAUTHORIZED, "Key needed")
SCOPE_REFUSED = Kind("scope-refused", HTTPStatus.FORBIDDEN, "Key not good for this")
JOB_ENDED = Kind("job-ended", HTTPStatus.CONFLICT, "Job has ended")
NOT_INSTALLED = Kind("not-installed", HTTPStatus.NOT_IMPLEMENTED, "Not installed here")
TOO_MANY_REQUESTS = Kind("too-many-requests", HTTPStatus.TOO_MANY_REQUESTS, "Too many requests at once")
TOO_MANY_STREAMS = Kind("too-many-streams", HTTPStatus.TOO_MANY_REQUESTS, "Too many event streams")
KERNELS_COMPILING = Kind("kernels-compiling", HTTPStatus.SERVICE_UNAVAILABLE, "Kernels being compiled")
OUT_OF_TIME = Kind("out-of-time", HTTPStatus.SERVICE_UNAVAILABLE, "Out of time")
DRAINING = Kind("draining", HTTPStatus.SERVICE_UNAVAILABLE, "About to end")
INTERNAL = Kind("internal", HTTPStatus.INTERNAL_SERVER_ERROR, "Internal error")

KINDS = (
    INVALID_VALUE,
    UNKNOWN_PARAMETER,
    NOT_FOUND,
    UNDECIDED_POSE,
    UNRESOLVED_POSE,
    KEY_REFUSED,
    SCOPE_REFUSED,
    JOB_ENDED,
    NOT_MIGRATED,
    NOT_READY,
    DATABASE_UNAVAILABLE,
    NOT_INSTALLED,
    TOO_MANY_REQUESTS,
    TOO_MANY_STREAMS,
    KERNELS_COMPILING,
    OUT_OF_TIME,
    DRAINING,
    INTERNAL,
)
"""All kinds of the service's own; any other HTTP error has the type ``about:blank``."""


class RefusedParameterError(Exception):
    """A query parameter that is unknown or repeated."""

    def __init__(self, kind: Kind, name: str, value: str, valid: str) -> None:
        super().__init__(kind, name, value, valid)
        self.kind = kind
        self.name = name
        self.value = value
        self.valid = valid

    def __str__(self) -> str:
        return self.name


def install_problem_handlers(app: FastAPI) -> None:
    """Make ``app`` answer every error with a problem document."""
    for error, handler in (
        (RefusedParameterError, _refused_parameter),
        (RequestValidationError, _validation),
        (InvalidValueError, _invalid_value),
        (UndecidedPoseError, _undecided_pose),
        (NotFoundError, _not_found),
        (UnresolvedPoseError, _unresolved_pose),
        (KeyRefusedError, _key_refused),
        (ScopeRefusedError, _scope_refused),
        (JobEndedError, _job_ended),
        (UnreadableDatabaseError, _unreadable),
        (SchemaError, _schema),
        (MissingExtraError, _missing_extra),
        (KernelsCompilingError, _kernels_compiling),
        (SQLAlchemyError, _database),
        (HTTPException, _http),
        (Exception, _internal),
    ):
        app.add_exception_handler(error, handler)


def problem_response(
    kind: Kind, detail: str, errors: Sequence[ProblemItem] = (), headers: Mapping[str, str] = NO_HEADERS
) -> Response:
    """The response for a problem of one of the service's kinds."""
    return _response(_problem(kind, detail, errors), headers)


def problem_text(kind: Kind, detail: str) -> str:
    """The problem document of one of the service's kinds, as JSON in one line: for a response that has begun."""
    return _text(_problem(kind, detail))


def _problem(kind: Kind, detail: str, errors: Sequence[ProblemItem] = ()) -> Problem:
    return Problem(
        type=TYPE_PREFIX + kind.name, title=kind.title, status=kind.status, detail=detail, errors=list(errors)
    )


def _response(problem: Problem, headers: Mapping[str, str]) -> Response:
    return Response(_text(problem), problem.status, {**headers, "Cache-Control": "no-store"}, MEDIA_TYPE)


def _text(problem: Problem) -> str:
    if (number := current_request_id.get()) is not None:
        problem = problem.model_copy(update={"instance": INSTANCE_PREFIX + number})
    # Escaped to ASCII, as text of a client may have lone surrogates.
    return json.dumps(problem.model_dump(exclude_defaults=True))


def _refused_parameter(_request: Request, error: Any) -> Response:
    item = ProblemItem(location=f"query {_short(error.name)}", value=_short(error.value), valid=error.valid)
    return problem_response(error.kind, f"query parameter {_short(error.name)!r}; valid: {error.valid}", [item])


def _validation(request: Request, error: Any) -> Response:
    items = [_refused_by_schema(request, one, error.body) for one in error.errors()[:10]]
    detail = "; ".join(f"{item.location} is {item.value!r}: {item.valid}" for item in items)
    return problem_response(INVALID_VALUE, detail, items)


def _refused_by_schema(request: Request, one: Any, body: Any) -> ProblemItem:
    location = " ".join(_short(str(part)) for part in one["loc"])
    if one["type"] == "json_invalid":
        place = int(one["loc"][1])
        return ProblemItem(location=location, value=_short(body[place:]), valid=_short(f"JSON: {one['ctx']['error']}"))
    valid = None
    if one["type"] in _OUT_OF_RANGE:
        valid = valid_range(request.app.openapi(), request.scope["route"].path, request.method, one["loc"])
    return ProblemItem(
        location=location,
        value=_short(str(one.get("input", ""))),
        valid=_short(valid or one["msg"].removeprefix("Input should be ")),
    )


def _invalid_value(_request: Request, error: Any) -> Response:
    item = ProblemItem(location=error.name, value=_short(str(error.value)), valid=error.valid)
    return problem_response(INVALID_VALUE, f"{error.name} is {item.value!r}; valid: {error.valid}", [item])


def _not_found(_request: Request, error: Any) -> Response:
    return problem_response(NOT_FOUND, str(error))


def _undecided_pose(_request: Request, error: Any) -> Response:
    return problem_response(UNDECIDED_POSE, str(error))


def _unresolved_pose(_request: Request, error: Any) -> Response:
    return problem_response(UNRESOLVED_POSE, str(error))


def _key_refused(_request: Request, error: Any) -> Response:
    return problem_response(KEY_REFUSED, str(error), headers={"WWW-Authenticate": "Bearer"})


def _scope_refused(_request: Request, error: Any) -> Response:
    return problem_response(SCOPE_REFUSED, str(error))


def _job_ended(_request: Request, error: Any) -> Response:
    return problem_response(JOB_ENDED, str(error))


def _schema(_request: Request, error: Any) -> Response:
    return problem_response(NOT_MIGRATED, str(error))


def _missing_extra(_request: Request, error: Any) -> Response:
    return problem_response(NOT_INSTALLED, str(error))


def _kernels_compiling(_request: Request, error: Any) -> Response:
    return problem_response(KERNELS_COMPILING, str(error), headers={"Retry-After": str(KERNELS_RETRY_AFTER_S)})


def _unreadable(request: Request, error: Any) -> Response:
    return _database(request, error.__cause__)


def _database(_request: Request, error: Any) -> Response:
    failure = database_failure(error)
    remedy = (
        ""
        if failure in (DatabaseFailure.LOCKED, DatabaseFailure.FULL)
        else "; `threadstate migrate` makes one that is missing"
    )
    return problem_response(DATABASE_UNAVAILABLE, f"{failure}{remedy}", headers={"Retry-After": str(RETRY_AFTER_S)})


def _http(request: Request, error: Any) -> Response:
    title = HTTPStatus(error.status_code).phrase
    problem = Problem(type="about:blank", title=title, status=error.status_code, detail=str(error.detail))
    headers = dict(error.headers or {})
    if error.status_code == HTTPStatus.METHOD_NOT_ALLOWED:
        headers["Allow"] = ", ".join(_allowed_methods(request))
    return _response(problem, headers)


def _allowed_methods(request: Request) -> list[str]:
    """The HTTP methods of a path: each is a separate route, and Starlette names the first alone."""
    found = [
        method
        for method in ("DELETE", "GET", "PATCH", "POST", "PUT")
        if any(route.matches({**request.scope, "method": method})[0] is Match.FULL for route in request.app.routes)
    ]
    return sorted([*found, "HEAD"]) if "GET" in found else found


def _internal(_request: Request, _error: Any) -> Response:
    return problem_response(INTERNAL, "the server failed on this request; see its log")


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST_ECHO else text[:_LONGEST_ECHO] + "..."
