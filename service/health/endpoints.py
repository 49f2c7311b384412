"""``/healthz`` and ``/readyz``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, Field

from service.database import engine_of
from service.edge.drain import drain_of
from service.kernels import KernelState, kernels_of
from service.problems import DRAINING, NOT_READY, problem_response
from threadstate.errors import NotFoundError
from threadstate.library.read import latest_library
from threadstate.library.schema import SCHEMA_REVISION, check_schema

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """The process lives."""

    status: str = Field(examples=["ok"])


class Readiness(BaseModel):
    """The service can answer."""

    status: str = Field(examples=["ready"])
    schema_revision: str = Field(examples=[SCHEMA_REVISION])
    library: int = Field(description="number of the latest library", examples=[1])
    kernels: KernelState = Field(
        description="`compiling`: stored states are answered, what is to be solved is refused for a minute or two"
    )


@router.get("/healthz", summary="Does the process live?")
def healthz(response: Response) -> Health:
    """Always 200; does not look at the database."""
    response.headers["Cache-Control"] = "no-store"
    return Health(status="ok")


@router.get("/readyz", summary="Can the service answer?", response_model=Readiness)
def readyz(request: Request, response: Response) -> Readiness | Response:
    """200 where the database has the schema that this code expects and a library is published, else 503.

    503 too from when the process was told to end: no new connections are to come here.
    """
    if drain_of(request).begun:
        return problem_response(DRAINING, "this process was told to end")
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
