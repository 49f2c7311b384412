"""What is read straight from the database is what the endpoints answer, byte by byte."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import update

from harness.databases import Databases
from tests.service.conftest import StoredLibrary, store_library
from tests.service.made_up_states import made_up_states
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.access.keys import create_key, revoke_key
from threadstate.access.scope import Scope
from threadstate.library.address import database_url, sqlite_path
from threadstate.library.direct_reader import DirectReader
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.library.pose import state_of_pose
from threadstate.library.rows import unpacked_states
from threadstate.library.states_json import fill_states_json, orientation_states_json, orientations_without_json
from threadstate.library.tables import chunk
from threadstate.settings import CACHE_MB, DATABASE, READ_KEYS, read_settings
from threadstate.state.model import Answer, UndecidedPose
from threadstate.thread.catalogue import quarter_twenty_unc

GRID = Grid(1.0, 1.0, 30.0)
UNDECIDED = (1.0, -1.0, 60.0)


def _with_one_undecided(poses: Sequence[tuple[float, float, float]]) -> Sequence[Answer]:
    answers: list[Answer] = list(made_up_states(poses))
    return [UndecidedPose(*UNDECIDED, "not known") if pose == UNDECIDED else answers[i] for i, pose in enumerate(poses)]


@pytest.fixture(scope="module")
def stored(databases: Databases) -> StoredLibrary:
    return store_library(databases.migrated(), quarter_twenty_unc(), GRID, _with_one_undecided)


@pytest.fixture
def by_endpoints(stored: StoredLibrary, monkeypatch: pytest.MonkeyPatch) -> Iterator[TestClient]:
    """A client of a service in which nothing is read before routing."""
    with TestClient(service_app(read_settings({DATABASE: stored.database, CACHE_MB: "0"}))) as client:

        async def nothing(*_: object) -> None:
            return None

        with monkeypatch.context() as patch:
            patch.setattr("service.cache.stored.StoredResponses.state", nothing)
            patch.setattr("service.cache.stored.StoredResponses.history", nothing)
            yield client


def _answers(client: TestClient, paths: Sequence[str], encoding: str) -> list[tuple[int, bytes, list[tuple[str, str]]]]:
    found = []
    for path in paths:
        answer = client.get(f"/v1/libraries/latest/{path}", headers={"Accept-Encoding": encoding})
        answer.headers.pop("X-Request-ID")
        content = b"" if answer.status_code >= 400 else answer.content
        if answer.status_code >= 400:
            answer.headers.pop("Content-Length")
        found.append((answer.status_code, content, sorted(answer.headers.items())))
    return found


@pytest.mark.parametrize("encoding", ["identity", "gzip"])
def test_same_bytes_and_headers_as_the_endpoints(
    stored: StoredLibrary, by_endpoints: TestClient, monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    paths = [f"states/{roll}/{pitch}/{phase}" for roll, pitch, phase in GRID.poses(0) + GRID.poses(6)]
    paths += [f"histories/{roll}/{pitch}" for roll in GRID.tilts_deg for pitch in GRID.tilts_deg]
    paths += ["states/-0/0.0/30", "states/0/0/30.000", "states/1/-1/60", "states/0/0/31", "states/0.5/0/30"]
    paths += ["states/99/0/30", "states/0/0/360", "states/x/0/30", "states/0/0/30/", "states/0/0/30?x=1"]
    paths += ["histories/0.5/0", "histories/0/0?format=columns", "states/0/0/30?unit=mm"]
    expected = _answers(by_endpoints, paths, encoding)
    monkeypatch.undo()
    with TestClient(service_app(read_settings({DATABASE: stored.database}))) as client:
        for _ in "twice":
            assert _answers(client, paths, encoding) == expected
    assert {status for status, _, _ in expected} == {200, 400, 404}


def test_poses_and_histories_are_read_before_routing(stored: StoredLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.states.endpoints.state_of_pose", None)
    monkeypatch.setattr("service.histories.endpoints.history_rows_json", None)
    with TestClient(service_app(read_settings({DATABASE: stored.database, CACHE_MB: "0"}))) as client:
        for path in ("states/1/-1/30", "histories/1/-1"):
            assert client.get(f"/v1/libraries/latest/{path}").status_code == 200


def test_where_reading_needs_a_key_none_is_answered_without(databases: Databases) -> None:
    with databases.lent() as database:
        store_library(database, quarter_twenty_unc(), GRID, made_up_states)
        settings = read_settings({DATABASE: database, READ_KEYS: "required"})
        with writing(database) as engine, TestClient(service_app(settings)) as client:
            key = create_key(engine, "reader", Scope.READ)
            shown = {"Authorization": f"Bearer {key}"}
            for path in ("states/0/0/30", "histories/1/-1"):
                address = f"/v1/libraries/latest/{path}"
                answer = client.get(address, headers=shown)
                assert (answer.status_code, answer.headers["Cache-Control"]) == (200, "private, no-cache")
                copy = {"If-None-Match": answer.headers["ETag"]}
                assert client.get(address, headers={**shown, **copy}).status_code == 304
                for wrong in ({}, copy, {"Authorization": f"Bearer {key}x"}, {"Authorization": key}):
                    problem(client.get(address, headers=wrong), 401)
            revoke_key(engine, key.split("_")[1])
            problem(client.get("/v1/libraries/latest/states/0/0/30", headers=shown), 401)


@pytest.mark.sqlite_alone
def test_reader_finds_what_is_stored(stored: StoredLibrary) -> None:
    with reading(stored.database) as engine, engine.connect() as connection:
        reader = DirectReader(engine)
        for state in stored.states:
            pose = (state.roll_deg, state.pitch_deg, state.phase_deg)
            assert reader.state(stored.id, *pose) == state_of_pose(connection, stored.id, *pose) == state
        assert reader.state(stored.id, *UNDECIDED) is None
        assert reader.state(stored.id, 0.5, 0.0, 0.0) is None
        assert reader.state(stored.id + 1, 0.0, 0.0, 0.0) is None
        packed = [reader.packed_states(stored.id, index) for index in range(GRID.orientation_count)]
        assert [None if one is None else unpacked_states(one) for one in packed] == [
            orientation_states_json(connection, stored.id, GRID, index) for index in range(GRID.orientation_count)
        ]
        assert reader.packed_states(stored.id, GRID.orientation_count) is None
        reader.close()


@pytest.mark.sqlite_alone
def test_missing_database_is_left_to_the_endpoints(databases: Databases) -> None:
    with reading(databases.new()) as engine:
        assert DirectReader(engine).state(1, 0.0, 0.0, 0.0) is None


@pytest.mark.sqlite_alone
def test_lock_is_not_waited_for(databases: Databases) -> None:
    with databases.lent() as database:
        library = store_library(database, quarter_twenty_unc(), GRID, made_up_states)
        holder = sqlite3.connect(sqlite_path(database_url(database)))
        holder.execute("PRAGMA locking_mode = EXCLUSIVE")
        holder.execute("BEGIN EXCLUSIVE")
        with reading(database) as engine:
            reader = DirectReader(engine)
            assert reader.state(library.id, 0.0, 0.0, 0.0) is None
            holder.close()
            assert reader.state(library.id, 0.0, 0.0, 0.0) is not None
            reader.close()


def test_json_of_older_libraries_is_filled_in(databases: Databases) -> None:
    with databases.lent() as database, writing(database) as engine:
        library = store_library(database, quarter_twenty_unc(), GRID, _with_one_undecided)
        with engine.begin() as connection:
            before = [orientation_states_json(connection, library.id, GRID, index) for index in range(9)]
            connection.execute(update(chunk).where(chunk.c.orientation > 2).values(states_json=None))
        without = orientations_without_json(engine)
        assert without == [(library.id, index) for index in range(3, 9)]
        with engine.connect() as connection:
            assert [orientation_states_json(connection, library.id, GRID, index) for index in range(9)] == before
        assert list(fill_states_json(engine, without)) == without
        assert orientations_without_json(engine) == []
        with engine.connect() as connection:
            assert [orientation_states_json(connection, library.id, GRID, index) for index in range(9)] == before
