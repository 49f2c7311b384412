"""Query parameters that a resource does not have, or that are repeated, are rejected."""

from __future__ import annotations

from fastapi import Request
from fastapi.concurrency import run_in_threadpool

from service.problems import INVALID_VALUE, UNKNOWN_PARAMETER, RefusedParameterError


async def refuse_unknown_parameters(request: Request) -> None:
    """Check the names of a request's query parameters against those that its resource documents.

    Raises:
        RefusedParameterError: a name is unknown (the valid ones are listed) or repeated.
    """
    seen: set[str] = set()
    if request.app.openapi_schema is None:
        await run_in_threadpool(request.app.openapi)  # half a second, once
    valid = _documented_parameters(request)
    for name, value in request.query_params.multi_items():
        if name not in valid:
            raise RefusedParameterError(UNKNOWN_PARAMETER, name, value, ", ".join(valid) or "none here")
        if name in seen:
            raise RefusedParameterError(INVALID_VALUE, name, value, "given once")
        seen.add(name)


def _documented_parameters(request: Request) -> tuple[str, ...]:
    paths = request.app.openapi()["paths"]
    operation = paths.get(request.scope["route"].path, {}).get(request.method.lower(), {})
    return tuple(one["name"] for one in operation.get("parameters", ()) if one["in"] == "query")
