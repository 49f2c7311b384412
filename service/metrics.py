"""``/metrics``: counts and durations of requests, and values that are read when Prometheus scrapes them."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from functools import lru_cache

from fastapi import APIRouter, Request, Response
from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4
from prometheus_client.registry import Collector
from sqlalchemy import Connection, Engine, QueuePool
from sqlalchemy.exc import SQLAlchemyError

from service.cache.responses import ResponseCache
from service.limits import Admission
from service.warming import Warming
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import job_counts
from threadstate.library.read import published_libraries

router = APIRouter(include_in_schema=False)

PATH = "/metrics"
_BUCKETS_S = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class StateMetrics(Collector):
    """Metrics computed when Prometheus reads them."""

    def __init__(self, engine: Engine, cache: ResponseCache, admission: Admission, warming: Warming) -> None:
        self._engine = engine
        self._cache = cache
        self._admission = admission
        self._warming = warming

    def describe(self) -> Iterator[Metric]:
        """Nothing, as the metrics depend on the database, which is not read at start."""
        yield from ()

    def collect(self) -> Iterator[Metric]:
        """The metrics; those of the database if it can be read."""
        yield _gauge(
            "prepared", "Whether the precomputation before the first requests is done.", float(self._warming.done)
        )
        in_full = float(self._warming.done_in_full)
        yield _gauge("prepared_in_full", "Whether all of the precomputation is done.", in_full)
        yield from self._of_memory()
        yield from self._of_limits()
        try:
            with self._engine.connect() as connection:
                stored = [*_of_jobs(connection), *_of_libraries(connection)]
        except SQLAlchemyError:
            stored = []
        yield _gauge("database_up", "Whether the database can be read.", float(bool(stored)))
        yield from stored

    def _of_memory(self) -> Iterator[Metric]:
        cache = self._cache
        yield _gauge("cache_bytes", "Bytes of the responses in the cache.", cache.bytes)
        yield _gauge("cache_answers", "Responses in the cache.", len(cache))
        for name, description, value in (
            ("cache_hits", "Requests for a response that was in the cache.", cache.hits),
            ("cache_misses", "Requests for a response that was not in the cache.", cache.misses),
        ):
            yield CounterMetricFamily(f"threadstate_{name}", description, value)

    def _of_limits(self) -> Iterator[Metric]:
        admission = self._admission
        yield _gauge("computing", "Requests that hold a place to compute.", admission.computing)
        yield _gauge("queued", "Requests that wait for a place to compute.", admission.queued)
        yield _gauge("streams", "Event streams that are open.", admission.streams)
        if isinstance(self._engine.pool, QueuePool):
            yield _gauge("database_connections", "Connections in use.", self._engine.pool.checkedout())


def _of_jobs(connection: Connection) -> Iterator[Metric]:
    jobs = GaugeMetricFamily("threadstate_jobs", "Jobs by their state.", labels=("state",))
    counts = job_counts(connection)
    for state in JobState:
        jobs.add_metric((state.value,), counts.get(state, 0))
    yield jobs


def _of_libraries(connection: Connection) -> Iterator[Metric]:
    libraries = published_libraries(connection)
    yield _gauge("libraries", "Published libraries.", len(libraries))
    if libraries:
        age = (datetime.now(UTC) - libraries[0].published_at).total_seconds()
        yield _gauge("library_age_seconds", "Seconds since the latest library was published.", age)


def _gauge(name: str, description: str, value: float) -> Metric:
    return GaugeMetricFamily(f"threadstate_{name}", description, value)


class RequestMetrics:
    """Counts by the route's template, never by the address: there are as many series as routes.

    ``in_flight`` is the number of requests in progress; the event loop's thread alone changes it.
    """

    def __init__(self, registry: CollectorRegistry) -> None:
        self.in_flight = 0
        in_flight = Gauge("threadstate_requests_in_flight", "Requests in progress.", registry=registry)
        in_flight.set_function(lambda: self.in_flight)
        requests = Counter(
            "threadstate_requests", "Completed requests.", ("method", "route", "status"), registry=registry
        )
        duration = Histogram(
            "threadstate_request_duration_seconds",
            "From the head of a request to the end of its response.",
            ("route",),
            buckets=_BUCKETS_S,
            registry=registry,
        )
        # Looking up a labelled series takes longer than incrementing it.
        self._series = lru_cache(maxsize=1024)(requests.labels)
        self._durations = lru_cache(maxsize=256)(duration.labels)

    def count(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a completed request."""
        self._series(method, route, f"{status // 100}xx").inc()
        self._durations(route).observe(seconds)


@router.get(PATH)
def metrics(request: Request) -> Response:
    """All metrics in the text format of Prometheus."""
    registry: CollectorRegistry = request.app.state.metrics
    headers = {"Cache-Control": "no-store"}
    return Response(generate_latest(registry), headers=headers, media_type=CONTENT_TYPE_PLAIN_0_0_4)
