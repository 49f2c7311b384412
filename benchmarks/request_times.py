"""Response times of stored data: every kind of request about a library, to the service within this process."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from unittest import mock

import numpy as np
from fastapi.testclient import TestClient

from benchmarks.sample import SEED
from service import warming
from service.app import create_app
from service.logs import configure_logs
from threadstate.library.grid import Grid
from threadstate.settings import LogLevel, read_settings

REPEATS = 40
"""How often each kind of request is sent, for other orientations, phases and formations each time."""

LIBRARY = "/v1/libraries/latest"
OBSERVED = ("contact=1:crest:*:edge-edge", "contact=1:*:*:*&class=stable_three_point", "flag=flush")
PREPARED = "threadstate_prepared_in_full 1.0"
TILTS = ("ccw", "ccw,roll%2B,roll-,pitch%2B,pitch-")


class RequestFailedError(Exception):
    """A response without status 200; the message has its address, status and body."""


@dataclass(frozen=True)
class RequestTimes:
    """Wall times in ms of one kind of request: the first time, then the median and the longest of the others."""

    name: str
    first_ms: float
    median_ms: float
    longest_ms: float


def measured(database: Path, grid: Grid) -> list[RequestTimes]:
    """The times of every kind of request to the latest library of a SQLite file, once the service has precomputed.

    Raises:
        RequestFailedError: a response has another status than 200.
    """
    settings = replace(read_settings({}), database=f"sqlite:///{database}", data_dir=database.parent)
    configure_logs(settings.log, LogLevel.ERROR)
    # The pauses between steps are for requests, of which there are none until the last step is done.
    with mock.patch.object(warming, "PAUSE_FACTOR", 0.0), TestClient(create_app(settings, serving=True)) as client:
        while PREPARED not in client.get("/metrics").text:
            time.sleep(0.1)
        first = client.get(f"{LIBRARY}/histories/{grid.tilts_deg[0]}/{grid.tilts_deg[-1]}")
        if first.status_code != 200:
            raise RequestFailedError(f"{first.url}: {first.status_code} {first.text}")
        return [_timed(client, name, make) for name, make in _requests(client, grid).items()]


def _requests(client: TestClient, grid: Grid) -> dict[str, Callable[[], str]]:
    """Addresses by the name of the kind of request."""
    chosen = np.random.default_rng(SEED)
    keys: list[str] = []

    def tilt() -> str:
        roll, pitch = chosen.choice(grid.tilts_deg, 2).tolist()
        return f"{roll}/{pitch}"

    def pose() -> str:
        return f"{tilt()}/{chosen.choice(grid.phases_deg)}"

    def key() -> str:
        if not keys:
            nodes = client.get(f"{LIBRARY}/network?format=node-link").json()["nodes"]
            keys.extend(node["id"] for node in nodes)
        return str(chosen.choice(keys))

    def path(objective: str) -> Callable[[], str]:
        return lambda: f"{LIBRARY}/network/paths?from={key()}&objective={objective}&moves={chosen.choice(TILTS)}"

    def page(query: str) -> Callable[[], str]:
        return lambda: f"{LIBRARY}/transitions?{query}&after={chosen.integers(200)}"

    return {
        "a state": lambda: f"{LIBRARY}/states/{pose()}",
        "depth against phase": lambda: f"{LIBRARY}/histories/{tilt()}",
        "intervals": lambda: f"{LIBRARY}/histories/{tilt()}/intervals",
        "heights": lambda: f"{LIBRARY}/histories/{tilt()}/heights",
        "windows": lambda: f"{LIBRARY}/windows?unit={chosen.choice(['in', 'mm'])}",
        "transitions along phase": page("move=ccw"),
        "transitions by tilting": page("move=roll%2B"),
        "transitions of class": page("change=class"),
        "network, summary": lambda: f"{LIBRARY}/network",
        "network, node-link": lambda: f"{LIBRARY}/network?format=node-link",
        "network, GraphML": lambda: f"{LIBRARY}/network?format=graphml",
        "network, DOT": lambda: f"{LIBRARY}/network?format=dot",
        "a formation": lambda: f"{LIBRARY}/network/formations/{key()}",
        "path, least turning": path("turning"),
        "path, fewest transitions": path("transitions"),
        "path, largest margin": path("margin"),
        "what remains": lambda: f"{LIBRARY}/network/locate?{chosen.choice(OBSERVED)}",
    }


def _timed(client: TestClient, name: str, make: Callable[[], str]) -> RequestTimes:
    times = []
    for _ in range(REPEATS):
        address = make()
        start = time.perf_counter()
        answer = client.get(address)
        times.append(1e3 * (time.perf_counter() - start))
        if answer.status_code != 200:
            raise RequestFailedError(f"{address}: {answer.status_code} {answer.text}")
    return RequestTimes(name, times[0], statistics.median(times[1:]), max(times[1:]))
