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

import service.assemblies.endpoints
import service.assemblies.outcomes
import service.builds
import service.compare
import service.docs.endpoints
import service.explorer.endpoints
import service.export
import service.health
import service.histories.computed
import service.histories.endpoints
import service.jobs.endpoints
import service.libraries.endpoints
import service.meshes
import service.metrics
import service.network.endpoints
import service.orientations
import service.settle.endpoints
import service.settled.endpoints
import service.solve
import service.states.endpoints
import service.statics.endpoints
import service.success.endpoints
import service.threads
import service.undecided
import threadstate
from service.cache.library_names import LibraryNames
from service.cache.middleware import CacheMiddleware
from service.cache.responses import ResponseCache
from service.cache.stored import StoredResponses
from service.compression import CompressionMiddleware
from service.cors import cors_options
from service.database import ControlEngine
from service.description import DESCRIPTION, PROBLEM_RESPONSES, DescribedApplication
from service.explorer.endpoints import install_unknown_page
from service.kernels import Kernels
from service.keys import may_read, require_read_key
from service.limits import Admission, LimitsMiddleware
from service.metrics import RequestMetrics, StateMetrics
from service.network.cache import NetworkCache
from service.parameters import refuse_unknown_parameters
from service.problems import install_problem_handlers
from service.representation import REVALIDATE, REVALIDATE_PRIVATELY
from service.request_middleware import (
    BodyLimitMiddleware,
    EncodedSlashesMiddleware,
    HeadAsGetMiddleware,
    RequestMiddleware,
)
from service.request_scope import note_matched_route
from service.shutdown import Shutdown
from service.warming import Warming
from threadstate.library.engine import reader_engine
from threadstate.settings import Settings, read_settings

MEGABYTE = 10**6
CANCEL_S = 1.0
"""How long background tasks are waited for at the end."""
NO_TELEMETRY = TelemetryConfig(tracing=False, metrics=False, logs=False)
"""FastAPI's default checks at every request whether OpenTelemetry is configured."""
LARGEST_BODY_BYTES = 512 * 1024
"""Room for 1,000 poses, or as many loads, with all the digits that a double has."""

_log = logging.getLogger(__name__)


def create_app(settings: Settings | None = None, *, serving: bool = False) -> FastAPI:
    """The service over the database of ``settings`` (None: of the environment).

    The database need not exist yet: ``/readyz`` and the resources report what is missing. With ``serving`` the
    application logs every request, loads the kernels and precomputes the network of the latest library.

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
    shutdown = Shutdown()
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
        if tasks:
            # Threads cannot be cancelled; what they compute is not waited for any longer.
            await asyncio.wait(tasks, timeout=CANCEL_S)
        names.close()
        stored.close()
        engine.dispose()
        control.dispose()

    guards = [require_read_key] if settings.read_keys_required else []
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
    app.outermost = partial(RequestMiddleware, metrics=RequestMetrics(registry), shutdown=shutdown, logging=serving)
    app.state.engine = engine
    app.state.kernels = kernels
    app.state.control = control
    app.state.time_limit_s = settings.time_limit_s
    app.state.read_keys_required = settings.read_keys_required
    app.state.networks = NetworkCache()
    app.state.metrics = registry
    app.state.shutdown = shutdown
    install_problem_handlers(app)
    install_unknown_page(app)
    for module in (
        service.libraries.endpoints,
        service.builds,
        service.states.endpoints,
        service.statics.endpoints,
        service.orientations,
        service.compare,
        service.histories.endpoints,
        service.undecided,
        service.export,
        service.network.endpoints,
        service.meshes,
        service.solve,
        service.settle.endpoints,
        service.assemblies.endpoints,
        service.assemblies.outcomes,
        service.settled.endpoints,
        service.success.endpoints,
        service.threads,
        service.jobs.endpoints,
        service.health,
        service.metrics,
        service.docs.endpoints,
        service.explorer.endpoints,
        service.histories.computed,
    ):
        app.include_router(module.router)
    # From the innermost to the outermost.
    app.add_middleware(BodyLimitMiddleware, largest_bytes=LARGEST_BODY_BYTES)
    app.add_middleware(LimitsMiddleware, admission=admission, time_limit_s=settings.time_limit_s)
    app.add_middleware(CompressionMiddleware)
    allows = partial(may_read, engine) if settings.read_keys_required else None
    app.add_middleware(
        CacheMiddleware, names=names, cache=cache, stored=stored, allows=allows, cache_control=cache_control
    )
    app.add_middleware(HeadAsGetMiddleware)
    app.add_middleware(EncodedSlashesMiddleware)
    if settings.cors_origins:
        app.add_middleware(CORSMiddleware, **cors_options(settings.cors_origins))
    return app


def _log_failure(task: asyncio.Task[None]) -> None:
    if not task.cancelled() and (error := task.exception()) is not None:
        _log.error("what is done in the background failed", exc_info=error)
