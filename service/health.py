"""``/healthz`` and ``/readyz``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, Field

from service.database import engine_of
from service.kernels import KernelState, kernels_of
from service.problems import DRAINING, NOT_READY, problem_response
from service.shutdown import shutdown_of
from threadstate.errors import NotFoundError
from threadstate.library.read import latest_library
from threadstate.library.schema import SCHEMA_REVISION, check_schema

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """The process is alive."""

    status: str = Field(examples=["ok"])


class Readiness(BaseModel):
    """The service is ready."""

    status: str = Field(examples=["ready"])
    schema_revision: str = Field(examples=[SCHEMA_REVISION])
    library: int = Field(description="number of the latest library", examples=[1])
    kernels: KernelState = Field(
        description="`compiling`: stored states are served, requests that solve are rejected for one to two minutes"
    )


@router.get("/healthz", summary="Is the process alive?")
def healthz(response: Response) -> Health:
    """Always 200; does not read the database."""
    response.headers["Cache-Control"] = "no-store"
    return Health(status="ok")


@router.get("/readyz", summary="Is the service ready?", response_model=Readiness)
def readyz(request: Request, response: Response) -> Readiness | Response:
    """200 where the database has the schema that this code expects and a library is published, else 503.

    Also 503 while the process shuts down, so that no new connections are made.
    """
    if shutdown_of(request).started:
        return problem_response(DRAINING, "this process is shutting down")
    engine = engine_of(request)
    check_schema(engine)
    try:
        with engine.connect() as connection:
            library = latest_library(connection, method=None)
    except NotFoundError as error:
        return problem_response(NOT_READY, str(error))
    response.headers["Cache-Control"] = "no-store"
    return Readiness(
        status="ready", schema_revision=SCHEMA_REVISION, library=library.id, kernels=kernels_of(request).state
    )
