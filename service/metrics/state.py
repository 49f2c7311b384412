"""What is read when metrics are asked for: memory, connections, limits, and what the database holds."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from sqlalchemy import Connection, Engine, QueuePool
from sqlalchemy.exc import SQLAlchemyError

from service.cache.responses import ResponseCache
from service.limits.admission import Admission
from service.warming import Warming
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import job_counts
from threadstate.library.read import published_libraries


class StateMetrics(Collector):
    """Values of the moment at which they are read."""

    def __init__(self, engine: Engine, cache: ResponseCache, admission: Admission, warming: Warming) -> None:
        self._engine = engine
        self._cache = cache
        self._admission = admission
        self._warming = warming

    def describe(self) -> Iterator[Metric]:
        """Nothing: what there is depends on the database, which is not to be asked at start."""
        yield from ()

    def collect(self) -> Iterator[Metric]:
        """The metrics, with those of the database if it can be read."""
        yield _gauge("prepared", "Whether what is slow the first time was done.", float(self._warming.done))
        in_full = float(self._warming.done_in_full)
        yield _gauge("prepared_in_full", "Whether nothing is slow the first time any more.", in_full)
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
        for name, said, value in (
            ("cache_hits", "Requests for a response that was in the cache.", cache.hits),
            ("cache_misses", "Requests for one that was not.", cache.misses),
        ):
            yield CounterMetricFamily(f"threadstate_{name}", said, value)

    def _of_limits(self) -> Iterator[Metric]:
        admission = self._admission
        yield _gauge("computing", "Requests that hold a place to compute.", admission.computing)
        yield _gauge("queued", "Requests that wait for one.", admission.queued)
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
        yield _gauge("library_age_seconds", "Since the latest library was published.", age)


def _gauge(name: str, said: str, value: float) -> Metric:
    return GaugeMetricFamily(f"threadstate_{name}", said, value)
