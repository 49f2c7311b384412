"""The application: ``uvicorn --factory service.app:create_app``."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import Depends, FastAPI

import service.building.endpoints
import service.docs.endpoints
import service.explorer.endpoints
import service.export.endpoints
import service.health.endpoints
import service.histories.computed
import service.histories.endpoints
import service.jobs.endpoints
import service.libraries.endpoints
import service.meshes.endpoints
import service.network.endpoints
import service.orientations.endpoints
import service.solve.endpoints
import service.states.endpoints
import service.undecided.endpoints
import threadstate
from service.control import ControlEngine
from service.description import DESCRIPTION, PROBLEM_RESPONSES, DescribedApplication
from service.explorer.unknown import install_unknown_page
from service.keys import guard_reading
from service.middleware import BodyLimit, EncodedSlashes, HeadAsGet, SecurityHeaders
from service.network.store import NetworkStore
from service.parameters import refuse_unknown_parameters
from service.problems import install_problem_handlers
from threadstate.library.engine import reader_engine
from threadstate.settings import Settings, read_settings

LARGEST_BODY_BYTES = 256 * 1024
"""Room for 1,000 poses with all the digits that a double has."""


def create_app(settings: Settings | None = None) -> FastAPI:
    """The service over the database of ``settings`` (None: of the environment).

    The database need not be there yet: ``/readyz`` and the resources say what is missing.

    Raises:
        InvalidValueError: a setting is not valid.
    """
    settings = settings or read_settings()
    engine = reader_engine(settings.database)
    control = ControlEngine(settings.database)

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        yield
        engine.dispose()
        control.dispose()

    app = DescribedApplication(
        title="threadstate",
        version=threadstate.__version__,
        description=DESCRIPTION,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        redirect_slashes=False,
        lifespan=lifespan,
        dependencies=[Depends(guard_reading), Depends(refuse_unknown_parameters)],
        responses=PROBLEM_RESPONSES,
    )
    app.state.engine = engine
    app.state.control = control
    app.state.read_keys_required = settings.read_keys_required
    app.state.networks = NetworkStore()
    install_problem_handlers(app)
    install_unknown_page(app)
    for part in (
        service.libraries,
        service.building,
        service.states,
        service.orientations,
        service.histories,
        service.undecided,
        service.export,
        service.network,
        service.meshes,
        service.solve,
        service.jobs,
        service.health,
        service.docs,
        service.explorer,
    ):
        app.include_router(part.endpoints.router)
    app.include_router(service.histories.computed.router)
    app.add_middleware(BodyLimit, largest_bytes=LARGEST_BODY_BYTES)
    for middleware in (HeadAsGet, EncodedSlashes, SecurityHeaders):
        app.add_middleware(middleware)
    return app
