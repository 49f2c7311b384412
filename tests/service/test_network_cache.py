"""Networks are read once, and no request waits for what another one reads."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from types import SimpleNamespace
from typing import Any

import pytest

from service.network.cache import MOST_LIBRARIES, NetworkCache
from threadstate.errors import NotFoundError

WAIT_S = 20.0


class _Reading:
    """Stands for the reading of networks: what was read, and a library whose reading is held up until it is let on."""

    def __init__(self) -> None:
        self.read: list[int] = []
        self.begun, self.let_on = Event(), Event()
        self.held: int | None = None

    def __call__(self, _connection: object, library: Any) -> object:
        self.read.append(library.id)
        if library.id == self.held:
            self.begun.set()
            assert self.let_on.wait(WAIT_S)
        if library.id < 0:
            raise NotFoundError(f"library {library.id} has no histories")
        return SimpleNamespace(of=library.id)


@pytest.fixture
def reading(monkeypatch: pytest.MonkeyPatch) -> _Reading:
    reading = _Reading()
    monkeypatch.setattr("service.network.cache.library_network", reading)
    return reading


@pytest.fixture
def pool() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(4) as pool:
        yield pool


def _get(cache: NetworkCache, number: int) -> Any:
    library: Any = SimpleNamespace(id=number)
    connection: Any = None
    return cache.get(connection, library)


def test_a_reading_holds_up_only_those_who_ask_for_the_same(reading: _Reading, pool: ThreadPoolExecutor) -> None:
    cache = NetworkCache()
    first = _get(cache, 1)
    reading.held = 2
    waiting = [pool.submit(_get, cache, 2)]
    assert reading.begun.wait(WAIT_S)
    waiting.append(pool.submit(_get, cache, 2))
    others = [pool.submit(_get, cache, number) for number in (1, 3)]
    try:
        assert others[0].result(WAIT_S / 4) is first
        assert others[1].result(WAIT_S / 4).of == 3
    finally:
        reading.let_on.set()
    second, again = (one.result(WAIT_S) for one in waiting)
    assert second is again
    assert sorted(reading.read) == [1, 2, 3]


def test_the_least_recently_used_is_evicted(reading: _Reading) -> None:
    cache = NetworkCache()
    for number in (*range(MOST_LIBRARIES), 0, MOST_LIBRARIES, 0, 1):
        _get(cache, number)
    assert reading.read == [*range(MOST_LIBRARIES), MOST_LIBRARIES, 1]


def test_a_failure_is_not_cached(reading: _Reading) -> None:
    cache = NetworkCache()
    for _ in range(2):
        with pytest.raises(NotFoundError):
            _get(cache, -1)
    assert reading.read == [-1, -1]
