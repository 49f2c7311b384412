from __future__ import annotations

import asyncio
import gzip
import threading

import pytest
from fastapi.responses import StreamingResponse
from fastapi.testclient import TestClient
from sqlalchemy import Connection

from harness.databases import Databases
from service.cache.library_names import LibraryNames
from service.cache.responses import OVERHEAD_BYTES, CachedResponse, ResponseCache
from tests.service.conftest import StoredLibrary, store_library
from tests.service.made_up_states import made_up_states
from tests.service_app import service_app
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.library.orientations import OrientationSummary, orientation_summaries
from threadstate.library.tables import library
from threadstate.library.write import pin_library
from threadstate.settings import CACHE_MB, DATABASE, read_settings
from threadstate.thread.catalogue import quarter_twenty_unc

HISTORY = "/v1/libraries/latest/histories/1/-1"


def _response(size: int) -> CachedResponse:
    return CachedResponse("/", '"x"', [], bytes(size))


def test_least_recently_used_is_dropped_first() -> None:
    cache = ResponseCache(8 * OVERHEAD_BYTES)
    for i in range(4):
        cache.put(i, _response(OVERHEAD_BYTES))
    assert cache.get(0) is not None
    cache.put(4, _response(OVERHEAD_BYTES))
    assert [cache.get(i) is not None for i in range(5)] == [True, False, True, True, True]
    assert (cache.bytes, len(cache)) == (8 * OVERHEAD_BYTES, 4)
    assert (cache.hits, cache.misses) == (5, 1)


def test_same_key_again_takes_no_more_room() -> None:
    cache = ResponseCache(8 * OVERHEAD_BYTES)
    for _ in range(9):
        cache.put(1, _response(100))
    assert cache.bytes == OVERHEAD_BYTES + 100


def test_what_is_too_large_is_not_cached() -> None:
    cache = ResponseCache(8 * OVERHEAD_BYTES)
    cache.put(1, _response(OVERHEAD_BYTES + 1))
    assert len(cache) == 0
    nothing = ResponseCache(0)
    nothing.put(1, _response(0))
    assert len(nothing) == 0


@pytest.mark.parametrize("room", ["0", "1"])
def test_cached_response_is_the_one_that_was_made(made_up: StoredLibrary, room: str) -> None:
    with TestClient(service_app(read_settings({DATABASE: made_up.database, CACHE_MB: room}))) as client:
        for path in ("states?limit=3", "orientations", "histories/1/-1", "histories/1/-1?format=csv", "meshes/nut", ""):
            for encoding in ("gzip", "identity"):
                headers = {"Accept-Encoding": encoding}
                first, second = (client.get(f"/v1/libraries/latest/{path}".rstrip("/"), headers=headers) for _ in "ab")
                assert first.status_code == 200
                for answer in (first, second):
                    answer.headers.pop("X-Request-ID")
                assert first.content == second.content
                assert sorted(first.headers.items()) == sorted(second.headers.items())


def test_compressed_and_plain_are_told_apart(client: TestClient) -> None:
    for path in (HISTORY, "/v1/libraries", "/openapi.json"):
        plain, zipped = (client.get(path, headers={"Accept-Encoding": one}) for one in ("identity", "gzip"))
        assert "Content-Encoding" not in plain.headers
        assert zipped.headers["Content-Encoding"] == "gzip"
        assert plain.content == zipped.content
        assert plain.headers["ETag"] != zipped.headers["ETag"]
        assert "Accept-Encoding" in plain.headers["Vary"]
        assert plain.headers["Vary"] == zipped.headers["Vary"]
        assert int(zipped.headers["Content-Length"]) < int(plain.headers["Content-Length"])
        for encoding, own, other in (("identity", plain, zipped), ("gzip", zipped, plain)):
            statuses = [
                client.get(
                    path, headers={"Accept-Encoding": encoding, "If-None-Match": one.headers["ETag"]}
                ).status_code
                for one in (own, other)
            ]
            assert statuses == [304, 200]


def test_answers_to_posts_and_problems_are_compressed(client: TestClient) -> None:
    poses = {"poses": [{"roll": 1, "pitch": 2, "phase": 3}]}
    with client.stream("POST", "/v1/solve", json=poses, headers={"Accept-Encoding": "gzip"}) as answer:
        raw = b"".join(answer.iter_raw())
    assert answer.headers["Content-Encoding"] == "gzip"
    assert len(gzip.decompress(raw)) > len(raw)
    small = client.get("/healthz", headers={"Accept-Encoding": "gzip"})
    assert "Content-Encoding" not in small.headers


def test_accept_header_is_part_of_the_key(client: TestClient) -> None:
    for _ in range(2):
        assert client.get(HISTORY, headers={"Accept": "text/csv"}).headers["Content-Type"].startswith("text/csv")
        assert client.get(HISTORY, headers={"Accept": "*/*"}).headers["Content-Type"] == "application/json"


@pytest.mark.sqlite_alone
def test_publication_and_removal_show_at_once(databases: Databases) -> None:
    database = databases.migrated()
    pair, grid = quarter_twenty_unc(), Grid(1.0, 1.0, 90.0)
    with TestClient(service_app(read_settings({DATABASE: database}))) as client:
        path = "/v1/libraries/latest/orientations"
        assert client.get(path).status_code == 404
        first = store_library(database, pair, grid, made_up_states)
        assert f'"library":{first.id},' in client.get(path).text
        second = store_library(database, pair, Grid(1.0, 1.0, 120.0), made_up_states)
        assert f'"library":{second.id},' in client.get(path).text
        with writing(database) as engine, engine.begin() as connection:
            connection.execute(library.delete().where(library.c.id == second.id))
        assert f'"library":{first.id},' in client.get(path).text
        assert client.get(f"/v1/libraries/{second.id}/orientations").status_code == 404


@pytest.mark.sqlite_alone
def test_pinning_shows_at_once(databases: Databases) -> None:
    database = databases.migrated()
    first = store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 90.0), made_up_states)
    second = store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 120.0), made_up_states)
    path = "/v1/libraries/latest/orientations"
    with TestClient(service_app(read_settings({DATABASE: database}))) as client, writing(database) as engine:
        for pinned, latest in ((None, second), (first.id, first), (second.id, second), (first.id, first)):
            pin_library(engine, pinned)
            assert f'"library":{latest.id},' in client.get(path).text
            assert client.get("/v1/libraries/latest").json()["id"] == latest.id
            assert client.get("/v1/libraries/1-4-20-unc").json()["id"] == latest.id


@pytest.mark.sqlite_alone
def test_database_is_asked_once_for_what_came_before(databases: Databases) -> None:
    database = databases.migrated()
    pair = quarter_twenty_unc()
    first = store_library(database, pair, Grid(1.0, 1.0, 90.0), made_up_states)

    async def ask(names: LibraryNames) -> None:
        assert names.known("latest") is None
        found = await names.look_up("latest")
        assert found is not None
        assert found.id == first.id
        assert names.known("latest") == found
        second = store_library(database, pair, Grid(1.0, 1.0, 120.0), made_up_states)
        assert names.known("latest") == found
        await asyncio.sleep(0)
        assert names.known("latest") is None
        found = await names.look_up("latest")
        assert found is not None
        assert found.id == second.id
        names.close()

    with reading(database) as engine:
        asyncio.run(ask(LibraryNames(engine)))


def test_what_several_ask_for_at_once_is_made_once(made_up: StoredLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    made, release = [], threading.Event()

    def slow(connection: Connection, library_id: int) -> list[OrientationSummary]:
        made.append(library_id)
        release.wait(10.0)
        return orientation_summaries(connection, library_id)

    monkeypatch.setattr("service.orientations.orientation_summaries", slow)
    with TestClient(service_app(read_settings({DATABASE: made_up.database}))) as client:
        answers: list[bytes] = []
        threads = [
            threading.Thread(target=lambda: answers.append(client.get("/v1/libraries/latest/orientations").content))
            for _ in range(5)
        ]
        for thread in threads:
            thread.start()
        threading.Timer(0.5, release.set).start()
        for thread in threads:
            thread.join()
    assert len(made) == 1
    assert len(set(answers)) == 1
    assert len(answers) == 5


def test_stream_of_a_known_length_goes_through_whole(made_up: StoredLibrary) -> None:
    parts = [b"a" * 2000, b"b" * 2000]
    app = service_app(read_settings({DATABASE: made_up.database}))

    @app.get("/v1/libraries/{id}/parts")
    def stream(id: str) -> StreamingResponse:  # noqa: A002 - as in the address
        headers = {"ETag": f'"{id}"', "Cache-Control": "public, no-cache", "Content-Length": "4000"}
        return StreamingResponse(iter(parts), headers=headers, media_type="application/json")

    app.openapi_schema = {"paths": {}}
    with TestClient(app) as client:
        for encoding in ("identity", "gzip"):
            for _ in range(2):
                answer = client.get("/v1/libraries/latest/parts", headers={"Accept-Encoding": encoding})
                assert answer.content == b"".join(parts)


def test_a_header_in_several_lines_is_one_list(client: TestClient) -> None:
    for path in (HISTORY, "/v1/libraries", "/openapi.json", "/v1/libraries/latest/meshes/nut"):
        for second, coding in (("gzip;q=0.5", None), ("gzip", "gzip")):
            answer = client.get(path, headers=[("Accept-Encoding", "identity;q=0.7"), ("Accept-Encoding", second)])
            assert answer.headers.get("Content-Encoding") == coding
    lines = [("Accept", "application/json;q=0.5"), ("Accept", "text/csv")]
    assert client.get(HISTORY, headers=lines).headers["Content-Type"].startswith("text/csv")
    tags = [("If-None-Match", '"x"'), ("If-None-Match", client.get(HISTORY).headers["ETag"])]
    assert client.get(HISTORY, headers=[*tags, ("Accept-Encoding", "gzip")]).status_code == 304
