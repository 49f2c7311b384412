from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI

from service.app import create_app
from service.problems import MEDIA_TYPE
from threadstate.settings import DATABASE, read_settings


def test_it_is_made_once_and_is_whole_for_whoever_asks_meanwhile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []
    described = FastAPI.openapi

    def slow(app: FastAPI) -> dict[str, Any]:
        made.append(app)
        document = described(app)
        time.sleep(0.2)
        return document

    monkeypatch.setattr(FastAPI, "openapi", slow)
    app = create_app(read_settings({DATABASE: f"sqlite:///{tmp_path}/none.sqlite3"}))
    with ThreadPoolExecutor(4) as threads:
        documents = list(threads.map(lambda _: app.openapi(), range(8)))
    assert len(made) == 1
    assert all(document is documents[0] for document in documents)
    for methods in documents[0]["paths"].values():
        for operation in methods.values():
            assert list(operation["responses"]["default"]["content"]) == [MEDIA_TYPE]
