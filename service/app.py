"""The application: ``uvicorn --factory service.app:create_app``."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import partial

from fastapi import Depends, FastAPI
from fastapi.telemetry import TelemetryConfig
from prometheus_client import CollectorRegistry
from starlette.middleware.cors import CORSMiddleware

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
import service.metrics.endpoints
import service.network.endpoints
import service.orientations.endpoints
import service.solve.endpoints
import service.states.endpoints
import service.undecided.endpoints
import threadstate
from service.cache.library_names import LibraryNames
from service.cache.middleware import CacheMiddleware
from service.cache.responses import ResponseCache
from service.cache.stored import StoredResponses
from service.compression import CompressionMiddleware
from service.control import ControlEngine
from service.cors import cors_options
from service.description import DESCRIPTION, PROBLEM_RESPONSES, DescribedApplication
from service.edge.drain import Drain
from service.edge.middleware import Edge
from service.explorer.unknown import install_unknown_page
from service.kernels import Kernels
from service.keys import guard_reading, may_read
from service.limits.admission import Admission, Limits
from service.limits.body import BodyLimit
from service.metrics.requests import RequestMetrics
from service.metrics.state import StateMetrics
from service.middleware import EncodedSlashes, HeadAsGet
from service.network.store import NetworkStore
from service.parameters import refuse_unknown_parameters
from service.problems import install_problem_handlers
from service.representation import REVALIDATE, REVALIDATE_PRIVATELY
from service.route_notes import note_matched_route
from service.warming import Warming
from threadstate.library.engine import reader_engine
from threadstate.settings import Settings, read_settings

MEGABYTE = 10**6
NO_TELEMETRY = TelemetryConfig(tracing=False, metrics=False, logs=False)
"""FastAPI's own would look at every request whether OpenTelemetry has been set up."""
LARGEST_BODY_BYTES = 256 * 1024
"""Room for 1,000 poses with all the digits that a double has."""

_log = logging.getLogger(__name__)


def create_app(settings: Settings | None = None, *, serving: bool = False) -> FastAPI:
    """The service over the database of ``settings`` (None: of the environment).

    The database need not be there yet: ``/readyz`` and the resources say what is missing. ``serving`` is whether this
    is the application of a process of its own, which logs every request and prepares the latest library's network.

    Raises:
        InvalidValueError: a setting is not valid.
    """
    settings = settings or read_settings()
    engine = reader_engine(settings.database)
    control = ControlEngine(settings.database)
    names = LibraryNames(engine)
    cache = ResponseCache(settings.cache_mb * MEGABYTE)
    cache_control = REVALIDATE_PRIVATELY if settings.read_keys_required else REVALIDATE
    stored = StoredResponses(engine, cache_control)
    admission = Admission(settings.concurrency, settings.streams)
    drain = Drain()
    registry = CollectorRegistry()
    kernels = Kernels()
    warming = Warming()
    registry.register(StateMetrics(engine, cache, admission, warming))

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        background = [warming.run(app, names), kernels.run()] if serving else []
        tasks = [asyncio.create_task(one) for one in background]
        for task in tasks:
            task.add_done_callback(_log_failure)
        yield
        for task in tasks:
            task.cancel()
        names.close()
        stored.close()
        engine.dispose()
        control.dispose()

    guards = [guard_reading] if settings.read_keys_required else []
    app = DescribedApplication(
        title="threadstate",
        version=threadstate.__version__,
        description=DESCRIPTION,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        telemetry=NO_TELEMETRY,
        redirect_slashes=False,
        lifespan=lifespan,
        dependencies=[Depends(one) for one in (note_matched_route, *guards, refuse_unknown_parameters)],
        responses=PROBLEM_RESPONSES,
    )
    app.outermost = partial(Edge, metrics=RequestMetrics(registry), drain=drain, logging=serving)
    app.state.engine = engine
    app.state.kernels = kernels
    app.state.control = control
    app.state.read_keys_required = settings.read_keys_required
    app.state.networks = NetworkStore()
    app.state.metrics = registry
    app.state.drain = drain
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
        service.metrics,
        service.docs,
        service.explorer,
    ):
        app.include_router(part.endpoints.router)
    app.include_router(service.histories.computed.router)
    # From the innermost to the outermost.
    app.add_middleware(BodyLimit, largest_bytes=LARGEST_BODY_BYTES)
    app.add_middleware(Limits, admission=admission, time_limit_s=settings.time_limit_s)
    app.add_middleware(CompressionMiddleware)
    allows = partial(may_read, engine) if settings.read_keys_required else None
    app.add_middleware(
        CacheMiddleware, names=names, cache=cache, stored=stored, allows=allows, cache_control=cache_control
    )
    app.add_middleware(HeadAsGet)
    app.add_middleware(EncodedSlashes)
    if settings.cors_origins:
        app.add_middleware(CORSMiddleware, **cors_options(settings.cors_origins))
    return app


def _log_failure(task: asyncio.Task[None]) -> None:
    if not task.cancelled() and (error := task.exception()) is not None:
        _log.error("what is done in the background failed", exc_info=error)
