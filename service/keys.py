"""Keys that requests show, in the header ``Authorization`` alone: addresses are logged."""

from __future__ import annotations

from typing import Annotated

from fastapi import Request, Security
from fastapi.concurrency import run_in_threadpool
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from fastapi.security.utils import get_authorization_scheme_param
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.database import ReadConnection, engine_of
from service.metrics.endpoints import PATH as PATH_OF_METRICS
from threadstate.access.keys import KeyRefusedError, require_key
from threadstate.access.scope import Scope

GUARDED = ("/v1/", PATH_OF_METRICS)
"""Where reading needs a key, if it does; health and the description of the interface stay open."""

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
    """Let a request pass that shows a key for writing.

    Raises:
        KeyRefusedError: it shows none that counts.
        ScopeRefusedError: it shows one for reading alone.
    """
    require_key(connection, None if shown is None else shown.credentials, Scope.WRITE)


def guard_reading(request: Request) -> None:
    """Where reading is closed: let a request pass that shows a key.

    Raises:
        KeyRefusedError: it shows none that counts.
    """
    if not request.url.path.startswith(GUARDED):
        return
    _require_for_reading(engine_of(request), request.headers.get("authorization"))


async def may_read(engine: Engine, authorization: str | None) -> bool:
    """Whether such a header shows a key for reading; False where that cannot be found out, too."""
    try:
        await run_in_threadpool(_require_for_reading, engine, authorization)
    except (KeyRefusedError, SQLAlchemyError):
        return False
    return True


def _require_for_reading(engine: Engine, authorization: str | None) -> None:
    scheme, key = get_authorization_scheme_param(authorization)
    with engine.connect() as connection:
        require_key(connection, key if scheme.lower() == "bearer" else None, Scope.READ)
