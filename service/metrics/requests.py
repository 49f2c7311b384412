"""Counts and durations of requests."""

from __future__ import annotations

from functools import lru_cache

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram

_BUCKETS_S = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class RequestMetrics:
    """By the template of the address, never by the address: there are as many series as routes.

    ``in_flight`` is how many are being answered; all of them are begun and ended in one thread.
    """

    def __init__(self, registry: CollectorRegistry) -> None:
        self.in_flight = 0
        in_flight = Gauge("threadstate_requests_in_flight", "Requests that are being answered.", registry=registry)
        in_flight.set_function(lambda: self.in_flight)
        requests = Counter(
            "threadstate_requests", "Requests answered.", ("method", "route", "status"), registry=registry
        )
        duration = Histogram(
            "threadstate_request_duration_seconds",
            "From the head of a request to the end of its answer.",
            ("route",),
            buckets=_BUCKETS_S,
            registry=registry,
        )
        # Finding the series of some labels takes longer than counting.
        self._series = lru_cache(maxsize=1024)(requests.labels)
        self._durations = lru_cache(maxsize=256)(duration.labels)

    def count(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request that was answered."""
        self._series(method, route, f"{status // 100}xx").inc()
        self._durations(route).observe(seconds)
