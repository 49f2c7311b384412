"""Renditions say what the tables say, byte by byte, and are not trusted blindly."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from service.app import RENDITIONS, create_app
from service.renditions.build import build
from service.renditions.file import Rendition, RenditionError, write_rendition
from service.renditions.shelf import RenditionShelf
from tests.service.conftest import StoredLibrary, store_library
from tests.service.made_up_states import made_up_states
from tests.service.test_problems import problem
from threadstate.access.keys import create_key, revoke_key
from threadstate.access.scope import Scope
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.library.read import library_by_id
from threadstate.settings import DATA_DIR, DATABASE, READ_KEYS, read_settings
from threadstate.state.document import state_document
from threadstate.thread.catalogue import quarter_twenty_unc

LONGEST_S = 60.0


@pytest.fixture(scope="module")
def rendering(made_up: StoredLibrary, tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A client of a service that has rendered the made-up library."""
    folder = tmp_path_factory.mktemp("data")
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(folder)})
    with TestClient(create_app(settings, serving=True)) as client:
        _await_rendition(client, folder, {})
        yield client


def _await_rendition(client: TestClient, folder: Path, headers: dict[str, str]) -> None:
    until = time.monotonic() + LONGEST_S
    while not list((folder / RENDITIONS).glob("*.states")):
        assert client.get("/v1/libraries/latest/states/0/0/0", headers=headers).status_code == 200
        assert time.monotonic() < until
        time.sleep(0.1)


@pytest.mark.parametrize("encoding", ["identity", "gzip"])
def test_rendered_answers_are_those_of_the_tables(
    rendering: TestClient, client: TestClient, made_up: StoredLibrary, encoding: str
) -> None:
    grid = made_up.grid
    paths = [f"states/{roll:g}/{pitch:g}/{phase:g}" for roll, pitch, phase in grid.poses(0) + grid.poses(5)]
    paths += [f"histories/{roll:g}/{pitch:g}" for roll in grid.tilts_deg for pitch in grid.tilts_deg]
    paths += ["states/-0/0.0/30", "states/0/0/30.000"]
    for path in paths:
        asked = (f"/v1/libraries/latest/{path}", {"Accept-Encoding": encoding})
        answers = [one.get(asked[0], headers=asked[1]) for one in (rendering, client)]
        for answer in answers:
            assert answer.status_code == 200
            answer.headers.pop("X-Request-ID")
        assert answers[0].content == answers[1].content
        assert sorted(answers[0].headers.items()) == sorted(answers[1].headers.items())


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("states/0/0/31", 404),
        ("states/0.5/0/30", 404),
        ("states/99/0/30", 400),
        ("states/0/0/360", 400),
        ("states/x/0/30", 400),
        ("states/0/0/30?x=1", 400),
        ("states/0/0/30/", 404),
        ("histories/0.5/0", 404),
        ("histories/0/0?format=columns", 200),
        ("states/0/0/30?unit=mm", 200),
    ],
)
def test_what_is_not_rendered_is_answered_as_ever(
    rendering: TestClient, client: TestClient, path: str, status: int
) -> None:
    answers = [one.get(f"/v1/libraries/latest/{path}") for one in (rendering, client)]
    assert [answer.status_code for answer in answers] == [status, status]
    if status == 200:
        assert answers[0].content == answers[1].content


def test_where_reading_is_closed_what_is_at_hand_is_for_those_with_a_key(
    databases: Databases, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with databases.lent() as database:
        store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), made_up_states)
        settings = read_settings({DATABASE: database, DATA_DIR: str(tmp_path), READ_KEYS: "required"})
        with writing(database) as engine, TestClient(create_app(settings, serving=True)) as client:
            key = create_key(engine, "reader", Scope.READ)
            shown = {"Authorization": f"Bearer {key}"}
            _await_rendition(client, tmp_path, shown)
            addresses = [f"/v1/libraries/latest/{path}" for path in ("states/0/0/30", "histories/1/-1")]
            before = [client.get(address, headers=shown).content for address in addresses]
            # Whatever is answered from now on is at hand.
            monkeypatch.setattr("service.states.endpoints.state_of_pose", None)
            monkeypatch.setattr("service.histories.endpoints.history", None)
            for address, content in zip(addresses, before, strict=True):
                answer = client.get(address, headers=shown)
                assert (answer.status_code, answer.content) == (200, content)
                assert answer.headers["Cache-Control"] == "private, no-cache"
                copy = {"If-None-Match": answer.headers["ETag"]}
                assert client.get(address, headers={**shown, **copy}).status_code == 304
                for wrong in ({}, copy, {"Authorization": f"Bearer {key}x"}, {"Authorization": key}):
                    problem(client.get(address, headers=wrong), 401)
            revoke_key(engine, key.split("_")[1])
            problem(client.get("/v1/libraries/latest/states/0/0/30", headers=shown), 401)


def test_undecided_pose_has_no_text(tmp_path: Path, made_up: StoredLibrary) -> None:
    path = tmp_path / "x.states"
    first, second = (state_document(state) for state in made_up.states[:2])
    write_rendition(path, [first, None, second], 3)
    rendition = Rendition(path)
    assert rendition.state(1) is None
    assert rendition.states(0, 2) is None
    assert rendition.states(2, 2) == rendition.state(2)
    assert list(tmp_path.iterdir()) == [path]


def test_rendition_that_is_not_whole_is_not_there(tmp_path: Path, made_up: StoredLibrary) -> None:
    with pytest.raises(RenditionError, match="1 states instead of 2"):
        write_rendition(tmp_path / "x.states", [state_document(made_up.states[0])], 2)
    assert list(tmp_path.iterdir()) == []


def test_damaged_rendition_is_refused_and_made_again(tmp_path: Path, made_up: StoredLibrary) -> None:
    shelf = RenditionShelf(tmp_path, made_up.database, 1)
    assert _fetched(shelf, made_up) is not None
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    for damaged in (whole[:-1], whole[:20], b"", bytes([whole[0] ^ 1]) + whole[1:], whole[:99] + b"?" + whole[100:]):
        path.write_bytes(damaged)
        with pytest.raises(RenditionError):
            Rendition(path)
    assert _fetched(RenditionShelf(tmp_path, made_up.database, 1), made_up) is not None
    assert path.read_bytes() == whole


def test_room_is_kept(tmp_path: Path, made_up: StoredLibrary) -> None:
    old = tmp_path / "old.states"
    old.write_bytes(bytes(900_000))
    os.utime(old, (1, 1))
    assert _fetched(RenditionShelf(tmp_path, made_up.database, 1), made_up) is not None
    assert not old.exists()


def test_library_without_room_or_folder_is_answered_from_its_tables(tmp_path: Path, made_up: StoredLibrary) -> None:
    assert _fetched(RenditionShelf(tmp_path, made_up.database, 0), made_up) is None
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    assert _fetched(RenditionShelf(tmp_path / "file", made_up.database, 1), made_up) is None


def test_build_is_that_of_every_kind_of_database(tmp_path: Path, made_up: StoredLibrary) -> None:
    path = tmp_path / "x.states"
    build(made_up.database, made_up.id, path)
    assert Rendition(path).ordinals == made_up.grid.state_count


def _fetched(shelf: RenditionShelf, stored: StoredLibrary) -> Rendition | None:
    """What a shelf has once it has tried."""
    with reading(stored.database) as engine, engine.connect() as connection:
        library = library_by_id(connection, stored.id)

    async def fetch() -> Rendition | None:
        shelf.get(library)
        await shelf.settled()
        return shelf.get(library)

    return asyncio.run(fetch())
