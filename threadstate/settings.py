"""Settings from the environment; ``docs/settings.md`` lists them all.

``THREADSTATE_NUMBA_CACHE_DIR`` is read where it has to act before anything else is imported
(``threadstate._numba_cache``).
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from threadstate._numba_cache import SETTING as NUMBA_CACHE_DIR
from threadstate.errors import InvalidValueError

PREFIX = "THREADSTATE_"

DATA_DIR = "THREADSTATE_DATA_DIR"
DATABASE = "THREADSTATE_DATABASE"
DATABASE_PASSWORD_FILE = "THREADSTATE_DATABASE_PASSWORD_FILE"  # nosec B105
WORKERS = "THREADSTATE_WORKERS"
SCHEDULER = "THREADSTATE_SCHEDULER"
PAIR = "THREADSTATE_PAIR"
HOST = "THREADSTATE_HOST"
PORT = "THREADSTATE_PORT"
READ_KEYS = "THREADSTATE_READ_KEYS"
LEASE_S = "THREADSTATE_LEASE_S"
HEARTBEAT_FILE = "THREADSTATE_HEARTBEAT_FILE"
SERVICE = "THREADSTATE_SERVICE"
KEY = "THREADSTATE_KEY"
CACHE_MB = "THREADSTATE_CACHE_MB"
CONCURRENCY = "THREADSTATE_CONCURRENCY"
STREAMS = "THREADSTATE_STREAMS"
TIME_LIMIT_S = "THREADSTATE_TIME_LIMIT_S"
GRACE_S = "THREADSTATE_GRACE_S"
LOG = "THREADSTATE_LOG"
LOG_LEVEL = "THREADSTATE_LOG_LEVEL"
CORS_ORIGINS = "THREADSTATE_CORS_ORIGINS"

NAMES = (
    DATA_DIR,
    DATABASE,
    DATABASE_PASSWORD_FILE,
    WORKERS,
    SCHEDULER,
    PAIR,
    HOST,
    PORT,
    READ_KEYS,
    LEASE_S,
    HEARTBEAT_FILE,
    SERVICE,
    KEY,
    CACHE_MB,
    CONCURRENCY,
    STREAMS,
    TIME_LIMIT_S,
    GRACE_S,
    LOG,
    LOG_LEVEL,
    CORS_ORIGINS,
    NUMBA_CACHE_DIR,
)
"""Every setting there is."""

DATABASE_FILE = "threadstate.sqlite3"
LARGEST_WORKER_COUNT = 256
DEFAULT_LEASE_S, LARGEST_LEASE_S = 20, 3600
DEFAULT_CACHE_MB, LARGEST_CACHE_MB = 256, 1_000_000
DEFAULT_CONCURRENCY, LARGEST_CONCURRENCY = 4, 1000
DEFAULT_STREAMS, LARGEST_STREAMS = 100, 10_000
DEFAULT_TIME_LIMIT_S, LARGEST_TIME_LIMIT_S = 30, 3600
DEFAULT_GRACE_S, LARGEST_GRACE_S = 20, 3600

_ORIGIN = re.compile(r"https?://[A-Za-z0-9.-]+(:[0-9]{1,5})?")


class LogForm(StrEnum):
    """The form of a line in the log; the first is the default."""

    JSON = "json"
    TEXT = "text"


class LogLevel(StrEnum):
    """The lowest level that is logged; the first is the default."""

    INFO = "info"
    DEBUG = "debug"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class Settings:
    """The settings of a process.

    Attributes:
        data_dir: folder of everything that is stored.
        database: URL of the database.
        workers: number of computing processes.
        scheduler: address of the Dask scheduler whose workers compute instead; None: local processes compute.
        pair: designation, or path of a file, of the default pair of commands; None: the catalogue's first.
        host: address that the service listens on.
        port: port that it listens on.
        read_keys_required: whether reads need an API key.
        lease_s: seconds without a heartbeat after which a worker is considered dead.
        heartbeat_file: file that a worker touches with every heartbeat; None for no file.
        cache_mb: size of the cache of responses, in megabytes (10^6 bytes).
        concurrency: largest number of requests that compute at once.
        streams: largest number of open event streams.
        time_limit_s: time limit until a response begins.
        grace_s: time limit of requests in progress at shutdown.
        log: the form of the log's lines.
        log_level: the lowest level that is logged.
        cors_origins: origins whose pages may read the service (CORS).
    """

    data_dir: Path
    database: str
    workers: int
    scheduler: str | None
    pair: str | None
    host: str
    port: int
    read_keys_required: bool
    lease_s: int
    heartbeat_file: Path | None
    cache_mb: int
    concurrency: int
    streams: int
    time_limit_s: int
    grace_s: int
    log: LogForm
    log_level: LogLevel
    cors_origins: tuple[str, ...]


def read_settings(environment: Mapping[str, str] = os.environ) -> Settings:
    """The settings of an environment; an empty value counts as missing.

    Raises:
        InvalidValueError: a setting's value is not valid; its name is the environment's.
    """
    data_dir = _data_dir(environment)
    return Settings(
        data_dir=data_dir,
        database=environment.get(DATABASE) or f"sqlite:///{data_dir / DATABASE_FILE}",
        workers=_integer(environment, WORKERS, _processors(), LARGEST_WORKER_COUNT),
        scheduler=environment.get(SCHEDULER) or None,
        pair=environment.get(PAIR) or None,
        host=environment.get(HOST) or "127.0.0.1",
        port=_integer(environment, PORT, 8000, 65535),
        read_keys_required=_one_of(environment, READ_KEYS, ("open", "required")) == "required",
        lease_s=_integer(environment, LEASE_S, DEFAULT_LEASE_S, LARGEST_LEASE_S),
        heartbeat_file=Path(file) if (file := environment.get(HEARTBEAT_FILE)) else None,
        cache_mb=_integer(environment, CACHE_MB, DEFAULT_CACHE_MB, LARGEST_CACHE_MB, 0),
        concurrency=_integer(environment, CONCURRENCY, DEFAULT_CONCURRENCY, LARGEST_CONCURRENCY),
        streams=_integer(environment, STREAMS, DEFAULT_STREAMS, LARGEST_STREAMS, 0),
        time_limit_s=_integer(environment, TIME_LIMIT_S, DEFAULT_TIME_LIMIT_S, LARGEST_TIME_LIMIT_S),
        grace_s=_integer(environment, GRACE_S, DEFAULT_GRACE_S, LARGEST_GRACE_S, 3),
        log=LogForm(_one_of(environment, LOG, tuple(LogForm))),
        log_level=LogLevel(_one_of(environment, LOG_LEVEL, tuple(LogLevel))),
        cors_origins=_origins(environment),
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


def _integer(environment: Mapping[str, str], name: str, default: int, largest: int, smallest: int = 1) -> int:
    text = environment.get(name)
    if not text:
        return default
    if not (text.isascii() and text.isdigit() and smallest <= int(text) <= largest):
        raise InvalidValueError(name, text, f"an integer, {smallest} to {largest}")
    return int(text)


def _one_of(environment: Mapping[str, str], name: str, valid: tuple[str, ...]) -> str:
    """One of some words, the first where nothing is said."""
    text = environment.get(name) or valid[0]
    if text not in valid:
        raise InvalidValueError(name, text, ", ".join(valid))
    return text


def _origins(environment: Mapping[str, str]) -> tuple[str, ...]:
    """Origins, separated by commas; ``*`` is invalid, as writes need a key."""
    origins = tuple(one.strip() for one in (environment.get(CORS_ORIGINS) or "").split(",") if one.strip())
    for origin in origins:
        if not _ORIGIN.fullmatch(origin):
            raise InvalidValueError(CORS_ORIGINS, origin, "origins such as https://example.com, separated by commas")
    return origins


def _processors() -> int:
    """How many processors this process may use."""
    return max(1, min(len(os.sched_getaffinity(0)), LARGEST_WORKER_COUNT))
