"""API keys of requests, in the header ``Authorization`` alone, as addresses are logged."""

from __future__ import annotations

from typing import Annotated

from fastapi import Request, Security
from fastapi.concurrency import run_in_threadpool
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from fastapi.security.utils import get_authorization_scheme_param
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.database import ReadConnection, engine_of
from service.metrics import PATH as PATH_OF_METRICS
from threadstate.access.keys import KeyRefusedError, require_key
from threadstate.access.scope import Scope

GUARDED = ("/v1/", PATH_OF_METRICS)
"""Where reads need a key if the setting requires it; health and the OpenAPI document stay open."""

_BEARER = HTTPBearer(
    scheme_name="key",
    description="a key that `threadstate key create` printed",
    bearerFormat="ts_...",
    auto_error=False,
)


def require_write_key(
    connection: ReadConnection,
    shown: Annotated[HTTPAuthorizationCredentials | None, Security(_BEARER)],
) -> None:
    """Require a valid API key for writing.

    Raises:
        KeyRefusedError: the request has no valid API key.
        ScopeRefusedError: the key is for reading alone.
    """
    require_key(connection, None if shown is None else shown.credentials, Scope.WRITE)


def require_read_key(request: Request) -> None:
    """Require a valid API key for a read.

    Raises:
        KeyRefusedError: the request has no valid API key.
    """
    if not request.url.path.startswith(GUARDED):
        return
    _check_read_key(engine_of(request), request.headers.get("authorization"))


async def may_read(engine: Engine, authorization: str | None) -> bool:
    """Whether the header has a valid API key; False also if the database cannot be read."""
    try:
        await run_in_threadpool(_check_read_key, engine, authorization)
    except (KeyRefusedError, SQLAlchemyError):
        return False
    return True


def _check_read_key(engine: Engine, authorization: str | None) -> None:
    scheme, key = get_authorization_scheme_param(authorization)
    with engine.connect() as connection:
        require_key(connection, key if scheme.lower() == "bearer" else None, Scope.READ)
