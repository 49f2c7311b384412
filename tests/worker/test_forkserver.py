"""When the forkserver is started before it is known what is published."""

from __future__ import annotations

from pathlib import Path

import pytest

from worker import forkserver


@pytest.mark.parametrize(
    ("database", "started"),
    [
        ("sqlite:///{folder}/new.sqlite3", True),
        ("sqlite:///{folder}/no/folder/new.sqlite3", True),
        ("sqlite:///{folder}/there.sqlite3", False),
        ("postgresql://someone@database/threads", False),
    ],
    ids=["no file", "no folder", "a file", "PostgreSQL"],
)
def test_it_is_started_where_nothing_can_be_published(
    database: str, started: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[None] = []
    monkeypatch.setattr(forkserver, "running_forkserver", lambda: calls.append(None))
    (tmp_path / "there.sqlite3").touch()
    forkserver.start_for(database.format(folder=tmp_path))
    assert len(calls) == started
