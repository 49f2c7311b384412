"""Settings from the environment; ``docs/settings.md`` lists them all.

``THREADSTATE_NUMBA_CACHE_DIR`` is read where it has to act before anything else is imported
(``threadstate._numba_cache``).
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from threadstate._numba_cache import SETTING as NUMBA_CACHE_DIR
from threadstate.errors import InvalidValueError

PREFIX = "THREADSTATE_"

DATA_DIR = "THREADSTATE_DATA_DIR"
DATABASE = "THREADSTATE_DATABASE"
DATABASE_PASSWORD_FILE = "THREADSTATE_DATABASE_PASSWORD_FILE"  # nosec B105
WORKERS = "THREADSTATE_WORKERS"
SCHEDULER = "THREADSTATE_SCHEDULER"
HOST = "THREADSTATE_HOST"
PORT = "THREADSTATE_PORT"
READ_KEYS = "THREADSTATE_READ_KEYS"
LEASE_S = "THREADSTATE_LEASE_S"
HEARTBEAT_FILE = "THREADSTATE_HEARTBEAT_FILE"
SERVICE = "THREADSTATE_SERVICE"
KEY = "THREADSTATE_KEY"

NAMES = (
    DATA_DIR,
    DATABASE,
    DATABASE_PASSWORD_FILE,
    WORKERS,
    SCHEDULER,
    HOST,
    PORT,
    READ_KEYS,
    LEASE_S,
    HEARTBEAT_FILE,
    SERVICE,
    KEY,
    NUMBA_CACHE_DIR,
)
"""Every setting there is."""

DATABASE_FILE = "threadstate.sqlite3"
LARGEST_WORKER_COUNT = 256
DEFAULT_LEASE_S, LARGEST_LEASE_S = 20, 3600


@dataclass(frozen=True)
class Settings:
    """The settings of a process.

    Attributes:
        data_dir: folder of everything that is stored.
        database: URL of the database.
        workers: how many processes compute.
        scheduler: address of the Dask scheduler whose workers compute in their place; None: they do.
        host: address that the service listens on.
        port: port that it listens on.
        read_keys_required: whether reading, too, needs a key.
        lease_s: after how many seconds of silence a worker is taken for dead.
        heartbeat_file: file that a worker touches with every heartbeat; None: none.
    """

    data_dir: Path
    database: str
    workers: int
    scheduler: str | None
    host: str
    port: int
    read_keys_required: bool
    lease_s: int
    heartbeat_file: Path | None


def read_settings(environment: Mapping[str, str] = os.environ) -> Settings:
    """The settings in an environment; an empty value is as good as none.

    Raises:
        InvalidValueError: a setting's value is not valid; its name is the environment's.
    """
    data_dir = _data_dir(environment)
    return Settings(
        data_dir=data_dir,
        database=environment.get(DATABASE) or f"sqlite:///{data_dir / DATABASE_FILE}",
        workers=_integer(environment, WORKERS, _processors(), LARGEST_WORKER_COUNT),
        scheduler=environment.get(SCHEDULER) or None,
        host=environment.get(HOST) or "127.0.0.1",
        port=_integer(environment, PORT, 8000, 65535),
        read_keys_required=_one_of(environment, READ_KEYS, ("open", "required")) == "required",
        lease_s=_integer(environment, LEASE_S, DEFAULT_LEASE_S, LARGEST_LEASE_S),
        heartbeat_file=Path(file) if (file := environment.get(HEARTBEAT_FILE)) else None,
    )


def database_password(environment: Mapping[str, str] = os.environ) -> str | None:
    """The password that the file of ``THREADSTATE_DATABASE_PASSWORD_FILE`` holds, without the line's end.

    Returns:
        None where the setting is not made.

    Raises:
        InvalidValueError: the file cannot be read or is empty.
    """
    file = environment.get(DATABASE_PASSWORD_FILE)
    if not file:
        return None
    try:
        password = Path(file).read_text(encoding="utf-8").rstrip("\r\n")
    except (OSError, UnicodeDecodeError):
        password = ""  # nosec B105
    if not password:
        raise InvalidValueError(DATABASE_PASSWORD_FILE, file, "a file that can be read, with the password in it")
    return password


def _data_dir(environment: Mapping[str, str]) -> Path:
    if chosen := environment.get(DATA_DIR):
        return Path(chosen).expanduser().absolute()
    # The XDG specification: a relative XDG_DATA_HOME is to be ignored.
    if (base := environment.get("XDG_DATA_HOME")) and Path(base).is_absolute():
        return Path(base) / "threadstate"
    if home := environment.get("HOME"):
        return Path(home).absolute() / ".local" / "share" / "threadstate"
    return Path("data").absolute()


def _integer(environment: Mapping[str, str], name: str, default: int, largest: int) -> int:
    text = environment.get(name)
    if not text:
        return default
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= largest):
        raise InvalidValueError(name, text, f"an integer, 1 to {largest}")
    return int(text)


def _one_of(environment: Mapping[str, str], name: str, valid: tuple[str, ...]) -> str:
    """One of some words, the first where nothing is said."""
    text = environment.get(name) or valid[0]
    if text not in valid:
        raise InvalidValueError(name, text, ", ".join(valid))
    return text


def _processors() -> int:
    """How many processors this process may use."""
    return max(1, min(len(os.sched_getaffinity(0)), LARGEST_WORKER_COUNT))
