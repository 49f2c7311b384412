from __future__ import annotations

import re
from pathlib import Path

import pytest

from threadstate.errors import InvalidValueError
from threadstate.settings import DATABASE_PASSWORD_FILE, NAMES, database_password, read_settings


def test_the_defaults_follow_the_data_directory() -> None:
    settings = read_settings({"HOME": "/home/somebody"})
    assert settings.data_dir == Path("/home/somebody/.local/share/threadstate")
    assert settings.database == "sqlite:////home/somebody/.local/share/threadstate/threadstate.sqlite3"
    assert (settings.host, settings.port) == ("127.0.0.1", 8000)
    assert settings.workers >= 1


@pytest.mark.parametrize(
    ("environment", "folder"),
    [
        ({"THREADSTATE_DATA_DIR": "/srv/threads", "XDG_DATA_HOME": "/x", "HOME": "/h"}, "/srv/threads"),
        ({"THREADSTATE_DATA_DIR": "", "XDG_DATA_HOME": "/x", "HOME": "/h"}, "/x/threadstate"),
        ({"XDG_DATA_HOME": "relative", "HOME": "/h"}, "/h/.local/share/threadstate"),
        ({}, str(Path("data").absolute())),
    ],
)
def test_where_data_is_kept(environment: dict[str, str], folder: str) -> None:
    assert read_settings(environment).data_dir == Path(folder)


def test_every_setting_is_read() -> None:
    settings = read_settings(
        {
            "THREADSTATE_DATABASE": "sqlite:////tmp/a.sqlite3",
            "THREADSTATE_WORKERS": "3",
            "THREADSTATE_HOST": "::1",
            "THREADSTATE_PORT": "8080",
            "THREADSTATE_READ_KEYS": "required",
            "THREADSTATE_LEASE_S": "5",
            "THREADSTATE_SCHEDULER": "tcp://scheduler.example:8786",
            "THREADSTATE_HEARTBEAT_FILE": "/tmp/heartbeat",
        }
    )
    assert (settings.read_keys_required, settings.lease_s) == (True, 5)
    assert (settings.scheduler, settings.heartbeat_file) == ("tcp://scheduler.example:8786", Path("/tmp/heartbeat"))
    assert (settings.database, settings.workers, settings.host, settings.port) == (
        "sqlite:////tmp/a.sqlite3",
        3,
        "::1",
        8080,
    )


@pytest.mark.parametrize("name", ["THREADSTATE_WORKERS", "THREADSTATE_PORT", "THREADSTATE_LEASE_S"])
@pytest.mark.parametrize("value", ["0", "-1", "1.5", "many", "70000", "٣"])
def test_a_bad_number_names_its_setting(name: str, value: str) -> None:
    with pytest.raises(InvalidValueError, match=name):
        read_settings({name: value, "HOME": "/h"})


def test_a_word_that_is_not_known_names_its_setting() -> None:
    with pytest.raises(InvalidValueError, match="THREADSTATE_READ_KEYS is 'yes'; valid: open, required"):
        read_settings({"THREADSTATE_READ_KEYS": "yes", "HOME": "/h"})


def test_an_empty_setting_is_as_good_as_none() -> None:
    settings = read_settings({"THREADSTATE_SCHEDULER": "", "THREADSTATE_HEARTBEAT_FILE": "", "HOME": "/h"})
    assert (settings.scheduler, settings.heartbeat_file) == (None, None)
    assert database_password({DATABASE_PASSWORD_FILE: ""}) is None


def test_a_password_is_a_files_content_without_the_lines_end(tmp_path: Path) -> None:
    (tmp_path / "password").write_text(" se cret:@/\n")
    assert database_password({DATABASE_PASSWORD_FILE: str(tmp_path / "password")}) == " se cret:@/"


@pytest.mark.parametrize("content", [None, "", "\n", b"\xff"])
def test_a_file_without_a_password_names_its_setting(tmp_path: Path, content: str | bytes | None) -> None:
    path = tmp_path / "password"
    if isinstance(content, str):
        path.write_text(content)
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(InvalidValueError, match=f"{DATABASE_PASSWORD_FILE} is .*password'; valid: a file"):
        database_password({DATABASE_PASSWORD_FILE: str(path)})


def test_every_setting_is_documented(repository_root: Path) -> None:
    documented = set(
        re.findall(r"^\| `(THREADSTATE_[A-Z_]+)`", (repository_root / "docs/settings.md").read_text(), re.M)
    )
    in_code = {
        name
        for room in ("threadstate", "worker", "service", "migrations")
        for path in (repository_root / room).rglob("*.py")
        for name in re.findall(r"THREADSTATE_[A-Z_]+[A-Z]", path.read_text())
    }
    assert documented == set(NAMES) == in_code
